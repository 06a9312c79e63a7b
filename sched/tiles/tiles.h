/* The finished mesh, tile by tile: how it leaves memory.
 *
 * A tile is the box of a block with odd column and odd row; tiles cover the plane, and are ordered column by column,
 * rows upwards. A vertex belongs to the tile that holds it, a triangle and a subsegment to the last tile of their
 * corners.
 *
 * NUMBERS. Vertices that there were before refinement keep theirs. The others are numbered tile by tile, along a
 * Hilbert curve over the tile's own vertices; so every corner of a triangle has its number when the triangle's tile has
 * its turn. A triangle starts at its corner with the largest number; the triangles of a tile are sorted by that corner,
 * then by the next one; its subsegments by the parent, then by the end at which they start. So numbers depend on the
 * mesh and the partition alone, and are 64 bits wide: only what is in memory at one time must fit 32. A mesh that is in
 * memory as a whole has the same ones (sched/tiles/numbering.h). */
#ifndef SCHED_TILES_TILES_H
#define SCHED_TILES_TILES_H

#include "ptriangle/tiles.h"
#include "sched/schedule/partition.h"
#include "sched/schedule/room.h"
#include "sched/schedule/worklist.h"
#include "triangle/base/executor.h"

struct par_tile_ranks {           /* all 0: one rank hands out everything */
    int32_t n, rank;              /* how many, and which is this; rank 0 hands out vertices that keep their numbers */
    const int64_t *first[3];      /* [n + 1] first vertex, triangle, segment of each rank; NULL: there is one rank */
};

struct par_tiles {
    /* Asked for. */
    struct tri_mesh *mesh;                 /* the finished mesh, which shrinks as columns are handed out */
    const struct par_partition *partition; /* NULL: the mesh has no tiles, and is handed out in pieces */
    const struct tri_executor *executor;   /* runs shares and tiles; NULL: they run one after the other */
    const struct tri_sink *sink;           /* receives the tiles */
    const struct tri_pslg *figure; /* the input: its points are handed out bit by bit; NULL: the mesh's points are */
    int32_t n_kept;               /* vertices that there were before refinement */
    int32_t kept_at_once;         /* so many of these are a tile; 0: all are one */
    bool region_column;           /* the attribute of a triangle's region is handed out, unless the mesh has columns */
    int32_t n_threads;            /* of the executor; 0: one */
    struct par_tile_ranks ranks;  /* who hands out which numbers */
    /* Found: what each vertex has here, and how far the stream has come. */
    int64_t *number;              /* [capacity] of each vertex; -1: none yet */
    int32_t *kept_tile;           /* [n_kept] column * n_rows + row of the vertices that keep their numbers */
    int32_t capacity;             /* vertices that `number` has room for */
    bool is_in_files;             /* the array `number` lies in files, in the mesh's storage */
    int64_t n_vertices, n_triangles, n_segments; /* handed out so far */
    struct par_ids held;          /* numbered vertices that triangles beyond the last column still have */
    struct par_tile_job *job;     /* [par_tiles_jobs] room for tiles on their way; NULL: none yet */
};

/* Tiles on their way at one time. Two more than threads: while one tile is taken another is ready. */
static inline int32_t par_tiles_jobs(const struct par_tiles *t) { return t->n_threads > 1 ? t->n_threads + 2 : 1; }

/* --- columns (tiles.c) */

/* Numbers, and hands out, the tiles of an odd column. Every triangle whose corners lie in it and before it must be
 * final, and columns before it have had their turn. What has been handed out is gone from the mesh, its ids are added
 * to *spare, and links of triangles beyond the column to it lead nowhere. O(what is in memory). TRI_NO_MEMORY, or what
 * the sink says. */
enum tri_status par_tiles_column(struct par_tiles *tiles, int32_t column, struct par_room *spare,
                                 struct tri_error *error);

/* What par_tiles_column takes beside the mesh, to the order: numbers and lists, a dozen bytes a triangle that is there,
 * and copies of the tiles that are on their way. (Measured.) */
static inline size_t par_tiles_bytes(const struct par_tiles *tiles)
{
    const struct par_partition *p = tiles->partition;
    const double jobs = par_tiles_jobs(tiles), tile = 4 * p->estimate / par_blocks(p);
    return 12 * (size_t)tiles->mesh->n_triangles + (size_t)(48 * jobs * tile);
}

/* Room for what each vertex has here; nothing is known yet of those that come later. False: no memory. */
bool par_tiles_reserve(struct par_tiles *tiles);

/* par_tiles_column in two steps, in each of which columns come from left to right. par_tiles_number numbers the
 * vertices of a column, from tiles->n_vertices on. Free ids have been marked (par_room_mark) and stay marked; *numbered
 * is to be freed in any case, and is small until it is handed out. When par_tiles_hand_out is called, all corners of
 * the column's triangles have their numbers, or are vertices of later tiles. */
struct par_column;
enum tri_status par_tiles_number(struct par_tiles *tiles, int32_t column, struct par_column **numbered,
                                 struct tri_error *error);
enum tri_status par_tiles_hand_out(struct par_column *numbered, struct par_room *spare, struct tri_error *error);
void par_column_free(struct par_column *column);

void par_tiles_free(struct par_tiles *tiles);

/* --- before and after them, and a mesh in memory as a whole (tile_stream.c) */

/* Tells the sink what is to come, about so many triangles, and hands out the vertices that there were before: the
 * caller's points by the caller's numbers. TRI_NO_MEMORY, or what the sink says. */
enum tri_status par_tiles_begin(struct par_tiles *tiles, double estimate, struct tri_error *error);

/* Tells the sink that all columns have had their turn. */
enum tri_status par_tiles_end(struct par_tiles *tiles, struct tri_error *error);

/* Hands out, from begin to end, a mesh in memory that has no free numbers: as it is, its tiles those of the partition
 * that it was numbered by, if it was (sched/tiles/numbering.h); else in pieces, all vertices first. Instead of all
 * calls above. */
enum tri_status par_tiles_whole(struct par_tiles *tiles, struct tri_error *error);

/* What par_tiles_whole takes beside the mesh, to the order: the copy of a tile, and what a sink makes of it. */
static inline size_t par_tiles_whole_bytes(const struct par_tiles *tiles)
{
    const size_t n = (size_t)tiles->mesh->n_triangles, most = (size_t)1 << 16;
    return 200 * (n < most ? n : most);
}

#endif
