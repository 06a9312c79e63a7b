/* Small files of the kernel's, read line by line. */
#define _DEFAULT_SOURCE /* mallopt */

#include "drivers/resources.h"

#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/statvfs.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif

#include "triangle/text/decimal.h"

enum { LINE_BYTES = 512, PATH_BYTES = RESOURCES_PATH };

/* What is asked of every limit: what is left below it, or all that it gives. */
enum extent { LEFT, ALL };

/* The number behind the word that begins a line of a file; -1: there is none. word "": the first line's number. */
static double find_number(const char *path, const char *word)
{
    char line[LINE_BYTES];
    double value = -1;
    FILE *file = fopen(path, "r");
    while (file && value < 0 && fgets(line, sizeof line, file)) {
        size_t length = strlen(word);
        char *end;
        if (strncmp(line, word, length) != 0)
            continue;
        unsigned long long number = strtoull(line + length, &end, 10);
        value = end > line + length ? (double)number : HUGE_VAL; /* "max" */
    }
    if (file)
        fclose(file);
    return value;
}

static double of_machine(enum extent extent)
{
    static const char file[] = "/proc/meminfo";
    if (extent == ALL) {
        double total = find_number(file, "MemTotal:");
        return total < 0 ? HUGE_VAL : 1024 * total;
    }
    double available = find_number(file, "MemAvailable:"), swap = find_number(file, "SwapFree:");
    return available < 0 ? HUGE_VAL : 1024 * (available + fmax(swap, 0));
}

static double of_limit(int resource, double used)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return HUGE_VAL;
    return fmax((double)limit.rlim_cur - used, 0);
}

static double of_status(const char *word) { return 1024 * fmax(find_number("/proc/self/status", word), 0); }

static double of_address_space(enum extent extent)
{
    return of_limit(RLIMIT_AS, extent == LEFT ? of_status("VmSize:") : 0);
}

static double of_data(enum extent extent) { return of_limit(RLIMIT_DATA, extent == LEFT ? of_status("VmData:") : 0); }

struct files {
    const char *limit, *usage, *cache; /* the last: the word in memory.stat for what the kernel gives back */
};

/* Of a group, and every group above it. path is shortened. */
static double of_group(char *path, size_t root, const struct files *files, enum extent extent)
{
    double least = HUGE_VAL;
    for (;;) {
        char file[PATH_BYTES + 64];
        snprintf(file, sizeof file, "%s/%s", path, files->limit);
        double limit = find_number(file, "");
        snprintf(file, sizeof file, "%s/%s", path, files->usage);
        double usage = extent == LEFT ? find_number(file, "") : 0;
        snprintf(file, sizeof file, "%s/memory.stat", path);
        double cache = extent == LEFT ? find_number(file, files->cache) : 0;
        if (limit >= 0 && usage >= 0)
            least = fmin(least, fmax(limit - usage + fmax(cache, 0), 0));
        char *slash = strrchr(path, '/');
        if (strlen(path) <= root || !slash)
            return least;
        *slash = 0;
    }
}

/* The group that this process is in, by a line of /proc/self/cgroup; where the tree is mounted at the group itself, as
 * in containers, its path does not exist, and the root is all that is looked at. */
static double of_group_line(const char *line, enum extent extent)
{
    static const struct files first = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "},
                              second = {"memory.max", "memory.current", "inactive_file "};
    bool unified = strncmp(line, "0::", 3) == 0, memory = strstr(line, ":memory:") != NULL;
    const char *group = strchr(line, ':') ? strchr(strchr(line, ':') + 1, ':') : NULL;
    if ((!unified && !memory) || !group)
        return HUGE_VAL;
    char path[PATH_BYTES];
    const char *root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    snprintf(path, sizeof path, "%s%.*s", root, (int)strcspn(group + 1, "\n"), group + 1);
    if (access(path, F_OK) != 0)
        snprintf(path, sizeof path, "%s", root);
    while (strlen(path) > strlen(root) && path[strlen(path) - 1] == '/')
        path[strlen(path) - 1] = 0;
    return of_group(path, strlen(root), unified ? &second : &first, extent);
}

