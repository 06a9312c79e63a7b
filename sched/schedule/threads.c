/* Threads are tried by making them, and letting them wait for each other, so that all are there at once. */
#include "sched/schedule/threads.h"

#include <assert.h>
#ifdef _OPENMP
#include <omp.h>
#include <stdatomic.h>

#include "triangle/base/system.h"
#endif

#ifdef _OPENMP

/* A forked child has lost the threads that libgomp still counts on, and would wait for them for ever: it works alone.
 * That needs to be known process-wide, the one thing here that is. */
static bool is_forked(void)
{
    static _Atomic(long) first_process;
    long none = 0, self = tri_process();
    return !atomic_compare_exchange_strong(&first_process, &none, self) && none != self;
}

static void *wait_for_end(void *gate)
{
    tri_monitor_enter(gate);
    tri_monitor_leave(gate);
    return NULL;
}

/* How many threads can there be beside this one, if no more than n are wanted? */
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

/* Whatever the system gives. */
static int threads_wanted(int asked)
{
    if (is_forked())
        return 1;
    int threads = asked > 0 ? asked : omp_get_max_threads();
    return threads < PAR_MOST_THREADS ? threads : PAR_MOST_THREADS;
}

int par_threads(int asked, bool wary)
{
    int threads = threads_wanted(asked);
    if (threads <= 1 || (!wary && threads <= omp_get_num_procs()))
        return threads;
    int made = try_threads(threads - 1);
    return made == threads - 1 ? threads : made / 2 + 1; /* others, and memory, need some of what there is */
}
#else
static int threads_wanted(int asked)
{
    (void)asked;
    return 1;
}

int par_threads(int asked, bool wary)
{
    (void)asked, (void)wary;
    return 1;
}
#endif

static void run_in_parallel(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    int threads = threads_wanted(*(int *)self);
    assert(threads >= 1);
    threads = n_tasks < (size_t)threads ? (int)n_tasks : threads;
#pragma omp parallel for num_threads(threads) schedule(dynamic, 1) if (threads > 1)
    for (size_t i = 0; i < n_tasks; i++)
        task(context, i);
}

struct tri_executor par_executor(int *threads) { return (struct tri_executor){run_in_parallel, threads}; }
