/* Lists of ids, and one of them: triangles that may be bad, which a schedule works off. */
#ifndef SCHED_SCHEDULE_WORKLIST_H
#define SCHED_SCHEDULE_WORKLIST_H

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

#endif