static double of_groups(enum extent extent)
{
    char line[LINE_BYTES];
    double least = HUGE_VAL;
    FILE *file = fopen("/proc/self/cgroup", "r");
    while (file && fgets(line, sizeof line, file))
        least = fmin(least, of_group_line(line, extent));
    if (file)
        fclose(file);
    return least;
}

static double of_system(enum extent extent) { return fmin(of_machine(extent), of_groups(extent)); }

static double least_of(enum extent extent)
{
    return fmin(of_system(extent), fmin(of_address_space(extent), of_data(extent)));
}

enum resources_end resources_memory_end(void)
{
    const double system = of_system(LEFT), data = of_data(LEFT), space = of_address_space(LEFT);
    if (system <= fmin(data, space))
        return RESOURCES_SYSTEM;
    return space <= data ? RESOURCES_ADDRESS_SPACE : RESOURCES_DATA;
}

double resources_memory(void) { return least_of(LEFT); }

void resources_save_address_space(void)
{
#ifdef __GLIBC__
    if (fmin(of_address_space(ALL), of_data(ALL)) < HUGE_VAL)
        mallopt(M_ARENA_MAX, 1);
#endif
}

double resources_stacks(int threads)
{
    const double unlimited = 2 << 20, limit = of_limit(RLIMIT_STACK, 0); /* the first is glibc's, on most processors */
    const double there = fmax(find_number("/proc/self/status", "Threads:"), 1);
    return fmax(threads - there, 0) * (limit < HUGE_VAL ? limit : unlimited);
}

double resources_memory_total(void) { return least_of(ALL); }

double resources_memory_used(void) { return of_status("VmRSS:"); }

/* ru_maxrss counts units of 1024 bytes, but bytes where Darwin is the system. */
int64_t resources_memory_peak(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage))
        return 0;
#ifdef __APPLE__
    return (int64_t)usage.ru_maxrss;
#else
    return (int64_t)usage.ru_maxrss * 1024;
#endif
}

double resources_processor_seconds(void)
{
    struct rusage usage;
    if (getrusage(RUSAGE_SELF, &usage))
        return 0;
    return (double)(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
           1e-6 * (double)(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void resources_folder(const char *path, char folder[RESOURCES_PATH])
{
    struct stat info;
    const char *slash = strrchr(path, '/');
    if (stat(path, &info) == 0 && S_ISDIR(info.st_mode))
        snprintf(folder, RESOURCES_PATH, "%s", path);
    else
        snprintf(folder, RESOURCES_PATH, "%.*s", slash ? (int)(slash - path) + 1 : 1, slash ? path : ".");
}

double resources_disk(const char *path)
{
    char folder[RESOURCES_PATH];
    struct statvfs disk;
    resources_folder(path, folder);
    return statvfs(folder, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : HUGE_VAL;
}

const char *resources_scratch(void)
{
    const char *folder = getenv("TMPDIR");
    return folder && *folder ? folder : "/tmp";
}

/* --- words of the command line */

bool resources_take_real(const char *text, const char *letters, const double *factor, double low, double high,
                         double *value)
{
    double number;
    const char *end = tri_scan_real(text, text + strlen(text), &number);
    const char *letter = *end ? strchr(letters, *end) : NULL;
    if (end == text || (*end && (!letter || end[1])))
        return false;
    number *= letter ? factor[letter - letters] : 1;
    if (!(number >= low && number <= high))
        return false;
    *value = number;
    return true;
}

bool resources_take_size(const char *text, double least, double *bytes, double *share)
{
    static const double thousands[] = {1e3, 1e6, 1e9, 1e12}, per_cent[] = {0.01};
    const bool is_share = strchr(text, '%') != NULL;
    if (is_share ? !resources_take_real(text, "%", per_cent, DBL_TRUE_MIN, 1, share)
                 : !resources_take_real(text, "KMGT", thousands, least, 0x1p60, bytes))
        return false;
    *(is_share ? bytes : share) = 0;
    return true;
}
