/* Sorting points along a Hilbert curve: neighbours in the order are neighbours in the plane (Hilbert 1891; used as
 * insertion order by Amenta, Choi & Rote, "Incremental constructions con BRIO", 2003). */
#ifndef TRIANGLE_GEOMETRY_HILBERT_H
#define TRIANGLE_GEOMETRY_HILBERT_H

#include "triangle/base/executor.h"
#include "triangle/geometry/point.h"

/* Sorts the ids order[n] of points by position on the curve over the bounding box of these points. Points of one cell
 * are sorted along a curve over their own box or, if they are few, by coordinates; equal points by id, so that
 * duplicates are neighbours. Except for the ids of equal points, the result does not depend on the input order.
 * scratch[2 * n]. O(n), and as much again for dense points in a much smaller box. Cannot fail. */
void tri_hilbert_order(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch,
                       const struct tri_executor *executor);

/* The same with a curve through fewer cells, a few per point. Takes half the time, and gives a different order. */
void tri_hilbert_order_coarse(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch);

#endif
