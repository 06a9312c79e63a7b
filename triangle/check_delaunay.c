/* The empty circle, edge by edge; exact. By Delaunay's lemma (constrained form: Lee & Lin 1986) edges suffice. */
#include "triangle/check_internal.h"
#include "triangle/expansion.h"

/* Exact sign of (a - c) . (b - c): < 0 if c lies strictly inside the circle with diameter a b. */
static double dot_sign(struct tri_point a, struct tri_point b, struct tri_point c)
{
    double x = (a.x - c.x) * (b.x - c.x), y = (a.y - c.y) * (b.y - c.y), dot = x + y;
    if (fabs(dot) > 4 * DBL_EPSILON * (fabs(x) + fabs(y)))
        return dot; /* each term errs by 3 roundings, the sum by 1 */
    double f[2], g[2], px[8], py[8], sum[16];
    int m = tri_expansion_of_pair(tri_two_difference(a.x, c.x), f);
    int n = tri_expansion_of_pair(tri_two_difference(b.x, c.x), g);
    int nx = tri_expansion_product(m, f, n, g, px);
    m = tri_expansion_of_pair(tri_two_difference(a.y, c.y), f);
    n = tri_expansion_of_pair(tri_two_difference(b.y, c.y), g);
    int ny = tri_expansion_product(m, f, n, g, py);
    return tri_expansion_value(tri_expansion_sum(nx, px, ny, py, sum), sum);
}

static void check_edge(struct checker *c, int32_t h)
{
    int32_t a = check_org(c, h), b = check_dest(c, h), p = check_apex(c, h), q = check_apex(c, c->link[h]);
    struct tri_point pa = check_point(c, a), pb = check_point(c, b);
    if (tri_incircle(pa, pb, check_point(c, p), check_point(c, q)) <= 0)
        return;
    tri_check_fault(c, TRI_CHECK_LOCAL_DELAUNAY,
                    "vertex %ld lies inside the circumcircle of triangle %ld (edge %ld-%ld)",
                    check_number(c, q), check_number(c, h / 3), check_number(c, a), check_number(c, b));
}

static void check_diametral_circle(struct checker *c, int32_t h)
{
    int32_t a = check_org(c, h), b = check_dest(c, h), p = check_apex(c, h);
    if (dot_sign(check_point(c, a), check_point(c, b), check_point(c, p)) >= 0)
        return;
    tri_check_fault(c, TRI_CHECK_ENCROACHMENT, "vertex %ld lies inside the diametral circle of subsegment %ld-%ld",
                    check_number(c, p), check_number(c, a), check_number(c, b));
}

void tri_check_delaunay(struct checker *c)
{
    if (c->options->delaunay == TRI_CHECK_NOT_DELAUNAY)
        return;
    bool conforming = c->options->delaunay == TRI_CHECK_CONFORMING;
    tri_check_begin(c, TRI_CHECK_LOCAL_DELAUNAY);
    if (conforming)
        tri_check_begin(c, TRI_CHECK_ENCROACHMENT);
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        bool constrained = check_is_constrained(c, h);
        if (h < c->link[h] && (conforming || !constrained))
            check_edge(c, h);
        if (conforming && constrained)
            check_diametral_circle(c, h);
    }
}
