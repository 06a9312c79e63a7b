/* The standard point of a bad triangle (circumcentre or off-centre), and the fallback for a triangle that is too
 * large and cannot use its standard point. treat.c chooses between these points and those of petal.h. */
#ifndef TRIANGLE_REFINE_PLACE_H
#define TRIANGLE_REFINE_PLACE_H

#include "triangle/geometry/shape.h"
#include "triangle/size/quality.h"

/* Returns the standard point for a bad triangle, on the bisector of its shortest edge: the circumcentre or, if that
 * lies higher than `reach` over the edge, the point at height `reach` (off-centres: Üngör 2004). */
struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach);

/* Returns the longest subsegment of the triangle that may be split and is at least half as long as the longest edge,
 * or TRI_NONE. */
tri_sub_id tri_long_wall(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         tri_triangle_id triangle, const struct tri_shape *shape);

/* Is further refinement of this triangle useless, because an edge at a wall that must not be split stays too long?
 * See RULE in place.c. */
bool tri_is_walled_in(const struct tri_asked *asked, tri_triangle_id triangle, const struct tri_shape *shape);

/* Sets *p to the triangle's centroid. Returns false if a disk around it inside the triangle would have a radius
 * below the shortest edge that coordinates resolve. */
bool tri_centroid(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape,
                  struct tri_point *p);

#endif
