/* Functions for programs only: memory limits, the terminal, interrupts. Facts about memory come from small text files
 * of the kernel, which are read line by line. */
#define _GNU_SOURCE /* mallopt, F_DUPFD_CLOEXEC */
#include "triangle/base/system.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <poll.h>
#include <signal.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <time.h>
#include <unistd.h>
#ifdef __GLIBC__
#include <malloc.h>
#endif
#ifdef __APPLE__
#include <mach-o/dyld.h>
#include <mach/mach.h>
#include <sys/sysctl.h>
#include <sys/time.h>
#endif

/* --- memory and disk */

enum { LINE_BYTES = 512 };

/* Which amount is computed for a limit: the memory left below it, or all of it. */
enum extent { LEFT, ALL };

/* Returns the number after `word` at the start of a line of the file; -1 if there is none. word "": the first line's
 * number. */
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

#ifdef __APPLE__
static double machine_memory(enum extent extent)
{
    uint64_t total;
    size_t bytes = sizeof total;
    if (extent == ALL)
        return sysctlbyname("hw.memsize", &total, &bytes, NULL, 0) == 0 ? (double)total : HUGE_VAL;
    vm_statistics64_data_t pages;
    mach_msg_type_number_t n = HOST_VM_INFO64_COUNT;
    if (host_statistics64(mach_host_self(), HOST_VM_INFO64, (host_info64_t)&pages, &n) != KERN_SUCCESS)
        return HUGE_VAL;
    return ((double)pages.free_count + pages.inactive_count + pages.purgeable_count) * (double)sysconf(_SC_PAGESIZE);
}
#else
static double machine_memory(enum extent extent)
{
    static const char file[] = "/proc/meminfo";
    if (extent == ALL) {
        double total = find_number(file, "MemTotal:");
        return total < 0 ? HUGE_VAL : 1024 * total;
    }
    double available = find_number(file, "MemAvailable:"), swap = find_number(file, "SwapFree:");
    return available < 0 ? HUGE_VAL : 1024 * (available + fmax(swap, 0));
}
#endif

