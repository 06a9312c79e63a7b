/* A mesh that is handed out as it is made.
 *
 * The first round of a schedule runs from left to right (phase.h, order of columns): the blocks of an odd column, then
 * those of the even one behind it. A column of tiles is final then, unless something is left over by all blocks that
 * have it: it is numbered and handed out, and what it used is used again. So a mesh is never in memory as a whole, and
 * may have any number of triangles. */
#ifndef SCHED_TILES_SWEEP_H
#define SCHED_TILES_SWEEP_H

#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* The tiles of a run's mesh, none of them handed out yet. */
struct par_tiles par_tiles_of(const struct par_run *run, const struct par_partition *partition);

/* *done: all of the mesh has been handed out. False: blocks leave something over, which further rounds would have to
 * do, with all that is around: the sweep has been given up, and neither mesh nor worklist is of any use. */
enum tri_status par_sweep(struct par_run *run, const struct par_partition *partition, bool *done,
                          struct tri_error *error);

/* Counts those of a whole mesh that is finished. */
void par_remain_count_all(struct par_run *run);

#endif
