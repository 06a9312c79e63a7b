/* Tasks handed out to threads that sleep in between.
 *
 * A job is open while its caller works on it. A thread that wakes up in time joins; the caller closes the job when no
 * task is left to begin, and then waits for those who have joined, not for those who are still asleep. A job that is
 * too short for a team costs the waking alone. */
#include <limits.h>
#include <stdatomic.h>
#include <stdlib.h>

#include "sched/schedule/threads.h"
#include "triangle/base/system.h"
#ifdef _OPENMP
#include <omp.h>
#endif

struct job {
    void (*task)(void *context, size_t index);
    void *context;
    size_t n;           /* tasks */
    atomic_size_t next; /* the first that nobody has begun; >= n: none */
};

struct par_crew {
    struct tri_monitor *gate; /* guards the members from here to joined; wakes for a new job, and for the end */
    struct job *job;          /* NULL: none is open */
    uint64_t opened;          /* jobs so far */
    int joined;               /* threads that have joined the last one */
    struct tri_monitor *door; /* guards the members from here to expected; wakes when the last thread has left */
    int left;                 /* threads that have left the last job */
    int expected;             /* threads that have joined it; INT_MAX: not known while it is open */
    struct tri_monitor *end;  /* wakes for the end alone */
    bool is_over;             /* no job will follow; written under both gate and end, read under either */
    int size;                 /* threads that were asked for, without the caller's */
    int n_started;            /* entries of thread; with OpenMP the one that opens its region */
    struct tri_thread *thread[];
};

static _Thread_local bool works; /* in work() */

bool par_team_works(void) { return works; }

static void work(struct job *job)
{
    const bool before = works;
    works = true;
    for (size_t i; (i = atomic_fetch_add_explicit(&job->next, 1, memory_order_relaxed)) < job->n;)
        job->task(job->context, i);
    works = before;
}

/* --- threads of the crew */

/* Waits for a job that is not the last one this thread has joined; NULL: the end. */
static struct job *join(struct par_crew *crew, uint64_t *last)
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

static void leave(struct par_crew *crew)
{
    tri_monitor_enter(crew->door);
    if (++crew->left == crew->expected)
        tri_monitor_wake(crew->door);
    tri_monitor_leave(crew->door);
}

static void *serve(void *user)
{
    struct par_crew *crew = user;
    uint64_t last = 0;
    for (struct job *job; (job = join(crew, &last));) {
        work(job);
        leave(crew);
    }
    return NULL;
}

#ifdef _OPENMP
/* A thread of its own opens a region, which lasts as long as the crew. OpenMP binds the region's first thread to the
 * place of the caller, which works there: it sleeps. */
static void *open_region(void *user)
{
    struct par_crew *crew = user;
#pragma omp parallel num_threads(crew->size + 1)
    if (omp_get_thread_num() > 0) {
        serve(crew);
    } else {
        tri_monitor_enter(crew->end);
        while (!crew->is_over)
            tri_monitor_wait(crew->end);
        tri_monitor_leave(crew->end);
    }
    return NULL;
}
#endif

/* --- their caller */

static void free_crew(struct par_crew *crew)
{
    tri_monitor_free(crew->gate);
    tri_monitor_free(crew->door);
    tri_monitor_free(crew->end);
    free(crew);
}

/* Those whom the system refuses are missing; NULL: all of them. */
static struct par_crew *start_crew(int size)
{
    struct par_crew *crew = calloc(1, sizeof *crew + (size_t)size * sizeof *crew->thread);
    if (!crew)
        return NULL;
    crew->size = size;
    crew->gate = tri_monitor_new();
    crew->door = tri_monitor_new();
    crew->end = tri_monitor_new();
    const bool ready = crew->gate && crew->door && crew->end;
#ifdef _OPENMP
    if (ready && (crew->thread[0] = tri_thread_start(open_region, crew)))
        crew->n_started = 1;
#else
    while (ready && crew->n_started < size && (crew->thread[crew->n_started] = tri_thread_start(serve, crew)))
        crew->n_started++;
#endif
    if (crew->n_started > 0)
        return crew;
    free_crew(crew);
    return NULL;
}

static void open_job(struct par_crew *crew, struct job *job)
{
    crew->left = 0; /* nobody has joined who could leave */
    crew->expected = INT_MAX;
    tri_monitor_enter(crew->gate);
    crew->job = job;
    crew->opened++;
    crew->joined = 0;
    tri_monitor_wake(crew->gate);
    tri_monitor_leave(crew->gate);
}

static void close_job(struct par_crew *crew)
{
    tri_monitor_enter(crew->gate);
    crew->job = NULL;
    const int joined = crew->joined;
    tri_monitor_leave(crew->gate);
    tri_monitor_enter(crew->door);
    crew->expected = joined;
    while (crew->left < joined)
        tri_monitor_wait(crew->door);
    tri_monitor_leave(crew->door);
}

static void run_on_team(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    struct par_team *team = self;
    struct job job = {task, context, n_tasks, 0};
    if (team->threads > 1 && !team->crew)
        team->crew = start_crew(team->threads - 1);
    if (team->crew)
        open_job(team->crew, &job);
    work(&job);
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
    tri_monitor_wake(crew->end);
    tri_monitor_leave(crew->end);
    tri_monitor_wake(crew->gate);
    tri_monitor_leave(crew->gate);
    for (int i = 0; i < crew->n_started; i++)
        tri_thread_join(crew->thread[i]);
    free_crew(crew);
}
