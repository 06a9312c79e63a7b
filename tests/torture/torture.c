/* torture: random figures with random switches; each result is checked. See usage below.
 *
 * Every case runs in its own process, with limits on processor time and memory. So a crash or a run-away is reported as
 * a fault with a seed, like any other. */
#include <errno.h>
#include <getopt.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include "tests/torture/judge.h"
#include "tests/torture/minimise.h"

static const char usage[] =
    "Usage: torture [options]\n"
    "  --seed N          first seed (1)\n"
    "  --count N         number of cases (500)\n"
    "  --families A,B,.. draw only from these families; --list prints all\n"
    "  --near            only near-degenerate families, only -p and -pc: no refinement\n"
    "  --file F          mesh the figure in this .poly or .node file instead of random ones\n"
    "  --switches S      use these switches (p); random cases that are refined get them in addition\n"
    "  --block N         use the schedule with this many triangles in a cell (0: sequential; random)\n"
    "  --again           refine each mesh once more\n"
    "  --out DIR         write the figures of failures there\n"
    "  --minimise        make these figures small first\n"
    "  --ignore A,B,..   do not report these kinds of faults\n"
    "  --seconds S       processor time for one case (300)\n"
    "  --verbose         print all cases\n"
    "Prints a line for each failure and a table of them. Exit code 1: at least one case failed.\n";

enum { MOST_FAMILIES = 100, MOST_FAULTS = 200, TRIALS = 3000, WAIT_FACTOR = 20 };

struct tally {
    char fault[48];
    const char *family;
    int32_t n;
    uint64_t seed;
};

struct torture {
    uint64_t seed;
    int32_t count;
    struct torture_range range;
    const struct family *families[MOST_FAMILIES];
    const char *file, *out, *ignored;
    struct torture_case given; /* switches, block, again */
    bool minimise, verbose;
    double seconds;
    struct verdict *verdict; /* shared with the processes that run cases */
    struct tally tally[MOST_FAULTS];
    int32_t n_tally, n_failed;
    int64_t triangles;
};

/* --- one case, in a process of its own */

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define SANITIZED 1
#endif
#endif

static void set_limits(double seconds)
{
    struct itimerval limit = {{0, 0}, {(time_t)seconds, (suseconds_t)((seconds - floor(seconds)) * 1e6)}};
    setitimer(ITIMER_PROF, &limit, NULL);
    alarm((unsigned)(seconds * WAIT_FACTOR) + 1); /* also ends processes that wait for each other */
    setrlimit(RLIMIT_CORE, &(struct rlimit){0, 0});
#ifndef SANITIZED
    const uint64_t most = UINT64_C(4) << 30;
    if (SIZE_MAX > most) /* otherwise the system has no more */
        setrlimit(RLIMIT_AS, &(struct rlimit){(rlim_t)most, (rlim_t)most});
#endif
}

/* The most informative line: that of a failed assertion or a sanitizer, otherwise the last one. */
static void add_words(struct verdict *verdict, FILE *words)
{
    char line[256], best[256] = "";
    rewind(words);
    while (fgets(line, sizeof line, words)) {
        line[strcspn(line, "\n")] = 0;
        bool telling = strstr(line, "ssertion") || strstr(line, "SUMMARY") || strstr(line, "runtime error");
        if (telling || !best[0])
            snprintf(best, sizeof best, "%s", line);
        if (telling)
            break;
    }
    size_t n = strlen(verdict->detail);
    snprintf(verdict->detail + n, sizeof verdict->detail - n, "%s", best);
}

/* Describes how the process ended. */
static void judge_end(struct verdict *verdict, int status, FILE *words)
{
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0 && verdict->done)
        return;
    verdict->fault[0] = 0;
    int number = WIFSIGNALED(status) ? WTERMSIG(status) : 0;
    if (number == SIGPROF || number == SIGALRM)
        judge_fault(verdict, "endless", "%s (%s): ", verdict->stage, number == SIGPROF ? "busy" : "waiting");
    else if (number)
        judge_fault(verdict, "crash", "%s, signal %d: ", verdict->stage, number);
    else
        judge_fault(verdict, "crash", "%s, exit code %d: ", verdict->stage, WEXITSTATUS(status));
    add_words(verdict, words);
}

