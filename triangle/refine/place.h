/* The usual point of a bad triangle: circumcentre or off-centre. treat.c chooses between it and petal.h. */
#ifndef TRIANGLE_REFINE_PLACE_H
#define TRIANGLE_REFINE_PLACE_H

#include "triangle/geometry/shape.h"

/* The point that replaces a bad triangle, on the bisector of its shortest edge: the circumcentre or, where that lies
 * farther from the edge than `reach` (a height over the edge), the point at that height (off-centres: Üngör 2004). */
struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach);

#endif
