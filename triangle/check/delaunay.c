/* The empty circle, edge by edge; exact. By Delaunay's lemma (constrained form: Lee & Lin 1986) edges suffice. */
#include "triangle/check/internal.h"

static bool is_conforming(const struct checker *c)
{
    return c->options->delaunay == TRI_CHECK_CONFORMING;
}

static bool is_not_delaunay(const struct checker *c, int32_t h)
{
    if (h > c->link[h] || (!is_conforming(c) && check_is_constrained(c, h)))
        return false;
    return tri_incircle(check_point(c, check_org(c, h)), check_point(c, check_dest(c, h)),
                        check_point(c, check_apex(c, h)), check_point(c, check_apex(c, c->link[h]))) > 0;
}

static void tell_circle(struct checker *c, int32_t h)
{
    tri_check_fault(c, TRI_CHECK_LOCAL_DELAUNAY,
                    "vertex %ld lies inside the circumcircle of triangle %ld (edge %ld-%ld)",
                    check_number(c, check_apex(c, c->link[h])), check_number(c, h / 3),
                    check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)));
}

static bool is_encroached(const struct checker *c, int32_t h)
{
    return check_is_constrained(c, h) && tri_dot(check_point(c, check_org(c, h)), check_point(c, check_dest(c, h)),
                                                 check_point(c, check_apex(c, h))) < 0;
}

static void tell_encroached(struct checker *c, int32_t h)
{
    tri_check_fault(c, TRI_CHECK_ENCROACHMENT, "vertex %ld lies inside the diametral circle of subsegment %ld-%ld",
                    check_number(c, check_apex(c, h)), check_number(c, check_org(c, h)),
                    check_number(c, check_dest(c, h)));
}

void tri_check_delaunay(struct checker *c)
{
    if (c->options->delaunay == TRI_CHECK_NOT_DELAUNAY)
        return;
    tri_check_each(c, TRI_CHECK_LOCAL_DELAUNAY, c->n_half_edges, is_not_delaunay, tell_circle);
    if (is_conforming(c))
        tri_check_each(c, TRI_CHECK_ENCROACHMENT, c->n_half_edges, is_encroached, tell_encroached);
}
