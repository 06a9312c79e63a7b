/* Where the point that splits a subsegment goes. */
#ifndef TRIANGLE_REFINE_SPLIT_H
#define TRIANGLE_REFINE_SPLIT_H

#include "triangle/cdt/crossing.h"

/* Where to split a subsegment, as a fraction from its start: in the middle or, beside an acute input vertex, at the
 * power of two nearest to the middle from there. So subsegments that meet at a small angle are split on common circles
 * (concentric shells: Ruppert 1995), and do not encroach each other for ever. */
double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s);

/* Is the subsegment from a to b long enough to be split? */
bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b);

enum { TRI_SPLIT_PLACES = 4 * TRI_PLACES };

/* The point that a subsegment is to be split at, rounded once: on its parent's line, and on the subsegment. */
struct tri_split_base {
    struct tri_point on_line, on_sub;
};

/* At this fraction of the subsegment; at the foot of the perpendicular from `at`. */
struct tri_split_base tri_split_base(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction);
struct tri_split_base tri_split_base_level(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                                           struct tri_point at);

/* *p: one of TRI_SPLIT_PLACES beside the base, up to about one resolution from it (crossing.h); choice: which one, the
 * best are the first. False where the place does not keep the boundary to itself, or is too far from the line: see
 * split.c. */
bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_split_base *base,
                     int choice, struct tri_point *p);

/* Does a split of s at p keep within four resolutions of its parent's line, and the boundary to itself? */
bool tri_may_split_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p);

#endif
