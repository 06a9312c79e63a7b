/* Crossings and projections in doubled precision. A pair is head + tail with |tail| <= u |head|, up to the rounding of
 * single operations. Each operation loses a few units of 2^-104, which do not affect the final rounding. */
#include "triangle/cdt/crossing.h"

#include <assert.h>

#include "triangle/geometry/expansion.h"
#include "triangle/geometry/predicates.h"

static struct tri_pair product(struct tri_pair p, struct tri_pair q)
{
    struct tri_pair h = tri_two_product(p.head, q.head);
    return tri_fast_two_sum(h.head, h.tail + (p.head * q.tail + p.tail * q.head));
}

static struct tri_pair sum(struct tri_pair p, struct tri_pair q)
{
    struct tri_pair h = tri_two_sum(p.head, q.head);
    return tri_fast_two_sum(h.head, h.tail + (p.tail + q.tail));
}

static struct tri_pair negative(struct tri_pair p) { return (struct tri_pair){-p.head, -p.tail}; }

/* Returns p / q; q must not be 0. */
static struct tri_pair quotient(struct tri_pair p, struct tri_pair q)
{
    assert(q.head != 0);
    double first = p.head / q.head;
    struct tri_pair rest = sum(p, negative(product(q, (struct tri_pair){first, 0})));
    return tri_fast_two_sum(first, rest.head / q.head);
}

/* Returns from + fraction * way, rounded to a coordinate. */
static double move_along(double from, struct tri_pair way, struct tri_pair fraction)
{
    struct tri_pair step = product(way, fraction), h = tri_two_sum(from, step.head);
    return tri_round_coordinate(h.head + (h.tail + step.tail));
}

double tri_line_distance(struct tri_point a, struct tri_point b, struct tri_point q)
{
    struct tri_pair det = tri_orient2d_pair(a, b, q);
    double x = b.x - a.x, y = b.y - a.y;
    return fabs(det.head) / sqrt(x * x + y * y);
}

static bool separates(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    double at_c = tri_orient2d(a, b, c), at_d = tri_orient2d(a, b, d);
    return (at_c > 0 && at_d < 0) || (at_c < 0 && at_d > 0);
}

/* Returns the point where the line through a and b crosses the segment from c to d. */
static struct tri_point cut(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    struct tri_pair from = tri_orient2d_pair(a, b, c), to = tri_orient2d_pair(a, b, d);
    struct tri_pair fraction = quotient(from, sum(from, negative(to)));
    return (struct tri_point){move_along(c.x, tri_two_difference(d.x, c.x), fraction),
                              move_along(c.y, tri_two_difference(d.y, c.y), fraction)};
}

/* Computes the point along the segment with the finer coordinates. */
bool tri_crossing(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d, struct tri_point *p)
{
    if (!separates(a, b, c, d) || !separates(c, d, a, b))
        return false;
    bool finer = fmax(tri_resolution(c), tri_resolution(d)) <= fmax(tri_resolution(a), tri_resolution(b));
    *p = finer ? cut(a, b, c, d) : cut(c, d, a, b);
    return true;
}

struct tri_point tri_onto_line(struct tri_point a, struct tri_point b, struct tri_point q)
{
    struct tri_pair x = tri_two_difference(b.x, a.x), y = tri_two_difference(b.y, a.y);
    struct tri_pair fraction = quotient(tri_orient2d_pair(a, b, q), sum(product(x, x), product(y, y)));
    return (struct tri_point){move_along(q.x, y, fraction), move_along(q.y, negative(x), fraction)};
}
