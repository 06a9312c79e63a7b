/* Points along a Hilbert curve: neighbours in the order are neighbours in the plane (Hilbert 1891; used for insertion
 * order by Amenta, Choi & Rote, "Incremental constructions con BRIO", 2003). */
#ifndef TRIANGLE_GEOMETRY_HILBERT_H
#define TRIANGLE_GEOMETRY_HILBERT_H

#include "triangle/base/executor.h"
#include "triangle/geometry/point.h"

/* Sorts the ids order[n] of points by position on the curve over the bounding box of those points; points of one cell
 * by their positions on a curve over their own box, or, if they are a few, by coordinates; equal points by id, so that
 * duplicates are neighbours. But for the ids of equal points the result depends on the points alone, not on the order
 * they come in. scratch[2 * n]. O(n), and as much again for what is dense in a box that much smaller. Cannot fail. */
void tri_hilbert_order(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch,
                       const struct tri_executor *executor);

/* The same along a curve through fewer cells, some for each point: in half the time. Not the same order. */
void tri_hilbert_order_coarse(const struct tri_point *xy, int32_t *order, int32_t n, uint64_t *scratch);

#endif
