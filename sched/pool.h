/* Bad triangles, by slot: what a schedule works off. */
#ifndef SCHED_POOL_H
#define SCHED_POOL_H

#include "triangle/executor.h"
#include "triangle/refine.h"

struct par_slots {
    int32_t *item;
    int32_t n, capacity;
};

/* Amortised O(1). False: no memory. */
bool par_slots_add(struct par_slots *slots, int32_t slot);

/* A set of slots, as bits. */
struct par_slot_set {
    uint64_t *word; /* [(n_slots + 63) / 64] */
};

/* The slots of a list, out of n_slots; false: no memory. To be freed by free(set->word). O(n_slots). */
bool par_slot_set_of(struct par_slot_set *set, const struct par_slots *slots, int32_t n_slots);

/* Adds a slot to the list unless it is in the set, which is that of the list. False: no memory. */
bool par_slots_add_new(struct par_slots *slots, struct par_slot_set *set, int32_t slot);

/* The pool becomes all triangles that violate the bounds, in the order of their slots; *radius, the largest
 * circumradius among them. known: the pool is that already, for the mesh as it was after the last call; then only
 * triangles born since are judged. (Where options.conforming counts, a triangle may have become bad or good with the
 * one across its subsegment, which was born since: that one is here.) All slots begin a new life, see struct
 * tri_triangle.state. TRI_NO_MEMORY: the pool is as before. O(slots). */
enum tri_status par_pool_fill(struct par_slots *pool, struct tri_mesh *mesh, const struct tri_refine_options *quality,
                              bool known, const struct tri_executor *executor, double *radius,
                              struct tri_error *error);

/* *found receives those that violate other bounds, in the same order. False: no memory, and *found is empty. */
bool par_pool_filter(const struct par_slots *pool, const struct tri_mesh *mesh,
                     const struct tri_refine_options *bounds, const struct tri_executor *executor,
                     struct par_slots *found);

#endif
