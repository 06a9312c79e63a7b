/* What is handed out of one tile: its vertices, triangles and subsegments in the order of their numbers. */
#ifndef SCHED_SWEEP_TILE_FILL_H
#define SCHED_SWEEP_TILE_FILL_H

#include "sched/sweep/tile_copy.h"

/* Whoever fills tiles has one, for one tile after the other: all of it is used again. */
struct par_tile_job {
    struct tri_tile tile;
    struct par_tile_copy copy; /* where the tile's arrays are */
    uint64_t *scratch;         /* [n_scratch] */
    int64_t n_scratch;
};

/* Scratch of so many words. False: no memory. */
bool par_tile_job_reserve(struct par_tile_job *job, int64_t n);
void par_tile_job_free(struct par_tile_job *job);

/* Makes of a triangle that is final, in place, what is handed out of it: the numbers of its corners, the largest first.
 * It is live still. */
void par_final_make(struct tri_triangle *triangle, const int64_t number[3]);

/* Fills the arrays of job->tile, of which the numbers are known: from its vertices in their order, and from its final
 * triangles and subsegments in any order. The triangles' ids are free afterwards. number: of each vertex. False: no
 * memory. */
bool par_tile_fill(struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                   const int32_t *vertices, const int32_t *triangles, const int32_t *subs);

#endif
