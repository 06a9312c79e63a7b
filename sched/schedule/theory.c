/* Radius bound. */
#include "sched/schedule/theory.h"

#include <assert.h>
#include <math.h>

#include "triangle/geometry/shape.h"

static double sine(double degrees)
{
    double cosine = tri_cos_degrees(degrees);
    return sqrt(1 - cosine * cosine);
}

double par_rho(double min_angle)
{
    assert(min_angle > 0 && min_angle <= 60);
    return 1 / (2 * sine(min_angle));
}

double par_radius_lemma7(double max_area, double rho) { return 2 * rho * sqrt(rho) * sqrt(max_area); }

double par_radius_tight(double max_area, double min_angle)
{
    double s = sine(min_angle);
    assert(min_angle > 0 && min_angle < 90);
    return sqrt(max_area / (2 * s * s * sine(2 * min_angle)));
}

double par_radius2(struct tri_point a, struct tri_point b, struct tri_point c)
{
    double area2 = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return tri_distance2(a, b) * tri_distance2(b, c) * tri_distance2(c, a) / (4 * area2 * area2);
}
