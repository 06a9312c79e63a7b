/* Pre-refinement makes a coarse mesh. The cells of a schedule are cut from it, and its triangles are small against the
 * cells, so seams are narrow. This header also has the paper's bounds on the size of these triangles.
 *
 * Source: A. N. Chernikov and N. P. Chrisochoides, "Practical and Efficient Point Insertion Scheduling Method for
 * Parallel Guaranteed Quality Delaunay Refinement", ICS 2004. Notation: r is an upper bound on the circumradii in the
 * mesh, rho an upper bound on circumradius / shortest edge, theta = arcsin(1 / (2 rho)) a lower bound on angles, A an
 * upper bound on areas. */
#ifndef SCHED_SCHEDULE_PREREFINE_H
#define SCHED_SCHEDULE_PREREFINE_H

#include "sched/schedule/partition.h"
#include "sched/schedule/phase.h"

/* Returns rho for an angle bound in degrees, 0 < min_angle <= 60. */
double par_rho(double min_angle);

/* Lemma 7: triangles with area <= A and ratio <= rho have r <= 2 rho^(3/2) sqrt(A). Returns this bound. */
double par_radius_lemma7(double max_area, double rho);

/* The tight bound: the extremal triangle has the angles theta, theta, 180 - 2 theta, so r <= sqrt(A / (2 sin^2 theta
 * sin 2 theta)). It is 0.73 times the bound of Lemma 7 at 20 degrees, and 0.76 times at 30. */
double par_radius_tight(double max_area, double min_angle);

/* Returns the square of the circumradius of a triangle. */
double par_radius2(struct tri_point a, struct tri_point b, struct tri_point c);

/* Returns the bounds of a uniform pre-refinement: the given bounds with areas scaled up, as in the paper, so that a
 * cell holds about PAR_COARSE_PER_CELL triangles. cell: final triangles in a cell. */
struct tri_quality par_coarse_bounds(const struct tri_quality *quality, double cell);

/* Returns true if the input is coarse compared with the final mesh, so that the bounds on sizes decide where the
 * triangles are. Otherwise the features of the input decide. If true, each level has at most a quarter of the triangles
 * of the level above. */
bool par_areas_decide(const struct par_run *run, const struct tri_quality *quality, double estimate,
                      double cell);

/* Calls par_worklist_fill for this run, and clears its keys. */
enum tri_status par_fill_worklist(struct par_run *run, const struct tri_quality *quality, bool known,
                                  struct tri_error *error);

/* Graded pre-refinement, for inputs that are already fine in places: refines only bad triangles with an edge that is
 * long compared with their cell, and inserts at most one point for 400 triangles of the final mesh. It inserts only
 * points that the bounds require, so it makes no triangle that plain refinement would not make. Fills the worklist. */
enum tri_status par_prerefine_graded(struct par_run *run, const struct tri_quality *quality,
                                     const struct par_partition *partition, struct tri_error *error);

#endif
