/* Copies of what a tile hands out, in the caller's coordinates and numbers. */
#ifndef SCHED_TILES_TILE_COPY_H
#define SCHED_TILES_TILE_COPY_H

#include "ptriangle/tiles.h"
#include "triangle/mesh/mesh.h"

struct par_tile_copy {
    double (*points)[2], *attributes;
    int32_t *point_markers, *regions, *segment_markers;
    int64_t (*corners)[3], (*ends)[2];
    void *block; /* [size] bytes, all of these one behind the other */
    size_t size;
};

/* Room for so many; what was there goes. The first time all is 0. To be freed in any case. False: no memory. */
bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t n_vertices,
                           int32_t n_triangles, int32_t n_segments);
void par_tile_copy_free(struct par_tile_copy *copy);

/* The `to`-th vertex of the tile is this one of the mesh. */
void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, tri_vertex_id v, int32_t to);

/* The number by which a vertex is handed out: the caller's own for the caller's points. Wherever numbers are compared,
 * it is `number`, which counts the caller's points as the mesh has them. */
static inline int64_t par_shown(const struct tri_mesh *mesh, int64_t number)
{
    return mesh->origin && number < mesh->n_input ? mesh->origin[number] : number;
}

/* Points a tile at the copies. */
void par_tile_copy_show(const struct par_tile_copy *copy, struct tri_tile *tile);

#endif
