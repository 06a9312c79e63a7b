/* What refinement has to know of the input before it inserts its first point, and how small edges may become for the
 * sake of angles: the size of the features around each vertex. */
#ifndef TRIANGLE_SIZE_FEATURE_SIZE_H
#define TRIANGLE_SIZE_FEATURE_SIZE_H

#include "triangle/mesh/cavity.h"
#include "triangle/mesh/mesh.h"

/* The feature size at a point p that is inserted for a triangle with shortest edge ab; sized: because it is too large,
 * not because of its angles. */
double tri_feature_inside(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p,
                          bool sized);

/* The same for a point on subsegment s whose cavity has been found by tri_cavity_search_split. */
double tri_feature_on_segment(const struct tri_mesh *mesh, const struct tri_cavity *cavity, tri_sub_id s, bool sized);

/* Is the edge between vertices a and b, of squared length l2, too short for what is around it, regardless of
 * angles? */
bool tri_has_run_away(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, double l2);

/* Makes the mesh ready for refinement: keeps the surface of the attributes, lists the parents at each vertex, estimates
 * feature sizes, sets the limits, and marks the input vertices at which two subsegments meet at less than 60 degrees
 * inside the mesh (TRI_VERTEX_ACUTE). Call it after carving, before the first point; a mesh that is ready stays as it
 * is. O(triangles). */
enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

#endif
