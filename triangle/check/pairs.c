/* What is to be said of an edge and the triangles beside it: the neighbours given, the empty circle (exact; by
 * Delaunay's lemma, constrained form: Lee & Lin 1986, edges suffice), and attributes, which are the same on both sides
 * of every edge that is no subsegment. So all triangles of a face have one attribute, and what it should be is asked of
 * the sweep (overlap.c). */
#include "triangle/check/store.h"

static bool is_conforming(const struct checker *c)
{
    return c->options->delaunay == TRI_CHECK_CONFORMING;
}

static bool is_pair(const struct checker *c, int32_t h)
{
    return h < c->part.link[h];
}

/* --- in a part */

static bool is_not_delaunay(const struct checker *c, int64_t i)
{
    int32_t h = (int32_t)i;
    if (!is_pair(c, h) || (!is_conforming(c) && check_is_constrained(c, h)))
        return false;
    return tri_incircle(check_place(c, check_org(c, h)), check_place(c, check_dest(c, h)),
                        check_place(c, check_apex(c, h)), check_place(c, check_apex(c, c->part.link[h]))) > 0;
}

static bool sees_flat(const struct checker *c, int32_t h)
{
    return tri_dot(check_place(c, check_org(c, h)), check_place(c, check_dest(c, h)),
                   check_place(c, check_apex(c, h))) < 0;
}

/* A subsegment counts once, also where vertices on both sides lie in its circle. */
static bool is_encroached(const struct checker *c, int64_t i)
{
    int32_t h = (int32_t)i, back = c->part.link[h];
    return back >= 0 && check_is_constrained(c, h) && sees_flat(c, h) && (h < back || !sees_flat(c, back));
}

static bool differs(const struct checker *c, int64_t i)
{
    int32_t h = (int32_t)i;
    return is_pair(c, h) && !check_is_constrained(c, h) &&
           check_attribute(c, h / 3) != check_attribute(c, c->part.link[h] / 3);
}

/* --- the words */

static void tell_circle(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_fault(c, TRI_CHECK_LOCAL_DELAUNAY,
                    "vertex %ld lies inside the circumcircle of triangle %ld (edge %ld-%ld)", check_number(c, b->apex),
                    check_number(c, a->half_edge / 3), check_number(c, a->from), check_number(c, a->to));
}

static void tell_encroached(struct checker *c, const struct check_open *a)
{
    tri_check_fault(c, TRI_CHECK_ENCROACHMENT, "vertex %ld lies inside the diametral circle of subsegment %ld-%ld",
                    check_number(c, a->apex), check_number(c, a->from), check_number(c, a->to));
}

static void tell_difference(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_fault(c, TRI_CHECK_REGIONS, "triangles %ld and %ld have attributes %.17g and %.17g, no segment between",
                    check_number(c, a->half_edge / 3), check_number(c, b->half_edge / 3), a->attribute, b->attribute);
}

static void tell_circle_at(struct checker *c, int64_t h)
{
    struct check_open a = tri_check_open(c, (int32_t)h), b = tri_check_open(c, c->part.link[h]);
    tell_circle(c, &a, &b);
}

static void tell_encroached_at(struct checker *c, int64_t h)
{
    struct check_open a = tri_check_open(c, (int32_t)h);
    tell_encroached(c, &a);
}

static void tell_difference_at(struct checker *c, int64_t h)
{
    struct check_open a = tri_check_open(c, (int32_t)h), b = tri_check_open(c, c->part.link[h]);
    tell_difference(c, &a, &b);
}

void tri_check_pairs(struct checker *c)
{
    int64_t first = 3 * c->part.first, n = c->part.n_half_edges;
    tri_check_neighbors(c);
    if (check_wants_regions(c))
        tri_check_each(c, TRI_CHECK_REGIONS, first, n, differs, tell_difference_at);
    if (c->options->delaunay == TRI_CHECK_NOT_DELAUNAY || !check_good(c, TRI_CHECK_ORIENTATION))
        return;
    tri_check_each(c, TRI_CHECK_LOCAL_DELAUNAY, first, n, is_not_delaunay, tell_circle_at);
    if (is_conforming(c))
        tri_check_each(c, TRI_CHECK_ENCROACHMENT, first, n, is_encroached, tell_encroached_at);
}

/* --- across parts, and at the boundary */

static void judge_circle(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    if (a->half_edge < b->half_edge && (is_conforming(c) || !a->constrained) &&
        tri_incircle(a->at[0], a->at[1], a->at[2], b->at[2]) > 0)
        tell_circle(c, a, b);
}

static bool is_flat(const struct check_open *a) { return tri_dot(a->at[0], a->at[1], a->at[2]) < 0; }

static void judge_diametral(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    bool constrained = a->constrained || !check_is_listed(c); /* then the boundary is what there is */
    bool first = b == NULL || a->half_edge < b->half_edge;
    if (is_conforming(c) && constrained && is_flat(a) && (first || !is_flat(b)))
        tell_encroached(c, a);
}

static void judge_side(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_matched_neighbor(c, a, b);
    c->at = a->half_edge;
    if (c->options->delaunay != TRI_CHECK_NOT_DELAUNAY && check_good(c, TRI_CHECK_ORIENTATION)) {
        if (b != NULL)
            judge_circle(c, a, b);
        if (b == NULL || a->constrained)
            judge_diametral(c, a, b);
    }
    if (b != NULL && a->half_edge < b->half_edge && check_wants_regions(c) && !a->constrained &&
        a->attribute != b->attribute)
        tell_difference(c, a, b);
    c->at = 0;
}

void tri_check_matched(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    judge_side(c, a, b);
    if (b != NULL)
        judge_side(c, b, a);
}
