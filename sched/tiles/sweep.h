/* Sweep: an out-of-core mode in which tiles are handed out while the mesh is still being refined.
 *
 * The first round of a schedule runs from left to right (phase.h, order of columns): the blocks of an odd column, then
 * those of the even column to its left. A column of tiles is then final, unless its blocks have left over some work. A
 * final column is numbered and handed out, and its memory is reused. The mesh is therefore never in memory as a whole,
 * and may have any number of triangles. */
#ifndef SCHED_TILES_SWEEP_H
#define SCHED_TILES_SWEEP_H

#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* Returns the tiles of a run's mesh, none of them handed out yet. */
struct par_tiles par_tiles_of(const struct par_run *run, const struct par_partition *partition);

/* Refines and hands out the mesh column by column. *done: the whole mesh has been handed out. If *done is false, blocks
 * left over work that needs further rounds on triangles around it. The sweep was then abandoned, and mesh and worklist
 * must not be used. */
enum tri_status par_sweep(struct par_run *run, const struct par_partition *partition, bool *done,
                          struct tri_error *error);

/* Counts the remaining bad triangles of a finished mesh that is completely in memory. */
void par_remain_count_all(struct par_run *run);

#endif
