/* The shape of a triangle: squared edge lengths, twice its area, its shortest edge.
 *
 * INVARIANT. All decisions use only + - * / and sqrt, so they are the same on every machine. */
#ifndef TRIANGLE_GEOMETRY_SHAPE_H
#define TRIANGLE_GEOMETRY_SHAPE_H

#include <assert.h>
#include <math.h>

#include "triangle/base/ids.h"
#include "triangle/geometry/point.h"

/* Area divided by squared edge length of an equilateral triangle: sqrt(3) / 4. */
static const double TRI_EQUILATERAL = 0.43301270189221932;

/* The next and the previous corner, or edge, of a triangle. */
static const int tri_next[3] = {1, 2, 0}, tri_prev[3] = {2, 0, 1};

/* Returns log2(x) for x >= 1 with an error of at most 0.09: the exponent, plus a linear function of the mantissa. */
static inline double tri_rough_log2(double x)
{
    int exponent;
    double mantissa = frexp(x, &exponent);
    return exponent + 2 * mantissa - 2;
}

/* Returns the cosine of an angle in degrees, 0 .. 180, by its power series, with an error of at most 1e-15. */
static inline double tri_cos_degrees(double degrees)
{
    static const double radians = 0.017453292519943295769;
    assert(degrees >= 0 && degrees <= 180);
    const double acute = degrees > 90 ? 180 - degrees : degrees;
    double x = acute * radians, x2 = x * x, term = 1, sum = 1;
    for (int k = 1; k <= 15; k++) {
        term = -term * x2 / ((2 * k - 1) * (2 * k));
        sum += term;
    }
    return degrees > 90 ? -sum : sum;
}

/* A triangle's shape: squared lengths opposite the corners, twice its area. */
struct tri_shape {
    double l[3], area2;
    int shortest; /* index of the shortest edge, which is opposite the smallest angle */
};

static inline struct tri_shape tri_shape_of(const struct tri_point *xy, const tri_vertex_id v[3])
{
    double ax = xy[v[0]].x, ay = xy[v[0]].y;
    double bx = xy[v[1]].x - ax, by = xy[v[1]].y - ay, cx = xy[v[2]].x - ax, cy = xy[v[2]].y - ay;
    double dx = bx - cx, dy = by - cy;
    struct tri_shape s = {{dx * dx + dy * dy, cx * cx + cy * cy, bx * bx + by * by}, bx * cy - by * cx, 0};
    int second = s.l[1] < s.l[0], third = s.l[2] < tri_lesser(s.l[0], s.l[1]);
    s.shortest = 2 * third + (second & ~third); /* without a branch, which would be unpredictable */
    return s;
}

/* Returns the area of a triangle; positive if its corners are in counter-clockwise order. */
static inline double tri_area_of(struct tri_point a, struct tri_point b, struct tri_point c)
{
    return 0.5 * ((b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x));
}

/* Returns the squared length of the longest edge. */
static inline double tri_longest2(const struct tri_shape *shape)
{
    return tri_larger(shape->l[0], tri_larger(shape->l[1], shape->l[2]));
}

/* Returns the product of the two longer squared edges, which is the largest of the three products. (area2^2 divided by
 * this product is sin^2 of the smallest angle.) Which two edges are longer is random, so a branch would be mispredicted
 * half the time; the maximum of products needs no branch. */
static inline double tri_longer_product(double a, double b, double c)
{
    return tri_larger(a * b, tri_larger(b * c, c * a));
}

#endif
