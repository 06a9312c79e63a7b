/* The geometry of one triangle: its shape, its bounds in the form in which the inner loop compares them, and the usual
 * point of a bad one (circumcentre or off-centre).
 *
 *   tri_bounds_for       what an angle bound is: a squared sine, the lens of a subsegment, the height of an off-centre
 *   tri_shape_of         squared edge lengths, twice the area, the shortest edge
 *   tri_longer_product   what the sine of the smallest angle is measured by
 *   tri_place            the usual point
 *
 * criterion.h asks with these whether a triangle of a mesh is bad; treat.c chooses between tri_place and petal.h.
 * INVARIANT. All decisions use + - * / and sqrt alone, so that they are the same on every machine. */
#ifndef TRIANGLE_REFINE_QUALITY_H
#define TRIANGLE_REFINE_QUALITY_H

#include <math.h>

#include "triangle/geometry/point.h"
#include "triangle/mesh/mesh.h"

/* The bounds in the form in which the inner loop compares them. */
struct tri_bounds {
    double sin2;       /* square of the sine of the angle bound; 0: no angle bound */
    double lens_cos2;  /* a point that sees a subsegment under more than 180 - 2 * bound encroaches: dot < 0 and
                          dot^2 > lens_cos2 * product of squared lengths */
    double off_centre; /* height of an off-centre over its edge in units of the edge; 0: always circumcentres */
};

/* min_angle in degrees; above 60 as 60, which no mesh keeps; 0: no bound. conforming: the lens is the whole diametral
 * disk. */
struct tri_bounds tri_bounds_for(double min_angle, bool conforming);

/* log2(x) for x >= 1, within 0.09: the exponent, and the mantissa for the rest. */
static inline double tri_rough_log2(double x)
{
    int exponent;
    double mantissa = frexp(x, &exponent);
    return exponent + 2 * mantissa - 2;
}

/* A triangle's shape: squared lengths opposite the corners, twice its area. */
struct tri_shape {
    double l[3], area2;
    int shortest; /* index of the shortest edge, the one opposite the smallest angle */
};

static inline struct tri_shape tri_shape_of(const struct tri_point *xy, const tri_vertex_id v[3])
{
    double ax = xy[v[0]].x, ay = xy[v[0]].y;
    double bx = xy[v[1]].x - ax, by = xy[v[1]].y - ay, cx = xy[v[2]].x - ax, cy = xy[v[2]].y - ay;
    double dx = bx - cx, dy = by - cy;
    struct tri_shape s = {{dx * dx + dy * dy, cx * cx + cy * cy, bx * bx + by * by}, bx * cy - by * cx, 0};
    int second = s.l[1] < s.l[0], third = s.l[2] < tri_lesser(s.l[0], s.l[1]);
    s.shortest = 2 * third + (second & ~third); /* without a branch, which nobody could predict */
    return s;
}

/* The square of its longest edge. */
static inline double tri_longest2(const struct tri_shape *shape)
{
    return tri_larger(shape->l[0], tri_larger(shape->l[1], shape->l[2]));
}

/* sin^2 of the smallest angle is area2^2 over the product of the two longer squared edges. That is the largest of the
 * three products: which two edges are the longer ones is as good as random, and a branch on it would be predicted
 * wrongly half the time; of products the processor takes the larger without one. */
static inline double tri_longer_product(double a, double b, double c)
{
    return tri_larger(a * b, tri_larger(b * c, c * a));
}

/* The point that replaces a bad triangle, on the bisector of its shortest edge: the circumcentre or, where that lies
 * farther from the edge than `reach` (a height over the edge), the point at that height (off-centres: Üngör 2004). */
struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach);

#endif
