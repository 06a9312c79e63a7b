/* A grid made of plain arrays, for tests of the writers. */
#ifndef TESTS_ARRAY_GRID_H
#define TESTS_ARRAY_GRID_H

#include "triangle/mesh/grid.h"

struct array_grid {
    const double *points, *attributes; /* [n_points][2], [n_points][n_attributes] */
    const int32_t *markers;            /* of points and of edges; NULL: 0 */
    const int32_t *nodes;              /* [n_triangles][n_nodes] */
    const double *columns;
    const int32_t *neighbors;          /* [n_triangles][3] */
    const int32_t *segments, *segment_markers;
    const int32_t *ends;               /* of edges */
    const double *directions;
    struct tri_grid grid;              /* the caller sets the counts */
};

/* Returns the grid with its functions, valid as long as *arrays. */
const struct tri_grid *array_grid(struct array_grid *arrays);

/* A grid of points only, without attributes and markers. */
struct array_grid array_grid_of_points(int32_t base, int64_t n, const double *points);

#endif
