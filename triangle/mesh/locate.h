/* Point location: finds the face of the segments that holds a point. */
#ifndef TRIANGLE_MESH_LOCATE_H
#define TRIANGLE_MESH_LOCATE_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"

/* Returns the triangle that holds q, by a walk from triangle t; TRI_NONE if q is outside the hull, which is convex. */
tri_triangle_id tri_walk_to(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* Returns a subsegment that is an edge of triangle t and passes through q; TRI_NONE if there is none. */
tri_sub_id tri_sub_under(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* For each of n points, in the mesh's coordinates and anywhere in the plane, finds a triangle in the face of the point:
 * one that can be reached from the point without crossing a subsegment. TRI_NONE: the point is outside. For a point on
 * a subsegment, any face next to it may be returned. The mesh must fill its convex hull. Worst case O((triangles + n)
 * log(triangles + n)) for triangles of any shape; near O(n log n) in a good triangulation. */
enum tri_status tri_locate_faces(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n,
                                 tri_triangle_id *faces, struct tri_error *error);

#endif