static void run_case(struct torture *t, const struct torture_case *c)
{
    memset(t->verdict, 0, sizeof *t->verdict);
    FILE *words = tmpfile();
    fflush(NULL);
    pid_t child = words ? fork() : -1;
    if (child < 0) {
        perror("torture");
        exit(2);
    }
    if (child == 0) {
        dup2(fileno(words), STDERR_FILENO);
        set_limits(t->seconds);
        judge_case(c, t->verdict);
        fflush(NULL);
        exit(EXIT_SUCCESS); /* exit() also runs the leak checker */
    }
    int status;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR)
        continue;
    judge_end(t->verdict, status, words);
    fclose(words);
}

/* --- failures */

struct same_fault {
    struct torture *torture;
    char fault[48];
};

static bool fails_the_same(void *user, const struct torture_case *c)
{
    struct same_fault *s = user;
    run_case(s->torture, c);
    return strcmp(s->torture->verdict->fault, s->fault) == 0;
}

static void make_small(struct torture *t, struct torture_case *c)
{
    struct same_fault same = {.torture = t};
    double seconds = t->seconds;
    memcpy(same.fault, t->verdict->fault, sizeof same.fault);
    t->seconds = fmin(seconds, 5);
    minimise(c, fails_the_same, &same, TRIALS);
    t->seconds = seconds;
    run_case(t, c);
}

static void add_to_tally(struct torture *t, const struct torture_case *c)
{
    t->n_failed++;
    for (int32_t i = 0; i < t->n_tally; i++) {
        if (strcmp(t->tally[i].fault, t->verdict->fault) == 0 && t->tally[i].family == c->family) {
            t->tally[i].n++;
            return;
        }
    }
    if (t->n_tally == MOST_FAULTS)
        return;
    struct tally *new = &t->tally[t->n_tally++];
    *new = (struct tally){.family = c->family, .n = 1, .seed = c->seed};
    memcpy(new->fault, t->verdict->fault, sizeof new->fault);
}

static void report_failure(struct torture *t, struct torture_case *c)
{
    char path[1024] = "", command[1400];
    add_to_tally(t, c);
    if (t->minimise)
        make_small(t, c);
    const struct tri_pslg *p = &c->figure.pslg;
    if (t->out) {
        snprintf(path, sizeof path, "%s/%s_%llu.poly", t->out, t->file ? "file" : c->family,
                 (unsigned long long)c->seed);
        if (!case_write(c, path, t->verdict->fault))
            perror(path);
    }
    case_command(c, path[0] ? path : t->file ? t->file : "F", command, sizeof command);
    printf("FAIL  seed %llu %s, %d points, %d segments: %s: %s\n      %s\n", (unsigned long long)c->seed, c->family,
           (int)p->n_points, (int)p->n_segments, t->verdict->fault, t->verdict->detail, command);
    fflush(stdout);
}

static void summarise(const struct torture *t)
{
    printf("%d cases, %lld triangles, %d failures\n", (int)t->count, (long long)t->triangles, (int)t->n_failed);
    for (int32_t i = 0; i < t->n_tally; i++)
        printf("  %-24s %-16s %5d  first seed %llu\n", t->tally[i].fault, t->tally[i].family, (int)t->tally[i].n,
               (unsigned long long)t->tally[i].seed);
}

/* --- arguments */

enum { SEED = 1, COUNT, FAMILIES, LIST, NEAR, FILE_NAME, SWITCHES, BLOCK, AGAIN, OUT, MINIMISE, IGNORE, SECONDS,
       VERBOSE };

static const struct option options[] = {{"seed", 1, NULL, SEED},
                                        {"count", 1, NULL, COUNT},
                                        {"families", 1, NULL, FAMILIES},
                                        {"list", 0, NULL, LIST},
                                        {"near", 0, NULL, NEAR},
                                        {"file", 1, NULL, FILE_NAME},
                                        {"switches", 1, NULL, SWITCHES},
                                        {"block", 1, NULL, BLOCK},
                                        {"again", 0, NULL, AGAIN},
                                        {"out", 1, NULL, OUT},
                                        {"minimise", 0, NULL, MINIMISE},
                                        {"ignore", 1, NULL, IGNORE},
                                        {"seconds", 1, NULL, SECONDS},
                                        {"verbose", 0, NULL, VERBOSE},
                                        {0}};

