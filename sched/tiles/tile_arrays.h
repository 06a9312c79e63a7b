/* The arrays of a tile as a list, for whoever copies, sends or keeps them and need not know what they are. */
#ifndef SCHED_TILES_TILE_ARRAYS_H
#define SCHED_TILES_TILE_ARRAYS_H

#include <stddef.h>

#include "ptriangle/tiles.h"
#include "triangle/mesh/mesh.h"

enum { PAR_TILE_CORNERS = 3, PAR_TILE_ENDS = 5, PAR_TILE_ARRAYS = 7 }; /* the lists of vertices; all */

struct par_array {
    const void *at;
    size_t bytes;
};

/* In the order of the struct. */
void par_tile_arrays(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS]);

/* Points the tile at them. */
void par_tile_point_at(struct tri_tile *tile, const struct par_array array[PAR_TILE_ARRAYS]);

/* Arrays that lie one behind the other are filled up to eight bytes each, so that all are aligned. */
static inline size_t par_padded(size_t n) { return (n + 7) / 8 * 8; }

/* --- a tile as bytes: its struct, then its arrays */

/* How many. */
size_t par_tile_bytes(const struct tri_tile *tile, int32_t n_attributes);

void par_tile_pack(char *to, const struct tri_tile *tile, int32_t n_attributes);

/* Points *tile at what is packed, of which there are n bytes at most, aligned as malloc does; returns how many it
 * takes, or 0: it is no tile. */
size_t par_tile_unpack(const char *bytes, size_t n, int32_t n_attributes, struct tri_tile *tile);

/* --- Copies of what a tile hands out, in the caller's coordinates and numbers. */

struct par_tile_copy {
    double (*points)[2], *attributes;
    int32_t *point_markers, *regions, *segment_markers;
    int64_t (*corners)[3], (*ends)[2];
    void *block; /* [size] bytes, all of these one behind the other */
    size_t size;
};

/* Room for as much as the tile has, which is pointed at it; what was there goes. The first time all is 0. To be freed
 * in any case. False: no memory. */
bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, struct tri_tile *tile);
void par_tile_copy_free(struct par_tile_copy *copy);

/* The `to`-th vertex of the tile is this one of the mesh. */
void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, tri_vertex_id v, int32_t to);

/* The number by which a vertex is handed out: the caller's own for the caller's points. Wherever numbers are compared,
 * it is `number`, which counts the caller's points as the mesh has them. */
static inline int64_t par_shown(const struct tri_mesh *mesh, int64_t number)
{
    return mesh->origin && number < mesh->n_input ? mesh->origin[number] : number;
}

/* --- What is handed out of one tile: its vertices, triangles and subsegments in the order of their numbers. */

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
