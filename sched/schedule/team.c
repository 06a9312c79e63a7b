/* A team of threads that run tasks and sleep in between.
 *
 * A job is open while its caller is busy with it. A thread that wakes up in time joins the job. When no task is left to
 * begin, the caller closes the job and waits for the threads that have joined, but not for threads that are still
 * asleep. So a job that is too short for several threads costs no more than the call that wakes them. */
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "sched/schedule/threads.h"
#include "triangle/base/system.h"
#ifdef _OPENMP
#include <omp.h>
#endif

/* One call of the executor: n tasks. Lives on the caller's stack until the job is closed and all threads have left
 * it. */
struct job {
    void (*task)(void *context, size_t index); /* called for each index */
    void *context;      /* passed to task */
    size_t n;           /* number of tasks */
    atomic_size_t next; /* index of the next task that no thread has begun; >= n: none is left */
};

/* The helper threads of a team, and the monitors by which they wait. */
struct par_crew {
    struct tri_monitor *gate; /* guards the members from here to joined; signalled for a new job and for the end */
    struct job *job;          /* the open job; NULL: none */
    uint64_t opened;          /* number of jobs so far */
    int joined;               /* number of threads that have joined the last job */
    struct tri_monitor *door; /* guards the members from here to expected; signalled when the last thread has left */
    int left;                 /* number of threads that have left the last job */
    int expected;             /* number of threads that have joined it; INT_MAX: unknown, because the job is still
                                 open */
    struct tri_monitor *end;  /* signalled only for the end */
    bool is_over;             /* no more jobs will follow; written while holding gate and end, read while holding
                                 either */
    int size;                 /* number of threads requested, without the calling thread */
    int n_started;            /* number of entries of thread; with OpenMP one, the thread that opens the parallel
                                 region */
    struct tri_thread *thread[]; /* [n_started] the threads */
};

static _Thread_local bool is_working; /* this thread is running tasks of some team */

bool par_team_works(void) { return is_working; }

/* Runs tasks of the job until none is left to begin. Called by the caller and by all threads that have joined. Calls
 * may be nested, so the old value of the flag is restored. */
static void work_on_job(struct job *job)
{
    const bool before = is_working;
    is_working = true;
    for (size_t i; (i = atomic_fetch_add_explicit(&job->next, 1, memory_order_relaxed)) < job->n;)
        job->task(job->context, i);
    is_working = before;
}

/* --- threads of the crew */

/* Waits for a job other than the last one that this thread has joined, and joins it. Returns NULL at the end of the
 * team. *last: the number of that job. */
static struct job *join_job(struct par_crew *crew, uint64_t *last)
{
    tri_monitor_enter(crew->gate);
    while (!crew->is_over && (!crew->job || crew->opened == *last))
        tri_monitor_wait(crew->gate);
    struct job *job = crew->is_over ? NULL : crew->job;
    *last = crew->opened;
    crew->joined += job != NULL;
    tri_monitor_leave(crew->gate);
    return job;
}

/* Leaves the job. The thread does not access the job afterwards; the last one wakes the caller. */
static void leave_job(struct par_crew *crew)
{
    tri_monitor_enter(crew->door);
    if (++crew->left == crew->expected)
        tri_monitor_wake(crew->door);
    tri_monitor_leave(crew->door);
}

/* The main function of a helper thread: joins one job after the other until the end. */
static void *run_helper(void *user)
{
    struct par_crew *crew = user;
    uint64_t last = 0;
    for (struct job *job; (job = join_job(crew, &last));) {
        work_on_job(job);
        leave_job(crew);
    }
    return NULL;
}

#ifdef _OPENMP
/* A separate thread opens an OpenMP region that lasts as long as the crew. OpenMP binds the region's first thread to
 * the same processor as the calling thread, which is busy, so this first thread only sleeps until the end. */
