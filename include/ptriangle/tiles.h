/* A mesh as a stream of finished tiles: how one of any size is handed out, to a file or to a solver, without ever being
 * in memory as a whole.
 *
 * First come the vertices that there were before refinement, as one tile without triangles: the caller's points in the
 * caller's order, then crossings of segments; then the plane's tiles, column by column, rows upwards. Numbers count
 * from 0 and are 64 bits wide. They and their order depend on the figure and the settings alone, and are those of the
 * same mesh in memory: vertices, triangles and segments of a tile follow on those of the tiles before it. A corner may
 * have any number below that of the next tile's first vertex. */
#ifndef PTRIANGLE_TILES_H
#define PTRIANGLE_TILES_H

#include <stdint.h>

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

struct tri_stream {         /* what holds for all tiles */
    int32_t n_attributes;   /* of a vertex */
    int32_t n_columns;      /* attributes of a triangle; 0: none */
    int32_t n_regions;
    const double *regions;  /* [n_regions][n_columns] attributes of the triangles in each region */
    double estimate;        /* of the number of triangles, to the order: for progress and chunks */
    /* On several ranks (ptriangle/mpi.h), else 1, 0 and NULL: rank p hands out, and owns, vertices first_vertex[p] to
     * first_vertex[p + 1] - 1, and likewise with triangles and segments. */
    int32_t n_ranks, rank;
    const int64_t *first_vertex, *first_triangle, *first_segment; /* [n_ranks + 1] */
};

struct tri_tile {
    int32_t column, row;              /* -1, -1: vertices that there were before refinement */
    int64_t first_vertex, first_triangle, first_segment;
    int32_t n_vertices, n_triangles, n_segments;
    const double (*points)[2];        /* [n_vertices] in the caller's coordinates */
    const int32_t *point_markers;     /* [n_vertices] */
    const double *attributes;         /* [n_vertices][n_attributes] */
    const int64_t (*corners)[3];      /* [n_triangles] counter-clockwise */
    const int32_t *regions;           /* [n_triangles] below n_regions */
    const int64_t (*ends)[2];         /* [n_segments] subsegments, each the way of its segment */
    const int32_t *segment_markers;   /* [n_segments] */
};

/* Who takes tiles: called by one thread, in order. begin may be called again, before end: what has been taken is void
 * then, and all tiles come anew; whoever has no begin never has to forget anything, but it may take longer. What the
 * pointers name is gone when a call returns. A status other than TRI_OK ends the run with it. */
struct tri_sink {
    void *user;
    enum tri_status (*begin)(void *user, const struct tri_stream *stream, struct tri_error *error); /* NULL: not told */
    enum tri_status (*take)(void *user, const struct tri_tile *tile, struct tri_error *error);
    enum tri_status (*end)(void *user, struct tri_error *error); /* all tiles have been taken; NULL: not told */
};

#ifdef __cplusplus
}
#endif

#endif
