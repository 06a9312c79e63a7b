/* One lock, one condition. INVARIANT under the lock: taken <= begun <= taken + n_slots. Item i
 * occupies slot i % n_slots from its start until it has been consumed, and no other item does.
 *
 * THEOREM (no deadlock). A worker waits only if it can neither start nor consume an item. If all started items have
 * been consumed, another one can be started. Otherwise the next item to be consumed has been started. Either a thread
 * is making or consuming it, or it is ready for the caller's thread, which is then busy with another item and does not
 * wait. Executors may also run workers one after the other. The first worker, on the caller's thread, then does all the
 * work. */
#include "sched/tiles/pipeline.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>

#include "triangle/base/system.h"

static _Thread_local char this_thread; /* its address identifies a thread */

/* A running pipeline. */
struct pipeline_state {
    const struct par_pipeline *p; /* the pipeline */
    const void *caller;          /* address of the caller's this_thread */
    struct tri_monitor *monitor; /* protects the fields below */
    bool *made;                  /* [n_slots] the item in the slot is ready to be consumed */
    int32_t begun, taken;        /* items started; items consumed */
    enum tri_status status;      /* first error; TRI_OK: none */
    struct tri_error *error;     /* receives the details of the first error; NULL: not wanted */
};

typedef enum tri_status (*step_call)(void *context, int32_t i, int32_t slot, struct tri_error *error);

/* Calls `make` or `take` for item i. Releases the lock during the call. */
static void step(struct pipeline_state *w, step_call call, int32_t i)
{
    struct tri_error error = {0};
    tri_monitor_leave(w->monitor);
    enum tri_status status = call ? call(w->p->context, i, i % w->p->n_slots, &error) : TRI_OK;
    tri_monitor_enter(w->monitor);
    if (status && !w->status) {
        w->status = status;
        if (w->error)
            *w->error = error;
    }
}

/* Returns whether this thread can start an item: a slot is free. */
static bool may_begin(const struct pipeline_state *w)
{
    return w->begun < w->p->n && w->begun < w->taken + w->p->n_slots;
}

/* Returns whether this thread can consume the next item: it is ready, and this is the caller's thread. */
static bool may_consume(const struct pipeline_state *w)
{
    return w->taken < w->begun && w->made[w->taken % w->p->n_slots] && w->caller == &this_thread;
}

static void make_next(struct pipeline_state *w)
{
    int32_t i = w->begun++;
    step(w, w->p->make, i);
    w->made[i % w->p->n_slots] = true;
}

static void consume_next(struct pipeline_state *w)
{
    int32_t i = w->taken;
    step(w, w->p->take, i);
    w->made[i % w->p->n_slots] = false;
    w->taken++;
}

/* A worker: consumes or makes items until all have been consumed or a call has failed. */
static void work(void *context, size_t worker)
{
    struct pipeline_state *w = context;
    (void)worker;
    tri_monitor_enter(w->monitor);
    while (!w->status && w->taken < w->p->n) {
        if (may_consume(w))
            consume_next(w);
        else if (may_begin(w))
            make_next(w);
        else {
            tri_monitor_wait(w->monitor);
            continue;
        }
        tri_monitor_wake(w->monitor);
    }
    tri_monitor_leave(w->monitor);
}

enum tri_status par_pipeline_run(const struct par_pipeline *pipeline, const struct tri_executor *executor,
                                 struct tri_error *error)
{
    struct pipeline_state w = {.p = pipeline, .caller = &this_thread, .error = error};
    assert(pipeline->n_slots > 0 && pipeline->n_threads > 0);
    w.made = calloc((size_t)pipeline->n_slots, sizeof *w.made);
    w.monitor = tri_monitor_new();
    if (w.made && w.monitor)
        tri_execute(executor, (size_t)pipeline->n_threads, work, &w);
    else
        w.status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a pipeline");
    assert(w.status || w.taken == pipeline->n);
    tri_monitor_free(w.monitor);
    free(w.made);
    return w.status;
}
