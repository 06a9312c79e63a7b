/* Where the point that splits a subsegment goes. */
#ifndef TRIANGLE_REFINE_SPLIT_H
#define TRIANGLE_REFINE_SPLIT_H

#include "triangle/cdt/crossing.h"

enum { TRI_SPLIT_PLACES = 4 * TRI_PLACES };

/* *p: a place at this fraction of the subsegment, on its parent's line or its own up to about one resolution
 * (crossing.h); choice: which one, the best are the first. False where the place does not keep the boundary to
 * itself, or is too far from the line: see split.c. */
bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction, int choice,
                     struct tri_point *p);

/* *p: likewise a place at the foot of the perpendicular from `at`, up to rounding. */
bool tri_place_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point at, int choice,
                     struct tri_point *p);

/* Does a split of s at p keep within four resolutions of its parent's line, and the boundary to itself? */
bool tri_may_split_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p);

#endif
