/* The usual point of a bad triangle, circumcentre or off-centre, and the point that a triangle which is too large gets
 * where it cannot have that one. treat.c chooses between these and petal.h. */
#ifndef TRIANGLE_REFINE_PLACE_H
#define TRIANGLE_REFINE_PLACE_H

#include "triangle/geometry/shape.h"
#include "triangle/size/quality.h"

/* The point that replaces a bad triangle, on the bisector of its shortest edge: the circumcentre or, where that lies
 * farther from the edge than `reach` (a height over the edge), the point at that height (off-centres: Üngör 2004). */
struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach);

/* The longest subsegment of the triangle, if it is at least half as long as the longest edge and may be split; else
 * TRI_NONE. */
tri_sub_id tri_long_wall(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         tri_triangle_id triangle, const struct tri_shape *shape);

/* Is the triangle one that only the caller's functions refuse, and always would, for the length of an edge beside a
 * wall that must not be split? Then nothing is to be had here. See the rule. */
bool tri_is_walled_in(const struct tri_asked *asked, tri_triangle_id triangle, const struct tri_shape *shape);

/* The triangle's centroid. False where a disk about it, in the triangle, would have a radius below the shortest edge
 * that coordinates resolve. */
bool tri_centroid(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape,
                  struct tri_point *p);

#endif
