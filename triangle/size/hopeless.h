/* Bad angles that are not refined, and the rule that no edge becomes too short to improve an angle. */
#ifndef TRIANGLE_SIZE_HOPELESS_H
#define TRIANGLE_SIZE_HOPELESS_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"

/* Is the triangle's bad angle one that no point can fix, or that a point would only move elsewhere? See the rules in
 * the .c file. */
bool tri_is_hopeless(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle join two segments that meet? */
bool tri_crosses_angle(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

#endif
