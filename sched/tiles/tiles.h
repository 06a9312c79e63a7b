/* Hands out the finished mesh to a sink, tile by tile, and frees the memory of tiles that were handed out.
 *
 * A tile is the box of a block with odd column and odd row. Tiles cover the plane, and are ordered column by column,
 * rows upwards. A vertex belongs to the tile that contains it. A triangle or a subsegment belongs to the last tile of
 * its corners.
 *
 * NUMBERS are assigned as in numbering.h: by tile, and in each tile along a Hilbert curve. All corners of a triangle
 * have their numbers when its tile is handed out. Numbers depend only on the mesh and the partition. They have 64 bits:
 * only the ids of the part of the mesh that is in memory must fit 32 bits. */
#ifndef SCHED_TILES_TILES_H
#define SCHED_TILES_TILES_H

#include "ptriangle/tiles.h"
#include "sched/schedule/partition.h"
#include "sched/schedule/room.h"
#include "sched/schedule/worklist.h"
#include "triangle/base/executor.h"

struct par_tile_ranks {      /* all 0: a single rank hands out the whole mesh */
    int32_t n;               /* number of ranks; 0: one */
    int32_t rank;            /* this rank; rank 0 hands out the vertices that keep their numbers */
    const int64_t *first[3]; /* [n + 1] number of the first vertex, triangle, segment of each rank; NULL: one rank */
};

struct par_tiles {
    /* Set by the caller. */
    struct tri_mesh *mesh;                 /* the finished mesh, which shrinks as columns are handed out */
    const struct par_partition *partition; /* NULL: the mesh has no tiles, and is handed out in pieces */
    const struct tri_executor *executor;   /* runs shares and tiles; NULL: they run one after the other */
    const struct tri_sink *sink;           /* receives the tiles */
    const struct tri_pslg *figure; /* the input, whose points are handed out unchanged; NULL: take them from the mesh */
    int32_t n_kept;               /* vertices that existed before refinement; they keep their numbers */
    int32_t kept_at_once;         /* number of kept vertices in one tile; 0: all */
    bool region_column;           /* hand out the region attribute of triangles; ignored if the mesh has columns */
    int32_t n_threads;            /* of the executor; 0: one */
    struct par_tile_ranks ranks;  /* the numbers that each rank hands out */
    /* Set by the functions below. */
    int64_t *number;              /* [capacity] number of each vertex; -1: none yet */
    int32_t *kept_tile;           /* [n_kept] tile of each kept vertex: column * n_rows + row; NULL: not located yet */
    int32_t capacity;             /* length of `number` */
    bool is_in_files;             /* `number` was allocated from the mesh's storage, which is in files */
    int64_t n_vertices;           /* vertices numbered or handed out so far */
    int64_t n_triangles, n_segments; /* triangles and segments handed out so far */
    struct par_ids held;          /* numbered vertices that are corners of triangles beyond the last column */
    struct par_tile_job *job;     /* [par_tiles_jobs] tiles that are being filled or handed out; NULL: none yet */
};

/* Returns the number of tiles that are processed at one time. It exceeds the number of threads by two, so that another
 * tile is ready while the sink takes one. */
static inline int32_t par_tiles_jobs(const struct par_tiles *t) { return t->n_threads > 1 ? t->n_threads + 2 : 1; }

/* --- columns (tiles.c) */

/* Numbers and hands out the tiles of an odd column. All columns before it have been handed out, and every triangle
 * whose corners lie in it or before it must be final. Removes what was handed out from the mesh and adds the ids to
 * *spare. Links to removed triangles from triangles beyond the column become invalid. Linear in the size of the mesh in
 * memory. TRI_NO_MEMORY, or the status of the sink. */
enum tri_status par_tiles_column(struct par_tiles *tiles, int32_t column, struct par_room *spare,
                                 struct tri_error *error);

/* Estimates the bytes that par_tiles_column needs besides the mesh: numbers and lists, 12 bytes per triangle in memory,
 * and copies of the tiles that are processed at one time. The factors were measured. */
static inline size_t par_tiles_bytes(const struct par_tiles *tiles)
{
    const struct par_partition *p = tiles->partition;
    const double jobs = par_tiles_jobs(tiles), tile = 4 * p->estimate / par_blocks(p);
    return 12 * (size_t)tiles->mesh->n_triangles + (size_t)(48 * jobs * tile);
}

/* Extends `number` to the capacity of the mesh; new vertices have no number yet. Locates the kept vertices at the first
 * call. False: no memory. */
bool par_tiles_reserve(struct par_tiles *tiles);

/* par_tiles_column in two steps. In each step, columns are processed from left to right.
 *
 * par_tiles_number numbers the vertices of a column, starting at tiles->n_vertices. Free ids have been marked before
 * (par_room_mark) and stay marked. *numbered uses little memory until it is handed out; free it in any case.
 *
 * par_tiles_hand_out hands the column out. Each corner of the column's triangles must have a number or belong to a
 * later tile. The first step does not keep the free vertices, so *spare lacks them afterwards: the mesh gets no more
 * points. */
struct par_column;
enum tri_status par_tiles_number(struct par_tiles *tiles, int32_t column, struct par_column **numbered,
                                 struct tri_error *error);
enum tri_status par_tiles_hand_out(struct par_column *numbered, struct par_room *spare, struct tri_error *error);
void par_column_free(struct par_column *column);

void par_tiles_free(struct par_tiles *tiles);

/* --- start and end of the stream, and meshes that are completely in memory (tile_stream.c) */

/* Starts the stream: calls the sink's `begin`, and hands out the vertices that existed before refinement, in the
 * caller's order. estimate: the approximate number of triangles. TRI_NO_MEMORY, or the status of the sink. */
enum tri_status par_tiles_begin(struct par_tiles *tiles, double estimate, struct tri_error *error);

/* Ends the stream: calls the sink's `end`, if it has one. */
enum tri_status par_tiles_end(struct par_tiles *tiles, struct tri_error *error);

/* Hands out a complete mesh without free ids that is in memory, including the calls of `begin` and `end`. Replaces all
 * calls above. If the mesh was numbered by a partition (numbering.h), its tiles are handed out. Otherwise it is handed
 * out in pieces, all vertices first. */
enum tri_status par_tiles_whole(struct par_tiles *tiles, struct tri_error *error);

/* Estimates the bytes that par_tiles_whole needs besides the mesh: the copy of a tile, and the memory in which a sink
 * converts it. */
static inline size_t par_tiles_whole_bytes(const struct par_tiles *tiles)
{
    const size_t n = (size_t)tiles->mesh->n_triangles, most = (size_t)1 << 16;
    return 200 * (n < most ? n : most);
}

#endif
