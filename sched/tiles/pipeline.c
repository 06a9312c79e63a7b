/* One lock, one condition. INVARIANT under the lock: taken <= begun <= taken + n_slots; thing i has slot i % n_slots
 * from when it is begun until it is taken, and no other has that.
 *
 * THEOREM (nobody waits for ever). A worker waits only if the next thing to take has been begun, and is being made or
 * taken, or is made and waits for the caller's thread, which makes other things or takes: none of these waits. For if
 * nothing has been begun that is not taken, something may be begun. Executors may run workers one after the other: the
 * first, in the caller's thread, then does it all. */
#include "sched/tiles/pipeline.h"

#include <assert.h>
#include <pthread.h>
#include <stdbool.h>
#include <stdlib.h>

struct works {
    const struct par_pipeline *p;
    pthread_t caller;
    pthread_mutex_t lock;
    pthread_cond_t changed;
    bool *made;               /* [n_slots] what is in the slot */
    int32_t begun, taken;
    enum tri_status status;
    struct tri_error *error;
};

typedef enum tri_status (*step_call)(void *context, int32_t i, int32_t slot, struct tri_error *error);

/* Without the lock, which is held before and after. */
static void step(struct works *w, step_call call, int32_t i)
{
    struct tri_error error = {0};
    pthread_mutex_unlock(&w->lock);
    enum tri_status status = call ? call(w->p->context, i, i % w->p->n_slots, &error) : TRI_OK;
    pthread_mutex_lock(&w->lock);
    if (status && !w->status) {
        w->status = status;
        if (w->error)
            *w->error = error;
    }
}

static bool may_begin(const struct works *w)
{
    return w->begun < w->p->n && w->begun < w->taken + w->p->n_slots;
}

static bool may_take(const struct works *w)
{
    return w->taken < w->begun && w->made[w->taken % w->p->n_slots] && pthread_equal(pthread_self(), w->caller);
}

static void make_next(struct works *w)
{
    int32_t i = w->begun++;
    step(w, w->p->make, i);
    w->made[i % w->p->n_slots] = true;
}

static void take_next(struct works *w)
{
    int32_t i = w->taken;
    step(w, w->p->take, i);
    w->made[i % w->p->n_slots] = false;
    w->taken++;
}

static void work(void *context, size_t worker)
{
    struct works *w = context;
    (void)worker;
    pthread_mutex_lock(&w->lock);
    while (!w->status && w->taken < w->p->n) {
        if (may_take(w))
            take_next(w);
        else if (may_begin(w))
            make_next(w);
        else {
            pthread_cond_wait(&w->changed, &w->lock);
            continue;
        }
        pthread_cond_broadcast(&w->changed);
    }
    pthread_mutex_unlock(&w->lock);
}

static bool begin(struct works *w)
{
    w->made = calloc((size_t)w->p->n_slots, sizeof *w->made);
    if (w->made && pthread_mutex_init(&w->lock, NULL) == 0) {
        if (pthread_cond_init(&w->changed, NULL) == 0)
            return true;
        pthread_mutex_destroy(&w->lock);
    }
    free(w->made);
    return false;
}

enum tri_status par_pipeline_run(const struct par_pipeline *pipeline, const struct tri_executor *executor,
                                 struct tri_error *error)
{
    struct works w = {.p = pipeline, .caller = pthread_self(), .error = error};
    assert(pipeline->n_slots > 0 && pipeline->n_threads > 0);
    if (!begin(&w))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a pipeline");
    tri_execute(executor, (size_t)pipeline->n_threads, work, &w);
    assert(w.status || w.taken == pipeline->n);
    pthread_cond_destroy(&w.changed);
    pthread_mutex_destroy(&w.lock);
    free(w.made);
    return w.status;
}
