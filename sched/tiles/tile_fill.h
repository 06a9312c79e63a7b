/* What is handed out of one tile: its vertices, triangles and subsegments in the order of their numbers. */
#ifndef SCHED_TILES_TILE_FILL_H
#define SCHED_TILES_TILE_FILL_H

#include "sched/tiles/tile_copy.h"

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
 * It is live still. Returns a note for whoever fills its tile, whose own vertices have numbers from `first` on: so that
 * it need not look at triangles, which lie scattered, twice. n_input: as the mesh's. */
int32_t par_final_make(struct tri_triangle *triangle, const int64_t number[3], int64_t first, int64_t n_input);

/* What is in a tile. */
struct par_tile_ids {
    const int32_t *vertices;          /* in their order */
    const int32_t *triangles, *notes; /* final, and what par_final_make said of each, in any order */
    const int32_t *subs;              /* in any order */
};

/* Fills the arrays of job->tile, of which the numbers are known. The triangles' ids are free afterwards. number: of
 * each vertex. False: no memory. */
bool par_tile_fill(struct par_tile_job *job, const struct tri_mesh *mesh, const int64_t *number,
                   const struct par_tile_ids *ids);

#endif
