/* Things that are made by several threads at once, in any order, and taken in their order by one: the caller's.
 *
 * Few are made ahead of those that have been taken: each has a slot until then. Whoever finds nothing to make, or to
 * take, waits for the others. */
#ifndef SCHED_TILES_PIPELINE_H
#define SCHED_TILES_PIPELINE_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"

struct par_pipeline {
    int32_t n;        /* things */
    int32_t n_slots;  /* at least 1 */
    int32_t n_threads; /* of the executor, of which the caller's thread is one */
    enum tri_status (*make)(void *context, int32_t i, int32_t slot, struct tri_error *error);
    enum tri_status (*take)(void *context, int32_t i, int32_t slot, struct tri_error *error); /* NULL: nobody does */
    void *context;
};

/* Until all are taken, or one of the calls returns something else than TRI_OK, which is returned then. */
enum tri_status par_pipeline_run(const struct par_pipeline *pipeline, const struct tri_executor *executor,
                                 struct tri_error *error);

#endif
