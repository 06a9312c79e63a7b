/* Lists of ids, and the worklist of a schedule: triangles that may be bad, with the keys by which they are ordered. */
#ifndef SCHED_SCHEDULE_WORKLIST_H
#define SCHED_SCHEDULE_WORKLIST_H

#include "sched/schedule/partition.h"
#include "triangle/base/executor.h"
#include "triangle/refine/refine.h"

/* A list of ids of one kind: triangles, vertices or subsegments, depending on the list. */
struct par_ids {
    int32_t *item; /* [n] the ids */
    int32_t n, capacity; /* number of ids; allocated ids */
};

/* Makes room for one more id. False: no memory. */
bool par_ids_grow(struct par_ids *ids);

/* Appends an id. Amortised O(1). False: no memory. */
static inline bool par_ids_add(struct par_ids *ids, int32_t id)
{
    if (ids->n == ids->capacity && !par_ids_grow(ids))
        return false;
    ids->item[ids->n++] = id;
    return true;
}

/* Appends n ids. False: no memory; the list is then unchanged. */
bool par_ids_add_all(struct par_ids *ids, const int32_t *more, int32_t n);

/* Sorts ids in ascending order and removes duplicates; returns how many remain. */
int32_t par_sort_unique(int32_t *item, int32_t n);

/* In a list in ascending order, returns the index of the first item that is not less than id. */
int32_t par_ids_find(const struct par_ids *ids, int32_t id);

/* A set of triangles, one bit each. */
struct par_triangle_set {
    uint64_t *word; /* [n_triangles / 64 + 1] bit t % 64 of word t / 64: triangle t is in the set */
};

/* Makes the set of the triangles in a list; all are below n_triangles. False: no memory. Free with free(set->word).
 * O(n_triangles). */
bool par_triangle_set_of(struct par_triangle_set *set, const struct par_ids *triangles, int32_t n_triangles);

static inline bool par_is_in(const struct par_triangle_set *set, tri_triangle_id t)
{
    return set->word[t / 64] >> t % 64 & 1;
}

/* Fills the worklist with all triangles that violate the bounds, in ascending order of their ids. *radius: the largest
 * circumradius among them. known: the worklist already holds the bad triangles of the mesh as it was after the previous
 * call, so that only triangles created since need to be judged. Resets the generation of every triangle
 * (tri_triangle.generation) to 0, by which the next call recognises new triangles. TRI_NO_MEMORY: the worklist is
 * unchanged. O(triangles). */
enum tri_status par_worklist_fill(struct par_ids *worklist, struct tri_mesh *mesh,
                                  const struct tri_quality *quality, bool known,
                                  const struct tri_executor *executor, double *radius, struct tri_error *error);

/* The keys of a worklist: which block left each triangle, and when. From the highest bits down:
 *
 *    8 bits   round + 1
 *   24 bits   1 + the block's place in the order of all blocks: by column, phase and row
 *   32 bits   number of triangles that the block had left before
 *
 * The key of a triangle that no block has left yet consists of PAR_NO_ROUND, its tile (block of the first phase) and
 * its place in the tile's list (par_order_by_tile). If such a list has not been made, the key is the triangle's place
 * in the whole worklist. So keys do not depend on which other blocks ran at the same time. */
struct par_keys {
    uint64_t *item; /* [n] ascending; item[i] is the key of worklist entry i */
    int32_t n, capacity; /* number of keys; allocated keys */
};

enum { PAR_NO_ROUND = -1 };

/* Returns the key of the first triangle that a block leaves in a phase of a round. */
uint64_t par_key_of(const struct par_partition *partition, int round, int phase, int32_t block);

/* Orders a worklist without duplicates tile by tile, and within each tile along a Hilbert curve through the triangles'
 * centres. Computes the key of each. A triangle belongs to the tile that holds its home vertex: the corner after the
 * obtuse one, or its first corner if no corner is obtuse. Only triangles whose tile, as a block of the first phase, is
 * one of first .. end - 1 stay in the list. False: no memory, and the worklist is unchanged. O(n).
 *
 * THEOREM. The order of the triangles, and their keys, depend on the mesh but not on its ids. Home vertex and centre
 * depend only on the corners, in the order in which the triangle stores them. Of triangles with equal centres, the one
 * whose first corners are smaller comes first, and two different triangles never have the same first two corners. So a
 * rank that holds all triangles with a corner in some tiles (sched/ranks/ranks.h) gives the triangles of these tiles
 * the same keys as one process would. The rank also finds them all: a triangle is bad either because of its corners or
 * because of a subsegment that it encroaches. Such a subsegment lies opposite the obtuse corner, so it ends at the home
 * vertex, and the rank holds it. */
bool par_order_by_tile(struct par_ids *worklist, struct par_keys *key, const struct tri_mesh *mesh,
                       const struct par_partition *tiles, int32_t first, int32_t end,
                       const struct tri_executor *executor);

/* Bytes of temporary memory that par_order_by_tile needs in addition to the worklist. */
static inline size_t par_order_bytes(const struct par_ids *worklist) { return 48 * (size_t)worklist->n; }

#endif
