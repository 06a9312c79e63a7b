/* How many triangles stay below the bounds, and why, of a mesh that leaves while it is refined.
 *
 * THEOREM. A bad triangle that stays is on the list: whoever makes a bad triangle looks at it again until it is gone or
 * given up, and of those that were there before, all that are bad are in the worklist, or on the list from the
 * beginning since there was nothing to do at them. What is on the list may be gone, or its number another triangle's:
 * each is judged when it can change no more. */
#ifndef SCHED_TILES_REMAIN_H
#define SCHED_TILES_REMAIN_H

#include "sched/schedule/phase.h"

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
