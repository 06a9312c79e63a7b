/* A mesh as a stream of finished tiles. It can be passed to a file or a solver without ever being in memory as a whole.
 *
 * The first tile has no triangles. It contains the vertices from before refinement: the caller's points in the caller's
 * order, then crossings of segments. The tiles of the plane follow column by column, each column from bottom to top.
 * Numbers count from 0 and have 64 bits. Numbers and order depend only on the figure and the settings, and are the same
 * as for the mesh in memory. The vertices, triangles and segments of a tile are numbered after those of earlier tiles.
 * Corners of a triangle are vertices of its own tile or of earlier tiles. */
#ifndef PTRIANGLE_TILES_H
#define PTRIANGLE_TILES_H

#include <stdint.h>

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

struct tri_stream {         /* data for all tiles */
    int32_t n_attributes;   /* number of attributes of a vertex */
    int32_t n_columns;      /* number of attributes of a triangle; 0: none */
    int32_t n_regions;      /* number of rows of regions */
    const double *regions;  /* [n_regions][n_columns] attributes of the triangles in each region */
    double estimate;        /* rough number of triangles, for progress reports and chunk sizes */
    /* On several ranks (ptriangle/mpi.h) rank p owns and hands out the vertices first_vertex[p] to first_vertex[p + 1]
     * - 1. The same holds for triangles and segments. In a single process: 1, 0 and NULL. */
    int32_t n_ranks, rank;
    const int64_t *first_vertex, *first_triangle, *first_segment; /* [n_ranks + 1] */
};

struct tri_tile {
    int32_t column, row;              /* position of the tile; -1, -1: the vertices from before refinement */
    int64_t first_vertex, first_triangle, first_segment; /* numbers of the first ones in this tile */
    int32_t n_vertices, n_triangles, n_segments;         /* of this tile */
    const double (*points)[2];        /* [n_vertices] in the caller's coordinates */
    const int32_t *point_markers;     /* [n_vertices] */
    const double *attributes;         /* [n_vertices][n_attributes] */
    const int64_t (*corners)[3];      /* [n_triangles] counter-clockwise */
    const int32_t *regions;           /* [n_triangles] row in tri_stream.regions, below n_regions */
    const int64_t (*ends)[2];         /* [n_segments] subsegments, each in the direction of its segment */
    const int32_t *segment_markers;   /* [n_segments] */
};

/* Receives tiles, in order and on one thread. begin may be called again before end. Then all tiles so far are invalid,
 * and the stream starts again. A sink without begin never has to discard tiles, but the run may take longer. Data
 * behind the pointers are valid only during a call. If a function returns a status other than TRI_OK, the run ends with
 * that status. */
struct tri_sink {
    void *user; /* passed to each function */
    enum tri_status (*begin)(void *user, const struct tri_stream *stream, struct tri_error *error); /* may be NULL */
    enum tri_status (*take)(void *user, const struct tri_tile *tile, struct tri_error *error);
    enum tri_status (*end)(void *user, struct tri_error *error); /* after the last tile; may be NULL */
};

#ifdef __cplusplus
}
#endif

#endif
