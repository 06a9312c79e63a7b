/* A worklist in an order in which ids do not show: tile by tile, and within each along a Hilbert curve through the
 * triangles' centres. A triangle is of the tile that holds its home: the corner behind the obtuse one, else the first.
 *
 * THEOREM. The order of the triangles, and their keys, depend on the mesh but for its ids: home and centre are those of
 * the corners as the triangle is turned; of triangles with equal centres, that of the lower corners comes first, and
 * two different ones do not have the same first two corners. So a rank that has all triangles with a corner in some
 * tiles (sched/ranks/ranks.h) gives those of these tiles the keys that they have in one process. And it has found them:
 * what is bad about a triangle is in its corners, or in a subsegment that it encroaches; that lies opposite its obtuse
 * corner, so that it ends at the home, and is known here. */
#ifndef SCHED_SCHEDULE_BY_TILE_H
#define SCHED_SCHEDULE_BY_TILE_H

#include "sched/schedule/phase.h"

/* Orders the state's worklist, whose triangles are listed once each, and gives each its key. What is of no tile (block
 * of the first phase) from first to end - 1 leaves the list. False: no memory, and the worklist is as before. O(n). */
bool par_order_by_tile(struct par_run *state, const struct par_partition *tiles, int32_t first, int32_t end);

/* Bytes that the sort takes beside the worklist. */
static inline size_t par_order_bytes(const struct par_ids *worklist) { return 48 * (size_t)worklist->n; }

#endif
