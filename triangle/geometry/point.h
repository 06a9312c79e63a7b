/* A point, and the range of coordinates in which arithmetic is exact (see triangle/geometry/predicates.h). */
#ifndef TRIANGLE_GEOMETRY_POINT_H
#define TRIANGLE_GEOMETRY_POINT_H

#include <math.h>
#include <stdbool.h>

struct tri_point {
    double x, y;
};

/* The range: multiples of 2^-268 up to 2^200, written as constants that are valid in C++11. From 2^-216 on every double
 * is such a multiple. */
#define TRI_LEAST_COORDINATE (1 / 1.0531229166855719e65)
#define TRI_LARGEST_COORDINATE 1.6069380442589903e60

/* Rounds to a multiple of 2^-268, because doubles below 2^-216 are finer. Does not change values that are too large:
 * check tri_is_in_range. */
static inline double tri_round_coordinate(double x)
{
    double rounded = (fabs(x) + TRI_LEAST_COORDINATE) - TRI_LEAST_COORDINATE;
    return fabs(x) >= TRI_LEAST_COORDINATE || x != x ? x : x < 0 ? 0 - rounded : rounded;
}

/* Is a point, whose coordinates have been rounded, in the range of the predicates? Every vertex is, and the range is
 * convex. So the mesh lies within the range, and a point outside the range is outside the mesh. */
static inline bool tri_is_in_range(struct tri_point p)
{
    return fabs(p.x) <= TRI_LARGEST_COORDINATE && fabs(p.y) <= TRI_LARGEST_COORDINATE;
}

/* Compares by x, then y. < 0: p comes first; 0: the points are equal. */
static inline int tri_compare_places(struct tri_point p, struct tri_point q)
{
    if (p.x != q.x)
        return p.x < q.x ? -1 : 1;
    return (p.y > q.y) - (p.y < q.y);
}

/* These compile to one instruction each, unlike fmin and fmax, which must handle NaN. */
static inline double tri_lesser(double a, double b) { return a < b ? a : b; }
static inline double tri_larger(double a, double b) { return a > b ? a : b; }

/* Returns the squared distance. */
static inline double tri_distance2(struct tri_point p, struct tri_point q)
{
    double x = q.x - p.x, y = q.y - p.y;
    return x * x + y * y;
}

/* Returns the squared distance of p from the segment ab, whose ends may be equal. */
static inline double tri_segment_distance2(struct tri_point a, struct tri_point b, struct tri_point p)
{
    const double x = b.x - a.x, y = b.y - a.y, l = x * x + y * y;
    const double along = l > 0 ? ((p.x - a.x) * x + (p.y - a.y) * y) / l : 0;
    const double at = tri_larger(0, tri_lesser(along, 1));
    return tri_distance2(p, (struct tri_point){a.x + at * x, a.y + at * y});
}

#endif
