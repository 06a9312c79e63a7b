/* The border: every boundary edge lies along an input segment, or along the convex hull of the input where that may be
 * one.
 *
 * The hull is found by scans along the points in order of x, then y (Andrew 1979). An edge lies along it if both its
 * ends are within the tolerance of the line of one hull edge, that below or above them or a neighbour of that: points
 * made on the hull are rounded. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { NEIGHBORS = 2 };

struct border {
    struct checker *c;
    struct check_hull hull;
};

int tri_check_compare_points(const void *left, const void *right)
{
    const struct tri_point *p = left, *q = right;
    return tri_compare_places(*p, *q);
}

/* Keeps of n sorted points those of the lower (+1) or upper (-1) chain. */
static int32_t scan(struct tri_point *out, const struct tri_point *sorted, int32_t n, int sign)
{
    int32_t k = 0;
    for (int32_t i = 0; i < n; i++) {
        while (k > 1 && sign * tri_orient2d(out[k - 2], out[k - 1], sorted[i]) <= 0)
            k--;
        if (k == 0 || !check_same_place(out[k - 1], sorted[i]))
            out[k++] = sorted[i];
    }
    return k;
}

enum tri_status tri_check_hull_of(struct tri_point *points, int64_t n, struct check_hull *hull)
{
    for (int i = 0; i < 2; i++)
        hull->chain[i] = tri_check_array(n, sizeof *points);
    if (hull->chain[0] == NULL || hull->chain[1] == NULL)
        return TRI_NO_MEMORY;
    qsort(points, (size_t)n, sizeof *points, tri_check_compare_points);
    for (int i = 0; i < 2; i++)
        hull->n[i] = scan(hull->chain[i], points, (int32_t)n, i == 0 ? 1 : -1);
    return TRI_OK;
}

void tri_check_hull_free(struct check_hull *hull)
{
    free(hull->chain[0]);
    free(hull->chain[1]);
}

static enum tri_status find_hull(struct border *b)
{
    const struct tri_pslg *input = b->c->input;
    struct tri_point *points = tri_check_array(input->n_points, sizeof *points);
    int32_t n = 0;
    for (int32_t i = 0; points != NULL && i < input->n_points; i++) {
        struct tri_point p = {input->points[2 * (size_t)i], input->points[2 * (size_t)i + 1]};
        if (tri_is_exact_point(p))
            points[n++] = p;
    }
    enum tri_status status = points != NULL ? tri_check_hull_of(points, n, &b->hull) : TRI_NO_MEMORY;
    free(points);
    return status;
}

static bool is_near(struct tri_point a, struct tri_point b, struct tri_point p, double tolerance)
{
    double x = b.x - a.x, y = b.y - a.y;
    return fabs(x * (p.y - a.y) - y * (p.x - a.x)) <= tolerance * sqrt(x * x + y * y);
}

/* Do both points lie along one edge of the chain? */
static bool is_along_chain(const struct border *b, int chain, struct tri_point p, struct tri_point q)
{
    const struct tri_point *hull = b->hull.chain[chain], at = tri_compare_places(p, q) < 0 ? p : q;
    int32_t low = 0, high = b->hull.n[chain] - 1;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        *(tri_compare_places(hull[middle], at) <= 0 ? &low : &high) = middle;
    }
    for (int32_t i = low - NEIGHBORS; i <= low + NEIGHBORS; i++) {
        if (i >= 0 && i + 1 < b->hull.n[chain] && is_near(hull[i], hull[i + 1], p, b->c->tolerance) &&
            is_near(hull[i], hull[i + 1], q, b->c->tolerance))
            return true;
    }
    return false;
}

static bool is_along_hull(const struct border *b, int32_t s)
{
    const int32_t *ends = b->c->segments + 2 * (size_t)s;
    struct tri_point p = check_point(b->c, ends[0]), q = check_point(b->c, ends[1]);
    return is_along_chain(b, 0, p, q) || is_along_chain(b, 1, p, q);
}

/* Did whoever asks forget to say that the mesh may end there? */
static bool may_be_meant(struct border *b, int32_t s)
{
    return (b->hull.chain[0] || find_hull(b) == TRI_OK) && is_along_hull(b, s);
}

static void check_border(struct border *b, bool hull)
{
    struct checker *c = b->c;
    for (int32_t s = 0; s < c->n_segments; s++) {
        if (!check_is_listed_well(c, s) || (c->is_along != NULL && c->is_along[s]))
            continue;
        int64_t there = c->sides[s][0].half_edge, back = c->sides[s][1].half_edge;
        if ((there < 0) == (back < 0) || (hull && is_along_hull(b, s)))
            continue;
        tri_check_fault(c, TRI_CHECK_BORDER, "the mesh ends at %ld-%ld of triangle %ld, along no input segment%s",
                        check_frame_vertex(c, c->segments[2 * (size_t)s]),
                        check_frame_vertex(c, c->segments[2 * (size_t)s + 1]),
                        check_number(c, (there < 0 ? back : there) / 3),
                        hull ? " and not along the convex hull"
                        : may_be_meant(b, s) ? ", but along the convex hull: was it made with -c (keep-hull)?" : "");
    }
}

enum tri_status tri_check_border(struct checker *c)
{
    struct border b = {.c = c};
    const struct tri_check_options *o = c->options;
    bool listed = check_is_listed(c), segments = c->input->n_segments > 0;
    if (o->border == TRI_CHECK_BORDER_ANY || (segments && !listed)) /* which segments there are is not known */
        return TRI_OK;
    bool hull = !segments || o->convex || o->border == TRI_CHECK_BORDER_HULL;
    enum tri_status status = hull ? find_hull(&b) : TRI_OK;
    if (status == TRI_OK) {
        tri_check_begin(c, TRI_CHECK_BORDER);
        check_border(&b, hull);
    }
    tri_check_hull_free(&b.hull);
    return status;
}
