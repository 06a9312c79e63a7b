/* Lists of ids, and one of them: triangles that may be bad, which a schedule works off, with the keys that order it. */
#ifndef SCHED_SCHEDULE_WORKLIST_H
#define SCHED_SCHEDULE_WORKLIST_H

#include "sched/schedule/partition.h"
#include "triangle/base/executor.h"
#include "triangle/refine/refine.h"

/* Ids of one kind: triangles, vertices or subsegments; whoever has the list says which. */
struct par_ids {
    int32_t *item;
    int32_t n, capacity;
};

/* Room for one more. False: no memory. */
bool par_ids_grow(struct par_ids *ids);

/* Amortised O(1). False: no memory. */
static inline bool par_ids_add(struct par_ids *ids, int32_t id)
{
    if (ids->n == ids->capacity && !par_ids_grow(ids))
        return false;
    ids->item[ids->n++] = id;
    return true;
}

/* So many more. False: no memory. */
bool par_ids_add_all(struct par_ids *ids, const int32_t *more, int32_t n);

/* Brings ids in ascending order, each once; returns how many are left. */
int32_t par_sort_unique(int32_t *item, int32_t n);

/* Of a list in ascending order the place of the first item that is not less than this. */
int32_t par_ids_find(const struct par_ids *ids, int32_t id);

/* A set of triangles, as bits. */
struct par_triangle_set {
    uint64_t *word; /* [(n_triangles + 63) / 64] */
};

/* The triangles of a list, out of n_triangles; false: no memory. To be freed by free(set->word). O(n_triangles). */
bool par_triangle_set_of(struct par_triangle_set *set, const struct par_ids *triangles, int32_t n_triangles);

static inline bool par_is_in(const struct par_triangle_set *set, tri_triangle_id t)
{
    return set->word[t / 64] >> t % 64 & 1;
}

/* The worklist becomes all triangles that violate the bounds, in the order of their numbers; *radius, the largest
 * circumradius among them. known: the worklist is that already, for the mesh as it was after the last call; then only
 * triangles born since are judged. All begin a new life, see struct tri_triangle.life. TRI_NO_MEMORY: the worklist is
 * as before. O(triangles). */
enum tri_status par_worklist_fill(struct par_ids *worklist, struct tri_mesh *mesh,
                                  const struct tri_quality *quality, bool known,
                                  const struct tri_executor *executor, double *radius, struct tri_error *error);

/* Who left each triangle of a worklist, and when: round + 1 (8 bits), place of the block in the order of all, by
 * column, phase and row, + 1 (24 bits), how many triangles it had left before (32 bits). A triangle that no block has
 * had has the key PAR_NO_ROUND, its tile (block of the first phase) and its place in the tile's list
 * (par_order_by_tile); or only its place in the list of all. So keys do not depend on who else was at work. */
struct par_keys {
    uint64_t *item;
    int32_t n, capacity;
};

enum { PAR_NO_ROUND = -1 };

/* The key of the first triangle that a block leaves in a phase of a round. */
uint64_t par_key_of(const struct par_partition *partition, int round, int phase, int32_t block);

/* Orders a worklist, whose triangles are listed once each, tile by tile, and within each along a Hilbert curve through
 * the triangles' centres; gives each its key. A triangle is of the tile that holds its home: the corner behind the
 * obtuse one, else the first. Triangles of no tile (block of the first phase) from first to end - 1 leave the list.
 * False: no memory, and the worklist is as before. O(n).
 *
 * THEOREM. The order of the triangles, and their keys, depend on the mesh but for its ids: home and centre are those of
 * the corners as the triangle is turned; of triangles with equal centres, that of the lower corners comes first, and
 * two different ones do not have the same first two corners. So a rank that has all triangles with a corner in some
 * tiles (sched/ranks/ranks.h) gives those of these tiles the keys that they have in one process. And it has found them:
 * what is bad about a triangle is in its corners, or in a subsegment that it encroaches; that lies opposite its obtuse
 * corner, so that it ends at the home, and is known here. */
bool par_order_by_tile(struct par_ids *worklist, struct par_keys *key, const struct tri_mesh *mesh,
                       const struct par_partition *tiles, int32_t first, int32_t end,
                       const struct tri_executor *executor);

/* Bytes that the sort takes beside the worklist. */
static inline size_t par_order_bytes(const struct par_ids *worklist) { return 48 * (size_t)worklist->n; }

#endif
