/* Bad angles that stay, and the rule that no edge becomes too short for the sake of an angle. */
#ifndef TRIANGLE_SIZE_HOPELESS_H
#define TRIANGLE_SIZE_HOPELESS_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/mesh.h"

/* A bad angle that no point can mend, or that a point would only move elsewhere: see the rules in the .c file. */
bool tri_is_hopeless(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle join two segments that touch? */
bool tri_crosses_angle(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

#endif
