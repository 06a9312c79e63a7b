/* Smoothing by blocks, in the same four phases as refinement, with vertices instead of triangles. */
#ifndef SCHED_SCHEDULE_SMOOTHING_H
#define SCHED_SCHEDULE_SMOOTHING_H

#include "sched/schedule/phase.h"

/* Smooths a finished mesh with the number of passes in run->asked.quality (triangle/refine/smooth.h); does nothing if
 * smoothing is not requested. Called on the calling thread.
 *
 * THEOREM. The mesh is the same on any number of threads. It has been numbered before, so the order of the vertices in
 * a block depends on the mesh alone, and the blocks of a phase change only vertices inside their own fences (phase.h).
 * Vertices whose neighbourhoods lie in no fence are smoothed last, in one sequential call. A mesh without cells is
 * smoothed by one call. Afterwards the mesh is numbered again, by the new positions. TRI_NO_MEMORY, TRI_STOPPED: the
 * mesh is valid. */
enum tri_status par_smooth(struct par_run *run, struct tri_error *error);

#endif
