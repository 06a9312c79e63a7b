/* Smoothing by blocks: the same four phases as refinement, over vertices. */
#ifndef SCHED_SCHEDULE_SMOOTHING_H
#define SCHED_SCHEDULE_SMOOTHING_H

#include "sched/schedule/phase.h"

/* Smooths a finished mesh as often as asked.quality says (triangle/refine/smooth.h), where it says so.
 *
 * THEOREM. The mesh is the same on any number of threads: it has been numbered, so the mesh decides on the order of the
 * vertices in a block; and blocks of a phase change what lies in their own fences (phase.h). Vertices whose stars no
 * fence holds are the last, in one call. A mesh without cells is smoothed by one call. Numbers are those of the new
 * places at the end. TRI_NO_MEMORY, TRI_STOPPED: the mesh is valid. */
enum tri_status par_smooth(struct par_run *run, struct tri_error *error);

#endif