static bool add_families(struct torture *t, char *names)
{
    for (char *name = strtok(names, ","); name; name = strtok(NULL, ",")) {
        const struct family *family = family_named(name);
        if (!family || t->range.n_families == MOST_FAMILIES) {
            fprintf(stderr, "torture: no family %s\n", name);
            return false;
        }
        t->families[t->range.n_families++] = family;
    }
    return true;
}

static void list_families(void)
{
    for (int32_t i = 0; i < family_count(); i++)
        printf("%s%s\n", family_at(i)->name, family_at(i)->is_near ? " (near)" : "");
    exit(EXIT_SUCCESS);
}

/* Applies one option. Returns false if it is not an option or its value is invalid. */
static bool apply(struct torture *t, int option)
{
    switch (option) {
    case SEED: t->seed = strtoull(optarg, NULL, 10); return true;
    case COUNT: t->count = (int32_t)strtol(optarg, NULL, 10); return true;
    case FAMILIES: return add_families(t, optarg);
    case LIST: list_families(); return true;
    case NEAR: t->range.only_triangulate = true; return true;
    case FILE_NAME: t->file = optarg; return true;
    case SWITCHES: snprintf(t->given.switches, sizeof t->given.switches, "%s", optarg); return true;
    case BLOCK: t->given.block = (int32_t)strtol(optarg, NULL, 10); return true;
    case AGAIN: t->given.again = true; return true;
    case OUT: t->out = optarg; return mkdir(optarg, 0777) == 0 || errno == EEXIST;
    case MINIMISE: t->minimise = true; return true;
    case IGNORE: t->ignored = optarg; return true;
    case SECONDS: t->seconds = strtod(optarg, NULL); return t->seconds > 0;
    case VERBOSE: t->verbose = true; return true;
    default: return false;
    }
}

static bool take_arguments(struct torture *t, int argc, char **argv)
{
    for (int option; (option = getopt_long(argc, argv, "", options, NULL)) != -1;)
        if (!apply(t, option))
            return false;
    return optind == argc;
}

static void use_all_families(struct torture *t)
{
    for (int32_t i = 0; i < family_count() && i < MOST_FAMILIES; i++)
        if (family_at(i)->is_near || !t->range.only_triangulate)
            t->families[t->range.n_families++] = family_at(i);
}

/* --- the whole run */

/* Adds the options that apply to all cases that are refined. */
static void add_given(const struct torture *t, struct torture_case *c)
{
    size_t n = strlen(c->switches);
    if (!case_is_refined(c))
        return;
    snprintf(c->switches + n, sizeof c->switches - n, "%s", t->given.switches);
    c->block = t->given.block > 0 ? t->given.block : c->block;
    c->again |= t->given.again;
}

static bool make_case(const struct torture *t, int32_t i, struct torture_case *c)
{
    if (!t->file) {
        *c = case_draw(t->seed + (uint64_t)i, &t->range);
        add_given(t, c);
        return true;
    }
    *c = t->given;
    if (!c->switches[0])
        snprintf(c->switches, sizeof c->switches, "p");
    return case_read(c, t->file);
}

static void run_all(struct torture *t)
{
    for (int32_t i = 0; i < t->count; i++) {
        struct torture_case c;
        if (!make_case(t, i, &c))
            exit(2);
        if (t->verbose) {
            printf("seed %llu %s -%s block %d points %d segments %d\n", (unsigned long long)c.seed, c.family,
                   c.switches, (int)c.block, (int)c.figure.pslg.n_points, (int)c.figure.pslg.n_segments);
            fflush(stdout);
        }
        run_case(t, &c);
        t->triangles += t->verdict->triangles;
        if (t->verdict->fault[0] && !judge_names(t->ignored, t->verdict->fault))
            report_failure(t, &c);
        case_free(&c);
    }
}

int main(int argc, char **argv)
{
    struct torture t = {.seed = 1, .count = 500, .seconds = 300};
    t.range.families = t.families;
    t.verdict = mmap(NULL, sizeof *t.verdict, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (t.verdict == MAP_FAILED || !take_arguments(&t, argc, argv)) {
        fputs(usage, stderr);
        return 2;
    }
    if (t.range.n_families == 0)
        use_all_families(&t);
    t.count = t.file ? 1 : t.count;
    run_all(&t);
    summarise(&t);
    return t.n_failed > 0;
}
