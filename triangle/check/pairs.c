/* Rules for an edge and its adjacent triangles: given neighbours, empty circles, and region attributes. The empty
 * circle test is exact; by Delaunay's lemma in its constrained form (Lee & Lin 1986) it suffices to test edges.
 * Region attributes must be equal on both sides of every edge that is not a subsegment. So all triangles of a face
 * have the same attribute, and the sweep (winding.c) determines which one it should be.
 *
 * Each rule is tested for a half-edge a and its twin b, which is NULL at the boundary. This happens when both are in
 * a part, or when they have been matched. */
#include "triangle/check/internal.h"

struct check_rule {
    enum tri_check_kind kind; /* kind of fault */
    bool once;  /* true: tested once per edge, for the smaller half-edge, and not on the boundary */
    bool walls; /* true: tested for subsegments only */
    bool (*is_bad)(const struct checker *c, const struct check_open *a, const struct check_open *b);
    void (*tell)(struct checker *c, const struct check_open *a, const struct check_open *b);
};

static bool is_conforming(const struct checker *c)
{
    return c->options->delaunay == TRI_CHECK_CONFORMING;
}

/* --- given neighbours */

static int64_t triangle_of(const struct check_open *b) { return b != NULL ? b->half_edge / 3 : -1; }

static bool is_other_neighbor(const struct checker *c, const struct check_open *a, const struct check_open *b)
{
    (void)c;
    return a->neighbor != triangle_of(b);
}

static void report_neighbor(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_fault(c, TRI_CHECK_NEIGHBORS, "triangle %ld: neighbor across edge %ld-%ld is given as %ld, but is %ld",
                    check_number(c, a->half_edge / 3), check_number(c, a->from), check_number(c, a->to),
                    a->neighbor < 0 ? -1L : check_number(c, a->neighbor),
                    b == NULL ? -1L : check_number(c, triangle_of(b)));
}

/* --- regions */

static bool differs(const struct checker *c, const struct check_open *a, const struct check_open *b)
{
    (void)c;
    return !a->constrained && a->attribute != b->attribute;
}

static void report_difference(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_fault(c, TRI_CHECK_REGIONS, "triangles %ld and %ld have attributes %.17g and %.17g, no segment between",
                    check_number(c, a->half_edge / 3), check_number(c, b->half_edge / 3), a->attribute, b->attribute);
}

/* --- circles */

static bool is_not_delaunay(const struct checker *c, const struct check_open *a, const struct check_open *b)
{
    return (is_conforming(c) || !a->constrained) && tri_incircle(a->at[0], a->at[1], a->at[2], b->at[2]) > 0;
}

static void tell_circle(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    tri_check_fault(c, TRI_CHECK_LOCAL_DELAUNAY,
                    "vertex %ld lies inside the circumcircle of triangle %ld (edge %ld-%ld)", check_number(c, b->apex),
                    check_number(c, a->half_edge / 3), check_number(c, a->from), check_number(c, a->to));
}

static bool is_flat(const struct check_open *a) { return tri_dot(a->at[0], a->at[1], a->at[2]) < 0; }

/* Is the subsegment encroached? If vertices on both sides lie in its circle, it counts once. If no subsegments are
 * listed, boundary edges count as subsegments. */
static bool is_encroached(const struct checker *c, const struct check_open *a, const struct check_open *b)
{
    const bool constrained = a->constrained || (b == NULL && !check_is_listed(c));
    return constrained && is_flat(a) && (b == NULL || a->half_edge < b->half_edge || !is_flat(b));
}

static void tell_encroached(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    (void)b;
    tri_check_fault(c, TRI_CHECK_ENCROACHMENT, "vertex %ld lies inside the diametral circle of subsegment %ld-%ld",
                    check_number(c, a->apex), check_number(c, a->from), check_number(c, a->to));
}

/* --- the rules */

static const struct check_rule rules[] = {
    {TRI_CHECK_NEIGHBORS, false, false, is_other_neighbor, report_neighbor},
    {TRI_CHECK_REGIONS, true, false, differs, report_difference},
    {TRI_CHECK_LOCAL_DELAUNAY, true, false, is_not_delaunay, tell_circle},
    {TRI_CHECK_ENCROACHMENT, false, true, is_encroached, tell_encroached},
};

