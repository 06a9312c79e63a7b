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

/* --- The triangles of a sweep's worklist that no block can have yet: the work of columns to come.  THEOREM. A
 * triangle waits for the first odd column whose blocks' right end lies right of all its corners. Until then no
 * block changes it, and none takes it from the worklist: for a block takes and changes what has all corners in its
 * fence, and the fences of that step and of those before end no further right. So the triangle may be missing from
 * the list until its column has its turn, and come into it by its key then. A list costs what is in a few columns. */

struct par_ahead {
    int32_t *item;  /* by odd column, those of one in the order of the worklist */
    uint64_t *key;  /* of each: its place there */
    int32_t *start; /* [n_odd + 1] */
    int32_t n_odd;
};

/* Of the worklist, which no block has had; the run is as before. False: no memory. To be freed in any case. */
bool par_ahead_make(struct par_ahead *ahead, const struct par_run *run, const struct par_partition *partition);
void par_ahead_free(struct par_ahead *ahead);

/* Those that wait for an odd column come to the worklist. False: no memory. */
bool par_ahead_give(const struct par_ahead *ahead, struct par_run *run, int32_t odd);

/* --- How many triangles stay below the bounds, and why, of a mesh that leaves while it is refined.  THEOREM. A bad
 * triangle that stays is on the list: whoever makes a bad triangle looks at it again until it is gone or given up,
 * and of those that were there before, all that are bad are in the worklist, or on the list from the beginning
 * since there was nothing to do at them. What is on the list may be gone, or its number another triangle's: each
 * is judged when it can change no more. */

/* Of a mesh whose worklist has been filled. False: no memory. */
bool par_remain_begin(struct par_run *run);

/* Counts the bad triangles with a corner left of x, of which none will change any more, and those that had one left of
 * the last x have been counted. Those that are beside them are still there. */
void par_remain_count(struct par_run *run, double x);

/* Tells the report what has been counted. */
void par_remain_settle(struct par_run *run);

/* Counts those of a whole mesh that is finished. */
void par_remain_count_all(struct par_run *run);

#endif
