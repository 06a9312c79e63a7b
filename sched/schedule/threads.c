/* Threads are tried by making them, and letting them wait for each other, so that all are there at once. */
#include "sched/schedule/threads.h"

#include <assert.h>
#include <signal.h>

#ifdef _OPENMP
#include <omp.h>
#include <stdatomic.h>
#include <unistd.h>
#endif

bool par_thread_start(pthread_t *thread, void *(*run)(void *user), void *user)
{
    sigset_t all, before;
    sigfillset(&all);
    pthread_sigmask(SIG_SETMASK, &all, &before);
    bool started = pthread_create(thread, NULL, run, user) == 0;
    pthread_sigmask(SIG_SETMASK, &before, NULL);
    return started;
}

#ifdef _OPENMP

/* A forked child has lost the threads that libgomp still counts on, and would wait for them for ever: it works alone.
 * That needs to be known process-wide, the one thing here that is. */
static bool is_forked(void)
{
    static _Atomic(long) first_process;
    long none = 0, self = (long)getpid();
    return !atomic_compare_exchange_strong(&first_process, &none, self) && none != self;
}

static void *wait_for_end(void *gate)
{
    pthread_mutex_lock(gate);
    pthread_mutex_unlock(gate);
    return NULL;
}

/* How many threads can there be beside this one, if no more than n are wanted? */
static int try_threads(int n)
{
    pthread_t thread[PAR_MOST_THREADS];
    pthread_mutex_t gate = PTHREAD_MUTEX_INITIALIZER;
    int made = 0;
    pthread_mutex_lock(&gate);
    while (made < n && par_thread_start(&thread[made], wait_for_end, &gate))
        made++;
    pthread_mutex_unlock(&gate);
    for (int i = 0; i < made; i++)
        pthread_join(thread[i], NULL);
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
