/* The triangles of a point set in an order of their own. */
#ifndef TRIANGLE_CDT_CURVE_SORT_H
#define TRIANGLE_CDT_CURVE_SORT_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* The mesh, which has neither triangles nor subsegments, receives those of tri[n_triangles]: a triangulation of its
 * vertices, n_live triangles with ghosts (triangle/cdt/insertion.h) and free triangles. Ghosts become subsegments,
 * counter-clockwise around the hull from its lowest vertex. A triangle begins at the lower end of its shortest edge,
 * and triangles are sorted by that vertex, then by the next: there is the work of refinement, however far the rest of a
 * triangle reaches, and every later stage runs faster where neighbours are near in memory. tri[] is in ruins
 * afterwards. O(n). */
enum tri_status tri_curve_sort(struct tri_mesh *mesh, struct tri_triangle *tri, int32_t n_triangles,
                               int32_t n_live, const struct tri_executor *executor, struct tri_error *error);

#endif
