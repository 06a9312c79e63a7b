/* Points along a Hilbert curve: neighbours in the order are neighbours in the plane (Hilbert 1891; used for insertion
 * order by Amenta, Choi & Rote, "Incremental constructions con BRIO", 2003). */
#ifndef TRIANGLE_HILBERT_H
#define TRIANGLE_HILBERT_H

#include "triangle/executor.h"
#include "triangle/mesh.h"

/* Position of cell (x, y), 0 <= x, y < 2^31, on the curve through the 2^31 x 2^31 cells. */
uint64_t tri_hilbert(uint32_t x, uint32_t y);

/* order[n] receives 0 .. n - 1 sorted by position on the curve over the bounding box; equal points come one after
 * another in increasing index, so that duplicates are neighbours. O(n), and O(k log k) for k points in one cell. */
enum tri_status tri_hilbert_order(const struct tri_point *xy, int32_t n, int32_t *order,
                                  const struct tri_executor *executor, struct tri_error *error);

#endif
