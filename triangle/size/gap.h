/* Narrow gaps between two segments: how many points would fill them, and which are too expensive to fill. */
#ifndef TRIANGLE_SIZE_GAP_H
#define TRIANGLE_SIZE_GAP_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"

/* Returns the approximate number of points that would fill the gap between two parents. The first passes through u,
 * the second through v, and these are their closest points: their distance is that of v from the line of the first
 * parent. The cost is the integral of 1 / width along the gap, which is Ruppert's integral of 1 / size^2 (1995) if
 * feature sizes equal the width. */
double tri_filling_cost(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                        struct tri_point v);

/* Will the gap between two parents be filled, so that its width counts as a feature? u and v as above. */
bool tri_is_filled(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                   struct tri_point v);

/* Returns the cost of the most expensive unfilled gap between this parent, whose vertex u is next to v, and a parent
 * that v lies on. Returns 0 if there is no unfilled gap. */
double tri_gap_across(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id u, tri_vertex_id v);

/* If the shortest edge of the triangle bridges a gap, returns about how many points fill this gap; otherwise 0. */
double tri_gap_cost(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle bridge a spike? */
bool tri_bridges_spike(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* tri_spans_gap: is the distance of two vertices the width of an unfilled gap between two parents, or of its end?
 * tri_lines_gap: does one of the vertex's own parents bound an unfilled gap with this parent? */
bool tri_spans_gap(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v);
bool tri_lines_gap(const struct tri_mesh *mesh, tri_parent_id p, tri_vertex_id v);

/* Does the shortest edge of the triangle bridge a spike or an unfilled gap? */
bool tri_is_narrow_gap(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Decides by cost which narrow gaps are filled, and sets the limits in mesh->limits. The parents at each vertex must
 * have been listed. O(triangles). */
void tri_choose_gaps(struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
