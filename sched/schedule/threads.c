/* Determines how many threads a call may use. To test how many threads the system allows, this many are started and
 * wait for each other, so that all exist at the same time. */
#include "sched/schedule/threads.h"

#include <stdlib.h>

#include "triangle/base/system.h"

#ifdef _OPENMP
#include <omp.h>

/* default_threads returns the number of threads for callers that request none. must_try returns whether to test that
 * the system allows `threads` threads. */
static int default_threads(void) { return omp_in_parallel() ? 1 : omp_get_max_threads(); }
static bool must_try(int threads, bool wary) { return wary || threads > omp_get_num_procs(); }

#else

#ifdef __ELF__ /* not NULL if the caller's program links an OpenMP runtime */
__attribute__((weak)) int omp_in_parallel(void);
__attribute__((weak)) int omp_get_max_threads(void);
#endif

static int default_threads(void)
{
#ifdef __ELF__
    if (omp_in_parallel && omp_get_max_threads)
        return omp_in_parallel() ? 1 : omp_get_max_threads();
#endif
    const char *text = getenv("OMP_NUM_THREADS");
    const long requested = text ? strtol(text, NULL, 10) : 0;
    return requested <= 0 ? tri_processors() : requested < PAR_MOST_THREADS ? (int)requested : PAR_MOST_THREADS;
}

/* A team works with fewer threads if the system refuses some, so a test is needed only by callers that plan memory for
 * each thread. */
static bool must_try(int threads, bool wary)
{
    (void)threads;
    return wary;
}
#endif

/* The main function of a test thread: waits until all have been started. */
static void *wait_for_end(void *gate)
{
    tri_monitor_enter(gate);
    tri_monitor_leave(gate);
    return NULL;
}

/* Returns how many of n threads the system allows beside this one. */
static int try_threads(int n)
{
    struct tri_thread *thread[PAR_MOST_THREADS];
    struct tri_monitor *gate = tri_monitor_new();
    int made = 0;
    if (!gate)
        return 0;
    tri_monitor_enter(gate);
    while (made < n && (thread[made] = tri_thread_start(wait_for_end, gate)))
        made++;
    tri_monitor_leave(gate);
    for (int i = 0; i < made; i++)
        tri_thread_join(thread[i]);
    tri_monitor_free(gate);
    return made;
}

int par_threads(int asked, bool wary)
{
    int threads = asked > 0 ? asked : par_team_works() ? 1 : default_threads();
    threads = threads < PAR_MOST_THREADS ? threads : PAR_MOST_THREADS;
    if (threads <= 1 || !must_try(threads, wary))
        return threads;
    const int made = try_threads(threads); /* this counts the thread that opens OpenMP's region, but not the calling
                                              thread */
    return made == threads ? threads : made / 2 + 1; /* leave some for other threads of the process */
}
