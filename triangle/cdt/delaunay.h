/* Delaunay triangulation of a point set. */
#ifndef TRIANGLE_CDT_DELAUNAY_H
#define TRIANGLE_CDT_DELAUNAY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Triangulates the convex hull of the mesh's vertices (which has no triangles yet), which tri_sort_points has sorted.
 * Cocircular ties are broken by coordinates, and triangles and hull edges are numbered by what they are: the result
 * depends on the set of points alone. Duplicates stay out: mesh->twin then maps every point to the first one at its
 * place. Every hull edge becomes a subsegment without input segment. Collinear points give no triangle, TRI_OK.
 * Expected O(n log n) for any set of points. */
enum tri_status tri_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

/* The same mesh by leaves of at least so many vertices; for tests. */
enum tri_status tri_delaunay_in_leaves(struct tri_mesh *mesh, int32_t leaf_size, const struct tri_executor *executor,
                                       struct tri_error *error);

#endif
