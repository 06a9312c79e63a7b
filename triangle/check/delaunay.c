/* The empty circle, edge by edge; exact. By Delaunay's lemma (constrained form: Lee & Lin 1986) edges suffice. */
#include "triangle/check/internal.h"

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
    if (tri_dot(check_point(c, a), check_point(c, b), check_point(c, p)) >= 0)
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