static double limit_left(int resource, double used)
{
    struct rlimit limit;
    if (getrlimit(resource, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY)
        return HUGE_VAL;
    return fmax((double)limit.rlim_cur - used, 0);
}

static double of_status(const char *word) { return 1024 * fmax(find_number("/proc/self/status", word), 0); }

static double address_space(enum extent extent)
{
    return limit_left(RLIMIT_AS, extent == LEFT ? of_status("VmSize:") : 0);
}

static double of_data(enum extent extent) { return limit_left(RLIMIT_DATA, extent == LEFT ? of_status("VmData:") : 0); }

struct files {
    const char *limit, *usage, *cache; /* file names, and the name in memory.stat of the cache that the kernel can
                                        * free */
};

/* Returns the least amount over a group and all groups above it. Shortens path. */
static double group_memory(char *path, size_t root, const struct files *files, enum extent extent)
{
    double least = HUGE_VAL;
    for (;;) {
        char file[TRI_PATH + 64];
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

/* Returns the amount for the group in a line of /proc/self/cgroup. In containers the tree is often mounted at the group
 * itself. Then the path of the group does not exist, and only the root is examined. */
static double group_line_memory(const char *line, enum extent extent)
{
    static const struct files first = {"memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file "},
                              second = {"memory.max", "memory.current", "inactive_file "};
    bool unified = strncmp(line, "0::", 3) == 0, memory = strstr(line, ":memory:") != NULL;
    const char *group = strchr(line, ':') ? strchr(strchr(line, ':') + 1, ':') : NULL;
    if ((!unified && !memory) || !group)
        return HUGE_VAL;
    char path[TRI_PATH];
    const char *root = unified ? "/sys/fs/cgroup" : "/sys/fs/cgroup/memory";
    snprintf(path, sizeof path, "%s%.*s", root, (int)strcspn(group + 1, "\n"), group + 1);
    if (access(path, F_OK) != 0)
        snprintf(path, sizeof path, "%s", root);
    while (strlen(path) > strlen(root) && path[strlen(path) - 1] == '/')
        path[strlen(path) - 1] = 0;
    return group_memory(path, strlen(root), unified ? &second : &first, extent);
}

static double groups_memory(enum extent extent)
{
    char line[LINE_BYTES];
    double least = HUGE_VAL;
    FILE *file = fopen("/proc/self/cgroup", "r");
    while (file && fgets(line, sizeof line, file))
        least = fmin(least, group_line_memory(line, extent));
    if (file)
        fclose(file);
    return least;
}

static double system_memory(enum extent extent) { return fmin(machine_memory(extent), groups_memory(extent)); }

static double least_memory(enum extent extent)
{
    return fmin(system_memory(extent), fmin(address_space(extent), of_data(extent)));
}

enum tri_memory_nearest_limit tri_memory_nearest_limit(void)
{
    const double system = system_memory(LEFT), data = of_data(LEFT), space = address_space(LEFT);
    if (system <= fmin(data, space))
        return TRI_LIMIT_SYSTEM;
    return space <= data ? TRI_LIMIT_ADDRESS_SPACE : TRI_LIMIT_DATA;
}

double tri_memory_left(void) { return least_memory(LEFT); }

void tri_memory_share_heap(void)
{
#ifdef __GLIBC__
    if (fmin(address_space(ALL), of_data(ALL)) < HUGE_VAL)
        mallopt(M_ARENA_MAX, 1);
#endif
}

double tri_memory_of_stacks(int threads)
{
    const double unlimited = 2 << 20, limit = limit_left(RLIMIT_STACK, 0); /* 2 MB is the default of glibc */
    const double there = fmax(find_number("/proc/self/status", "Threads:"), 1);
    return fmax(threads - there, 0) * (limit < HUGE_VAL ? limit : unlimited);
}

double tri_memory_total(void) { return least_memory(ALL); }

/* ru_maxrss is in units of 1024 bytes, on Darwin in bytes. */
int64_t tri_memory_peak(void)
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

double tri_disk_left(const char *path)
{
    char folder[TRI_PATH];
    struct statvfs disk;
    tri_path_folder(path, folder);
    return statvfs(folder, &disk) == 0 ? (double)disk.f_bavail * (double)disk.f_frsize : HUGE_VAL;
}

const char *tri_scratch_folder(void)
{
    const char *folder = getenv("TMPDIR");
    return folder && *folder ? folder : "/tmp";
}

/* --- the program */

char **tri_arguments(int argc, char **argv)
{
    (void)argc;
    return argv;
}

const char *tri_word_quote(void) { return "'"; }

#ifdef __APPLE__
bool tri_program_path(char path[TRI_PATH])
{
    uint32_t room = TRI_PATH;
    const bool whole = _NSGetExecutablePath(path, &room) == 0;
    if (!whole)
        path[0] = '\0';
    return whole;
}
#else
bool tri_program_path(char path[TRI_PATH])
{
    const ssize_t n = readlink("/proc/self/exe", path, TRI_PATH);
    const bool whole = n > 0 && n < TRI_PATH;
    path[whole ? n : 0] = '\0';
    return whole;
}
#endif

/* --- the terminal */

void tri_standard_open(void)
{
    for (int file = 0; file <= STDERR_FILENO; file++)
        if (fcntl(file, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", O_RDWR); /* uses the lowest free number */
}

bool tri_standard_is_same_file(void)
{
    struct tri_file_facts output, error;
    return tri_file_get_facts(STDOUT_FILENO, &output) && tri_file_get_facts(STDERR_FILENO, &error) &&
           output.device == error.device && output.node == error.node;
}

bool tri_standard_is_terminal(void) { return isatty(STDERR_FILENO); }

bool tri_standard_reader_is_gone(void)
{
    struct pollfd output = {STDOUT_FILENO, POLLOUT, 0};
    return poll(&output, 1, 0) == 1 && (output.revents & POLLERR);
}

tri_file tri_standard_error_reopen(void) { return fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1); }

void tri_print_unbuffered(const char *text) { (void)!write(STDERR_FILENO, text, strlen(text)); }

/* --- interrupts */

static struct tri_interrupts handlers; /* set before the first signal can arrive */
#ifdef __APPLE__
static volatile double alarm_time; /* when the alarm is due, by tri_seconds(); 0: none is set */
#else
static timer_t timer;
#endif

static const struct kind {
    int number;
    const char *name;
} ends[] = {
    {SIGHUP, "SIGHUP"},   {SIGINT, "SIGINT"},   {SIGQUIT, "SIGQUIT"}, {SIGTERM, "SIGTERM"},
    {SIGALRM, "SIGALRM"}, {SIGUSR1, "SIGUSR1"}, {SIGUSR2, "SIGUSR2"}, {SIGXCPU, "SIGXCPU"},
    {SIGVTALRM, "SIGVTALRM"}, {SIGPROF, "SIGPROF"},
};
static const int crashes[] = {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGSYS};

enum { N_ENDS = sizeof ends / sizeof *ends, N_CRASHES = sizeof crashes / sizeof *crashes };

const char *tri_interrupt_name(int number)
{
    for (int i = 0; i < N_ENDS; i++)
        if (ends[i].number == number)
            return ends[i].name;
    return NULL;
}

#ifdef __APPLE__ /* no timer_create(); an alarm of another process is known by coming too early */
static bool make_timer(void) { return true; }
static bool is_alarm(const siginfo_t *info) { return (void)info, alarm_time > 0 && tri_seconds() > alarm_time - 1; }

void tri_alarm(double seconds)
{
    struct itimerval once = {.it_value.tv_sec = (time_t)seconds};
    once.it_value.tv_usec = (int)fmax(1e6 * (seconds - (double)once.it_value.tv_sec), 1);
    alarm_time = seconds > 0 ? tri_seconds() + seconds : 0;
    setitimer(ITIMER_REAL, &once, NULL);
}
#else
static bool make_timer(void) { return timer_create(CLOCK_MONOTONIC, NULL, &timer) == 0; } /* sends SIGALRM */
static bool is_alarm(const siginfo_t *info) { return info->si_code == SI_TIMER; }

void tri_alarm(double seconds)
{
    struct itimerspec once = {.it_value.tv_sec = (time_t)seconds};
    once.it_value.tv_nsec = (long)(1e9 * (seconds - (double)once.it_value.tv_sec));
    timer_settime(timer, 0, &once, NULL);
}
#endif

static void handle_end(int number, siginfo_t *info, void *context)
{
    const int reason = errno;
    (void)context;
    if (number == SIGALRM && is_alarm(info))
        handlers.time_is_up();
    else
        handlers.asked(number);
    errno = reason;
}

static void handle_crash(int number)
{
    handlers.crashed();
    signal(number, SIG_DFL);
    raise(number);
}

static void catch_end(int number)
{
    struct sigaction action = {.sa_sigaction = handle_end, .sa_flags = SA_SIGINFO}, old;
    sigfillset(&action.sa_mask);
    if (sigaction(number, NULL, &old) == 0 && (number == SIGALRM || old.sa_handler != SIG_IGN))
        sigaction(number, &action, NULL); /* no SA_RESTART: opening a pipe that has no reader must end */
}

/* Handlers that are already installed, such as those of sanitizers, stay. */
static void catch_crash(int number)
{
    struct sigaction action = {.sa_handler = handle_crash}, old;
    sigfillset(&action.sa_mask);
    if (sigaction(number, NULL, &old) == 0 && !(old.sa_flags & SA_SIGINFO) && old.sa_handler == SIG_DFL)
        sigaction(number, &action, NULL);
}

bool tri_interrupts_catch(const struct tri_interrupts *to)
{
    sigset_t alarm;
    handlers = *to;
    const bool has_timer = make_timer();
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
    for (int i = 0; i < N_ENDS; i++)
        catch_end(ends[i].number);
    for (int i = 0; i < N_CRASHES; i++)
        catch_crash(crashes[i]);
    sigemptyset(&alarm);
    sigaddset(&alarm, SIGALRM);
    sigprocmask(SIG_UNBLOCK, &alarm, NULL); /* the caller may have blocked it */
    return has_timer;
}
