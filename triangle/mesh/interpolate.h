/* Attributes of new vertices: linear interpolation. */
#ifndef TRIANGLE_MESH_INTERPOLATE_H
#define TRIANGLE_MESH_INTERPOLATE_H

#include "triangle/mesh/mesh.h"

/* Attributes of vertex `to_vertex`, at the given fraction of the way from vertex a to vertex b; within the range of
 * theirs. */
void tri_interpolate_edge(struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, double fraction,
                          tri_vertex_id to_vertex);

/* Attributes of vertex v from the plane through the corners of a triangle, within the range of those of the corners; v
 * lies in the triangle, or outside it by rounding. Of a triangle without area: anything within the range. */
void tri_interpolate_triangle(struct tri_mesh *mesh, const tri_vertex_id corners[3], tri_vertex_id v);

#endif
