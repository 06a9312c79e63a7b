/* In which face of the segments does a point lie? */
#ifndef TRIANGLE_MESH_LOCATE_H
#define TRIANGLE_MESH_LOCATE_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"

/* The triangle that holds q (TRI_NONE outside the hull, which is convex), by a walk from triangle t. */
tri_triangle_id tri_walk_to(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* A subsegment that is an edge of triangle t and has q on it; TRI_NONE if there is none. */
tri_sub_id tri_sub_under(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* For each of n points, in the mesh's coordinates and anywhere in the plane, a triangle of the face that holds it: one
 * that is reached from it without crossing a subsegment; TRI_NONE outside. Of a point on a subsegment any face at it
 * may be told. The mesh fills its convex hull. O((triangles + n) log(triangles + n)) at worst, whatever the shapes;
 * near O(n log n) in a good triangulation. */
enum tri_status tri_locate_faces(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n,
                                 tri_triangle_id *faces, struct tri_error *error);

#endif
