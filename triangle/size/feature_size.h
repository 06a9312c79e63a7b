/* What refinement computes from the input before it inserts its first point: the feature size around each vertex. It
 * limits how short edges may become to improve angles. */
#ifndef TRIANGLE_SIZE_FEATURE_SIZE_H
#define TRIANGLE_SIZE_FEATURE_SIZE_H

#include "triangle/mesh/cavity.h"
#include "triangle/mesh/mesh.h"

/* Returns the feature size at a point p inserted for a triangle with shortest edge ab. sized: the point is inserted
 * because the triangle is too large, not because of its angles. */
double tri_feature_inside(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p,
                          bool sized);

/* The same for a point on subsegment s. Its cavity must have been found by tri_cavity_search_split. */
double tri_feature_on_segment(const struct tri_mesh *mesh, const struct tri_cavity *cavity, tri_sub_id s, bool sized);

/* Is the edge ab, with squared length l2, too short compared with the features around it, so that it is not improved
 * further? (Points for angles would run away.) */
bool tri_has_run_away(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, double l2);

/* Prepares the mesh for refinement: keeps the surface of the attributes, lists the parents at each vertex, estimates
 * feature sizes, sets the limits, and marks the input vertices at which two subsegments meet at less than 60 degrees
 * inside the mesh (TRI_VERTEX_ACUTE). Call it after carving and before the first insertion. A prepared mesh is not
 * changed. O(triangles). */
enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

#endif
