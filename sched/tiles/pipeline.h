/* A pipeline: several threads make items concurrently in any order; the caller's thread consumes them in order.
 *
 * Each item occupies a slot from its making until it has been consumed. The number of slots bounds how many items are
 * made ahead. A thread that has nothing to make or to consume waits. */
#ifndef SCHED_TILES_PIPELINE_H
#define SCHED_TILES_PIPELINE_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"

struct par_pipeline {
    int32_t n;         /* number of items */
    int32_t n_slots;   /* number of slots, at least 1 */
    int32_t n_threads; /* threads of the executor, including the caller's */
    /* Makes item i in a slot. Called on any thread. */
    enum tri_status (*make)(void *context, int32_t i, int32_t slot, struct tri_error *error);
    /* Consumes item i from its slot. Called on the caller's thread. NULL: the slot is freed without a call. */
    enum tri_status (*take)(void *context, int32_t i, int32_t slot, struct tri_error *error);
    void *context; /* passed to make and take */
};

/* Returns when all items have been consumed, or with the first status other than TRI_OK of `make` or `take`. */
enum tri_status par_pipeline_run(const struct par_pipeline *pipeline, const struct tri_executor *executor,
                                 struct tri_error *error);

#endif
