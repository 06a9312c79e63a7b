/* A point, and the range of coordinates in which arithmetic is exact (triangle/geometry/predicates.h says why). */
#ifndef TRIANGLE_GEOMETRY_POINT_H
#define TRIANGLE_GEOMETRY_POINT_H

#include <math.h>
#include <stdbool.h>

struct tri_point {
    double x, y;
};

/* The range: multiples of 2^-268 up to 2^200, in words that C++11 has. From 2^-216 on every double is one. */
#define TRI_LEAST_COORDINATE (1 / 1.0531229166855719e65)
#define TRI_LARGEST_COORDINATE 1.6069380442589903e60

/* A multiple of 2^-268: below 2^-216 doubles are finer. What is too large stays so: tri_is_in_range tells. */
static inline double tri_round_coordinate(double x)
{
    double rounded = (fabs(x) + TRI_LEAST_COORDINATE) - TRI_LEAST_COORDINATE;
    return fabs(x) >= TRI_LEAST_COORDINATE || x != x ? x : x < 0 ? 0 - rounded : rounded;
}

/* Can the predicates carry this point, whose coordinates have been rounded? Every vertex they can, and the range is
 * convex: so the figure ends before the range does, and a point out of it lies outside the figure. */
static inline bool tri_is_in_range(struct tri_point p)
{
    return fabs(p.x) <= TRI_LARGEST_COORDINATE && fabs(p.y) <= TRI_LARGEST_COORDINATE;
}

/* < 0: p comes first in the order of x, then y; 0: they are one place. */
static inline int tri_compare_places(struct tri_point p, struct tri_point q)
{
    if (p.x != q.x)
        return p.x < q.x ? -1 : 1;
    return (p.y > q.y) - (p.y < q.y);
}

/* One instruction each, which fmin and fmax are not: those have to say what to do about NaN. */
static inline double tri_lesser(double a, double b) { return a < b ? a : b; }
static inline double tri_larger(double a, double b) { return a > b ? a : b; }

/* The squared distance. */
static inline double tri_distance2(struct tri_point p, struct tri_point q)
{
    double x = q.x - p.x, y = q.y - p.y;
    return x * x + y * y;
}

#endif