static void *open_region(void *user)
{
    struct par_crew *crew = user;
#pragma omp parallel num_threads(crew->size + 1)
    if (omp_get_thread_num() > 0) {
        run_helper(crew);
    } else {
        tri_monitor_enter(crew->end);
        while (!crew->is_over)
            tri_monitor_wait(crew->end);
        tri_monitor_leave(crew->end);
    }
    return NULL;
}
#endif

/* --- the calling thread */

/* Frees the crew; its threads have ended or were never started. */
static void free_crew(struct par_crew *crew)
{
    tri_monitor_free(crew->gate);
    tri_monitor_free(crew->door);
    tri_monitor_free(crew->end);
    free(crew);
}

/* Starts up to `size` helper threads, fewer if the system refuses some. NULL: none could be started. */
static struct par_crew *start_crew(int size)
{
    struct par_crew *crew = calloc(1, sizeof *crew + (size_t)size * sizeof *crew->thread);
    if (!crew)
        return NULL;
    crew->size = size;
    crew->gate = tri_monitor_new();
    crew->door = tri_monitor_new();
    crew->end = tri_monitor_new();
    /* Without all three monitors, no thread is started. */
    const bool ready = crew->gate && crew->door && crew->end;
#ifdef _OPENMP
    if (ready && (crew->thread[0] = tri_thread_start(open_region, crew)))
        crew->n_started = 1;
#else
    while (ready && crew->n_started < size && (crew->thread[crew->n_started] = tri_thread_start(run_helper, crew)))
        crew->n_started++;
#endif
    if (crew->n_started > 0)
        return crew;
    free_crew(crew);
    return NULL;
}

/* Offers the job to the helper threads, and wakes them. */
static void open_job(struct par_crew *crew, struct job *job)
{
    crew->left = 0; /* no lock needed: no thread has joined this job yet */
    crew->expected = INT_MAX;
    tri_monitor_enter(crew->gate);
    crew->job = job;
    crew->opened++;
    crew->joined = 0;
    tri_monitor_wake(crew->gate);
    tri_monitor_leave(crew->gate);
}

/* Closes the job to further threads, and waits until those that have joined have left it. */
static void close_job(struct par_crew *crew)
{
    tri_monitor_enter(crew->gate);
    crew->job = NULL;
    /* From here on no other thread joins. */
    const int joined = crew->joined;
    tri_monitor_leave(crew->gate);
    tri_monitor_enter(crew->door);
    crew->expected = joined;
    while (crew->left < joined)
        tri_monitor_wait(crew->door);
    tri_monitor_leave(crew->door);
}

/* The run function of the executor: opens the job, runs tasks, and closes the job. Starts the helper threads at the
 * first call that needs them. Without helper threads, the calling thread runs all tasks. */
static void run_on_team(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    struct par_team *team = self;
    struct job job = {task, context, n_tasks, 0};
    /* The first job starts the threads; if the system refuses all, the next job tries again. */
    if (team->threads > 1 && !team->crew)
        team->crew = start_crew(team->threads - 1);
    if (team->crew)
        open_job(team->crew, &job);
    work_on_job(&job);
    if (team->crew)
        close_job(team->crew);
}

struct tri_executor par_executor(struct par_team *team) { return (struct tri_executor){run_on_team, team}; }

void par_team_end(struct par_team *team)
{
    struct par_crew *crew = team->crew;
    team->crew = NULL;
    if (!crew)
        return;
    tri_monitor_enter(crew->gate);
    tri_monitor_enter(crew->end);
    crew->is_over = true;
    /* With OpenMP, the region's first thread waits at `end`; all others wait at `gate`. */
    tri_monitor_wake(crew->end);
    tri_monitor_leave(crew->end);
    tri_monitor_wake(crew->gate);
    tri_monitor_leave(crew->gate);
    /* Threads leave_job their loops when they see is_over. */
    for (int i = 0; i < crew->n_started; i++)
        tri_thread_join(crew->thread[i]);
    free_crew(crew);
}
