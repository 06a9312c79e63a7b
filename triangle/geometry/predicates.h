/* Geometric predicates: the sign of a polynomial of coordinates, decided exactly.
 *
 * An inline floating-point filter decides nearly all calls. If its rounding error could matter, an out-of-line function
 * decides, in the last resort by exact arithmetic. No decision depends on the machine, the compiler or the filter.
 *
 * RANGE: a coordinate is an integer multiple of 2^-268 of magnitude at most 2^200 (tri_is_exact_coordinate), as every
 * double of magnitude 2^-216 to 2^200 is. THEOREM (docs/theory.md, exact signs). In this range nothing underflows or
 * overflows. FILTER: a test is |det| > k * size. If det exceeds the computed bound, it also exceeds the true bound, so
 * the filters need no absolute term.
 *
 * Source: J. R. Shewchuk, Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric Predicates, Discrete &
 * Computational Geometry 18 (1997); O. Devillers and M. Teillaud, Perturbations for Delaunay and Weighted Delaunay 3D
 * Triangulations, Computational Geometry 44 (2011). */
#ifndef TRIANGLE_GEOMETRY_PREDICATES_H
#define TRIANGLE_GEOMETRY_PREDICATES_H

#include <assert.h>
#include <math.h>
#include <stdbool.h>

#include "triangle/base/arithmetic.h"
#include "triangle/geometry/point.h"

struct tri_pair; /* triangle/geometry/expansion.h */

/* Filter constants, with u = 2^-53, half a unit in the last place of 1. Both are exact doubles. */
#define TRI_ORIENT2D_BOUND (3 * 0x1p-53 + 16 * 0x1p-106)
#define TRI_INCIRCLE_BOUND (10 * 0x1p-53 + 96 * 0x1p-106)

static inline bool tri_is_exact_coordinate(double x)
{
    return fabs(x) <= TRI_LARGEST_COORDINATE && tri_round_coordinate(x) == x;
}

/* Every predicate asserts this for its points. */
static inline bool tri_is_exact_point(struct tri_point p)
{
    return tri_is_exact_coordinate(p.x) && tri_is_exact_coordinate(p.y);
}

/* Called by the inline functions below if their filter is not certain; the same results, without a filter. Take 5 to 50
 * ns if the structure of the coordinates (grid points, mirror images) or doubled precision decides. Take up to 3 us,
 * and 40 KB of stack, for points that are cocircular within a relative 10^-30 but not on a grid. */
double tri_orient2d_near(struct tri_point a, struct tri_point b, struct tri_point c);
double tri_turn_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d);
double tri_dot_near(struct tri_point a, struct tri_point b, struct tri_point c);
double tri_incircle_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d);
bool tri_in_circle_near(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d);

/* > 0: a, b, c turn counter-clockwise; 0: collinear; < 0: clockwise. The magnitude approximates twice the area. The
 * bound: each product has three rounding errors, (1 + u)^3 - 1; the last subtraction has an error of u * |det|.
 * Together with the rounding of size and of the bound itself, 3u + 12u^2 + O(u^3) would suffice. A size of 0 means an
 * exact 0. */
static inline double tri_orient2d(struct tri_point a, struct tri_point b, struct tri_point c)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c));
    double left = (a.x - c.x) * (b.y - c.y), right = (b.x - c.x) * (a.y - c.y);
    double det = left - right, size = fabs(left) + fabs(right);
    return fabs(det) >= TRI_ORIENT2D_BOUND * size ? det : tri_orient2d_near(a, b, c);
}

/* Is p strictly inside the triangle a, b, c? Always false unless the triangle is counter-clockwise. */
static inline bool tri_is_inside(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point p)
{
    return tri_orient2d(a, b, p) > 0 && tri_orient2d(b, c, p) > 0 && tri_orient2d(c, a, p) > 0;
}

/* > 0: the direction from c to d is counter-clockwise of the direction from a to b; 0: parallel; < 0: clockwise. The
 * bound is that of tri_orient2d. */
static inline double tri_turn(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c) && tri_is_exact_point(d));
    double left = (b.x - a.x) * (d.y - c.y), right = (d.x - c.x) * (b.y - a.y);
    double det = left - right, size = fabs(left) + fabs(right);
    return fabs(det) >= TRI_ORIENT2D_BOUND * size ? det : tri_turn_near(a, b, c, d);
}

/* Returns the sign of (a - c) . (b - c), which is < 0 if c is strictly inside the circle with diameter ab. The
 * magnitude approximates the product. The bound: each term has three rounding errors, the sum one. */
static inline double tri_dot(struct tri_point a, struct tri_point b, struct tri_point c)
{
    double x = (a.x - c.x) * (b.x - c.x), y = (a.y - c.y) * (b.y - c.y), dot = x + y;
    return fabs(dot) > 4 * DBL_EPSILON * (fabs(x) + fabs(y)) ? dot : tri_dot_near(a, b, c);
}

/* Returns the in-circle determinant if its sign is certain, otherwise 0. The bound: a minor has an error of 4u + 6u^2
 * of its size, a lift a relative error of 4u + 6u^2, hence their rounded product one of 9u + 36u^2 of its size; the
 * first sum adds u, the second u * |det|. With the rounding of size (one per sum) and of the bound itself, 10u + 74u^2
 * + O(u^3) would suffice. */
static inline double tri_incircle_filter(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    assert(tri_is_exact_point(a) && tri_is_exact_point(b) && tri_is_exact_point(c) && tri_is_exact_point(d));
    double ax = a.x - d.x, ay = a.y - d.y, bx = b.x - d.x, by = b.y - d.y, cx = c.x - d.x, cy = c.y - d.y;
    double bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
    double a_lift = ax * ax + ay * ay, b_lift = bx * bx + by * by, c_lift = cx * cx + cy * cy;
    double det = a_lift * (bc - cb) + b_lift * (ca - ac) + c_lift * (ab - ba);
    double size = a_lift * (fabs(bc) + fabs(cb)) + b_lift * (fabs(ca) + fabs(ac)) + c_lift * (fabs(ab) + fabs(ba));
    return fabs(det) > TRI_INCIRCLE_BOUND * size ? det : 0;
}

/* > 0: d is inside the circle through a, b, c, which must turn counter-clockwise; 0: on it; < 0: outside. Exchanging
 * two points changes the sign. */
static inline double tri_incircle(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    double det = tri_incircle_filter(a, b, c, d);
    return det != 0 ? det : tri_incircle_near(a, b, c, d);
}

/* Is d inside the circle through a, b, c, which must turn counter-clockwise, with ties broken? The points must be
 * distinct. Exchanging two points changes the answer (except that it is always false for four collinear points).
 *
 * Ties: points are lifted to a paraboloid, and each is raised by its own infinitesimal, which is infinitely greater for
 * a lexicographically larger point (x, then y). So a Delaunay triangulation is the lower hull of points in general
 * position: it is unique, regardless of the insertion order and the numbers of the points. */
static inline bool tri_in_circle(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    double det = tri_incircle_filter(a, b, c, d);
    return det != 0 ? det > 0 : tri_in_circle_near(a, b, c, d);
}

/* Returns the determinant of tri_orient2d with a relative error of 2^-80 and the exact sign, as head + tail; for
 * constructions rather than decisions. */
struct tri_pair tri_orient2d_pair(struct tri_point a, struct tri_point b, struct tri_point c);

#endif
