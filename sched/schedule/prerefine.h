/* Pre-refinement: a coarse mesh, from which the cells of a schedule are cut, and in which its seams are narrow; and how
 * large its triangles may be by the paper.
 *
 * Source: A. N. Chernikov and N. P. Chrisochoides, "Practical and Efficient Point Insertion Scheduling Method for
 * Parallel Guaranteed Quality Delaunay Refinement", ICS 2004. Notation: r is an upper bound on the circumradii in the
 * mesh, rho one on circumradius / shortest edge, theta = arcsin(1 / (2 rho)) one (from below) on angles, A one on
 * areas. */
#ifndef SCHED_SCHEDULE_PREREFINE_H
#define SCHED_SCHEDULE_PREREFINE_H

#include "sched/schedule/partition.h"
#include "sched/schedule/phase.h"

/* rho for an angle bound in degrees, 0 < min_angle <= 60. */
double par_rho(double min_angle);

/* Lemma 7: triangles with area <= A and ratio <= rho have r <= 2 rho^(3/2) sqrt(A). */
double par_radius_lemma7(double max_area, double rho);

/* The tight bound: the extremal triangle is (theta, theta, 180 - 2 theta), r <= sqrt(A / (2 sin^2 theta sin 2 theta));
 * 0.73 of Lemma 7 at 20 degrees, 0.76 at 30. */
double par_radius_tight(double max_area, double min_angle);

/* Square of the circumradius of a triangle. */
double par_radius2(struct tri_point a, struct tri_point b, struct tri_point c);

/* The bounds of a uniform pre-refinement: the same with areas scaled up, as the paper has it, for the area that makes
 * PAR_COARSE_PER_CELL triangles in a cell. */
struct tri_quality par_coarse_bounds(const struct tri_quality *quality, double cell);

/* Is the input coarse against the mesh to come, so that areas say where its triangles will be? Else features do. Each
 * level has at most a quarter of the triangles of the one above. */
bool par_areas_decide(const struct par_run *run, const struct tri_quality *quality, double estimate,
                      double cell);

/* par_worklist_fill for this run, whose keys are forgotten. */
enum tri_status par_fill_worklist(struct par_run *run, const struct tri_quality *quality, bool known,
                                  struct tri_error *error);

/* Pre-refinement where the input is already fine in places: the same refinement for bad triangles alone that have an
 * edge that is long against their cell, with no more than one point for 400 triangles of the mesh to come. No point
 * is inserted that the bounds do not ask for: so it makes no triangle that refinement would not. Fills the worklist. */
enum tri_status par_prerefine_graded(struct par_run *run, const struct tri_quality *quality,
                                     const struct par_partition *partition, struct tri_error *error);

#endif
