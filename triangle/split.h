/* Where the point that splits a subsegment goes. */
#ifndef TRIANGLE_SPLIT_H
#define TRIANGLE_SPLIT_H

#include "triangle/mesh.h"

/* *p: the place at this fraction of the subsegment, on its parent's line up to one resolution (crossing.h). False where
 * there is no such place that keeps the boundary to itself, see split.c. */
bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction,
                     struct tri_point *p);

#endif
