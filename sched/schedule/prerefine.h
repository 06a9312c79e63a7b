/* Pre-refinement: a coarse mesh, from which the cells of a schedule are cut, and in which its seams are narrow. */
#ifndef SCHED_SCHEDULE_PREREFINE_H
#define SCHED_SCHEDULE_PREREFINE_H

#include "sched/schedule/partition.h"
#include "sched/schedule/phase.h"

/* The bounds of a uniform pre-refinement: the same with areas scaled up, as the paper has it, for the area that makes
 * PAR_COARSE_PER_CELL triangles in a cell. */
struct tri_quality par_coarse_bounds(const struct tri_quality *quality, double cell);

/* Is the input coarse against the mesh to come, so that areas say where its triangles will be? Else features do. Each
 * level has at most a quarter of the triangles of the one above. */
bool par_areas_decide(const struct par_run *state, const struct tri_quality *quality, double estimate,
                      double cell);

/* par_worklist_fill for this state, whose keys are forgotten. */
enum tri_status par_fill_worklist(struct par_run *state, const struct tri_quality *quality, bool known,
                                  struct tri_error *error);

/* Pre-refinement where the input is already fine in places: the same refinement for bad triangles alone that have an
 * edge that is long against their cell, with no more than one point for 400 triangles of the mesh to come. No point
 * is inserted that the bounds do not ask for: so it makes no triangle that refinement would not. Fills the worklist. */
enum tri_status par_prerefine_graded(struct par_run *state, const struct tri_quality *quality,
                                     const struct par_partition *partition, struct tri_error *error);

#endif
