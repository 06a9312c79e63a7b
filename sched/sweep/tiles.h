/* The finished mesh, tile by tile: how it leaves memory.
 *
 * A tile is the box of a block with odd column and odd row; tiles cover the plane, and are ordered column by column,
 * rows upwards. A vertex belongs to the tile that holds it, a triangle and a subsegment to the last tile of their
 * corners.
 *
 * NUMBERS. Vertices that there were before refinement keep theirs. The others are numbered tile by tile, along a
 * Hilbert curve over the tile's own vertices; so every corner of a triangle has its number when the triangle's tile has
 * its turn. A triangle starts at its corner with the largest number; the triangles of a tile are sorted by that corner,
 * then by the next one. So numbers depend on the mesh and the partition alone, and are 64 bits wide: only what is in
 * memory at one time must fit 32. */
#ifndef SCHED_SWEEP_TILES_H
#define SCHED_SWEEP_TILES_H

#include "sched/partition.h"
#include "sched/worklist.h"
#include "sched/room.h"
#include "triangle/executor.h"

struct par_tile {
    int32_t column, row;
    int64_t first_vertex, first_triangle; /* numbers of the first ones */
    int32_t n_vertices, n_triangles;
    const double (*xy)[2];        /* [n_vertices] in the caller's coordinates */
    const int32_t *markers;       /* [n_vertices] */
    const int64_t (*corners)[3];  /* [n_triangles] counter-clockwise */
    const int32_t *regions;       /* [n_triangles] index into the mesh's regions */
};

/* Takes a finished tile, which is gone when the call returns. Called in the order of the tiles, by one thread. */
typedef enum tri_status par_take_tile(void *user, const struct par_tile *tile, struct tri_error *error);

struct par_tiles {
    struct tri_mesh *mesh;
    const struct par_partition *partition;
    const struct tri_executor *executor;
    int32_t n_kept;               /* vertices that keep their numbers */
    par_take_tile *take;
    void *user;
    int64_t *number;              /* [capacity] of each vertex; -1: none yet */
    int32_t *tile;                /* [capacity] column * n_rows + row of each vertex; INT32_MAX: right of what has been
                                     handed out, or not there */
    int32_t capacity;
    int64_t n_vertices, n_triangles; /* numbered so far, those that keep theirs counted in */
    struct par_worklist held;         /* numbered vertices that triangles beyond the last column still have */
};

/* Numbers, and hands out, the tiles of an odd column. Every triangle whose corners lie in it and before it must be
 * final, and columns before it have had their turn. let_go: what has been handed out is gone from the mesh, its ids are
 * added to *spare, and links of triangles beyond the column to it lead nowhere. O(what is in memory). TRI_NO_MEMORY, or
 * what `take` says. */
enum tri_status par_tiles_column(struct par_tiles *tiles, int32_t column, bool let_go, struct par_room *spare,
                                 struct tri_error *error);

void par_tiles_free(struct par_tiles *tiles);

#endif
