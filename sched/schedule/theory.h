/* The theory of the paper in functions: radius bound.
 *
 * Source: A. N. Chernikov and N. P. Chrisochoides, "Practical and Efficient Point Insertion Scheduling Method for
 * Parallel Guaranteed Quality Delaunay Refinement", ICS 2004. Notation: r is an upper bound on the circumradii in the
 * mesh, rho one on circumradius / shortest edge, theta = arcsin(1 / (2 rho)) one (from below) on angles, A one on
 * areas. */
#ifndef SCHED_SCHEDULE_THEORY_H
#define SCHED_SCHEDULE_THEORY_H

#include "triangle/mesh/mesh.h"

/* rho for an angle bound in degrees, 0 < min_angle <= 60. */
double par_rho(double min_angle);

/* Lemma 7: triangles with area <= A and ratio <= rho have r <= 2 rho^(3/2) sqrt(A). */
double par_radius_lemma7(double max_area, double rho);

/* The tight bound: the extremal triangle is (theta, theta, 180 - 2 theta), r <= sqrt(A / (2 sin^2 theta sin 2 theta));
 * 0.73 of Lemma 7 at 20 degrees, 0.76 at 30. */
double par_radius_tight(double max_area, double min_angle);

/* Square of the circumradius of a triangle. */
double par_radius2(struct tri_point a, struct tri_point b, struct tri_point c);

#endif