enum { N_RULES = sizeof rules / sizeof *rules };

static bool is_asked(const struct checker *c, const struct check_rule *rule)
{
    switch (rule->kind) {
    case TRI_CHECK_NEIGHBORS:
        return check_is_given(c, TRI_CHECK_NEIGHBORS_GIVEN);
    case TRI_CHECK_REGIONS:
        return check_wants_regions(c);
    case TRI_CHECK_ENCROACHMENT:
        return is_conforming(c) && check_good(c, TRI_CHECK_ORIENTATION);
    default:
        return c->options->delaunay != TRI_CHECK_NOT_DELAUNAY && check_good(c, TRI_CHECK_ORIENTATION);
    }
}

/* The Delaunay rule, tested for every edge. It needs only positions, so it does not call tri_check_open. */
static bool is_not_delaunay_at(const struct checker *c, int64_t i)
{
    const int32_t h = (int32_t)i, back = c->part.link[h];
    return h < back && (is_conforming(c) || !check_is_constrained(c, h)) &&
           tri_incircle(check_place(c, check_org(c, h)), check_place(c, check_dest(c, h)),
                        check_place(c, check_apex(c, h)), check_place(c, check_apex(c, back))) > 0;
}

static bool is_bad_at(const struct checker *c, int64_t i)
{
    const int32_t h = (int32_t)i, back = c->part.link[h];
    if (back < 0 || (c->rule->once && back < h) || (c->rule->walls && !check_is_constrained(c, h)))
        return false;
    const struct check_open a = tri_check_open(c, h), b = tri_check_open(c, back);
    return c->rule->is_bad(c, &a, &b);
}

static void report_pair(struct checker *c, int64_t h)
{
    const struct check_open a = tri_check_open(c, (int32_t)h), b = tri_check_open(c, c->part.link[h]);
    c->rule->tell(c, &a, &b);
}

void tri_check_pairs(struct checker *c)
{
    for (c->rule = rules; c->rule < rules + N_RULES; c->rule++) {
        if (is_asked(c, c->rule))
            tri_check_each(c, c->rule->kind, 3 * c->part.first, c->part.n_half_edges,
                           c->rule->kind == TRI_CHECK_LOCAL_DELAUNAY ? is_not_delaunay_at : is_bad_at, report_pair);
    }
}

static void judge_side(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    c->at = a->half_edge;
    for (int i = 0; i < N_RULES; i++) {
        const struct check_rule *rule = &rules[i];
        if (rule->once && (b == NULL || b->half_edge < a->half_edge))
            continue;
        if (is_asked(c, rule) && rule->is_bad(c, a, b))
            rule->tell(c, a, b);
    }
    c->at = 0;
}

void tri_check_matched(struct checker *c, const struct check_open *a, const struct check_open *b)
{
    judge_side(c, a, b);
    if (b != NULL)
        judge_side(c, b, a);
}

/* --- orientation: every triangle is strictly counter-clockwise */

static double twice_area(const struct checker *c, int64_t t)
{
    const int32_t *v = c->part.triangles + 3 * t;
    return tri_orient2d(check_place(c, v[0]), check_place(c, v[1]), check_place(c, v[2]));
}

static bool is_turned(const struct checker *c, int64_t t)
{
    return !(twice_area(c, t) > 0);
}

static void report_orientation(struct checker *c, int64_t t)
{
    const int32_t *v = c->part.triangles + 3 * t;
    tri_check_fault(c, TRI_CHECK_ORIENTATION, "triangle %ld (%ld %ld %ld) is %s", check_part_triangle(c, (int32_t)t),
                    check_part_vertex(c, v[0]), check_part_vertex(c, v[1]), check_part_vertex(c, v[2]),
                    twice_area(c, t) < 0 ? "clockwise" : "flat");
}

void tri_check_orientation(struct checker *c)
{
    tri_check_each(c, TRI_CHECK_ORIENTATION, c->part.first, c->part.n_triangles, is_turned, report_orientation);
}
