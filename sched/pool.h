/* Bad triangles, by slot: what a schedule works off. */
#ifndef SCHED_POOL_H
#define SCHED_POOL_H

#include "triangle/refine.h"

struct par_slots {
    int32_t *item;
    int32_t n, capacity;
};

/* Amortised O(1). False: no memory. */
bool par_slots_add(struct par_slots *slots, int32_t slot);

/* The pool becomes all triangles that violate the bounds, in the order of their slots; *radius, the largest circumradius
 * among them. n_known > 0: the pool is that already for the mesh as it was after the last call, when it had n_known
 * slots; then only triangles born since are judged. All slots begin a new life (struct tri_triangle.state).
 * TRI_NO_MEMORY: the pool is as before. O(slots), in parallel. */
enum tri_status par_pool_fill(struct par_slots *pool, struct tri_mesh *mesh, const struct tri_refine_options *quality,
                              int32_t n_known, int threads, double *radius, struct tri_error *error);

/* *found receives those that violate other bounds, in the same order. False: no memory, and *found is empty. */
bool par_pool_filter(const struct par_slots *pool, const struct tri_mesh *mesh, const struct tri_refine_options *bounds,
                     int threads, struct par_slots *found);

#endif
