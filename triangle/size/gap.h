/* Narrow spaces between two segments: what it costs to fill them, and which are too dear. */
#ifndef TRIANGLE_SIZE_GAP_H
#define TRIANGLE_SIZE_GAP_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"

/* How many points, to the order, would fill the space between two parents? The first runs through u, the second through
 * v, and they are nearest to each other there: as far apart as v is from the line of the first. The cost is the
 * integral of 1 / width along the space: Ruppert's integral of 1 / size^2 (1995), where each place is as wide as its
 * features. */
double tri_filling_cost(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                        struct tri_point v);

/* Will the space between two parents be filled, so that its width is a feature? u and v as above. */
bool tri_is_filled(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                   struct tri_point v);

/* The same for the dearest space that is not filled between this parent, u being its vertex beside v, and one that v
 * lies on; 0: all are filled, or there is none. */
double tri_gap_across(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id u, tri_vertex_id v);

/* About so many points it would take to fill the space between two parents that the shortest edge of the triangle
 * bridges; 0 where it bridges none. */
double tri_gap_cost(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle bridge a spike? */
bool tri_bridges_spike(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Is the distance of two vertices the width of a space between two parents that is too expensive to fill, or of its
 * end? Is the distance of a vertex from a parent: does one of the vertex's own parents bound such a space with it? */
bool tri_spans_gap(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v);
bool tri_lines_gap(const struct tri_mesh *mesh, tri_parent_id p, tri_vertex_id v);

/* Does the shortest edge of the triangle bridge a spike, or such a space? */
bool tri_is_narrow_gap(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Chooses which narrow spaces are filled, by their cost (mesh->limits): the parents at each vertex are listed.
 * O(triangles). */
void tri_choose_gaps(struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
