/* The border: every boundary edge lies along an input segment or, if that is allowed, along the convex hull of the
 * input.
 *
 * The hull is found by scanning the points sorted by x, then y (Andrew 1979). An edge lies along the hull if both
 * ends are within the tolerance of the line of one hull edge, since points created on the hull are rounded. The hull
 * edge may be the one below or above the ends, or one of its neighbours. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { NEIGHBORS = 2 };

/* A convex hull: the lower and the upper chain, each sorted by x, then y. */
struct hull {
    struct tri_point *chain[2]; /* lower and upper chain */
    int32_t n[2];               /* points in each chain */
};

struct border {
    struct checker *c;
    struct hull hull; /* hull of the input, if needed */
};

static int compare_points(const void *left, const void *right)
{
    const struct tri_point *p = left, *q = right;
    return tri_compare_places(*p, *q);
}

/* Copies the points of the lower (sign +1) or upper (-1) chain from n sorted points. Returns how many there are. */
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

/* Makes the hull. Sorts the points and frees them. */
static enum tri_status make_hull(struct tri_point *points, int64_t n, struct hull *hull)
{
    for (int i = 0; i < 2; i++)
        hull->chain[i] = tri_check_array(n, sizeof *points);
    const bool room = points != NULL && hull->chain[0] != NULL && hull->chain[1] != NULL;
    if (room)
        qsort(points, (size_t)n, sizeof *points, compare_points);
    for (int i = 0; room && i < 2; i++)
        hull->n[i] = scan(hull->chain[i], points, (int32_t)n, i == 0 ? 1 : -1);
    free(points);
    return room ? TRI_OK : TRI_NO_MEMORY;
}

static void free_hull(struct hull *hull)
{
    free(hull->chain[0]);
    free(hull->chain[1]);
}

static enum tri_status find_input_hull(struct border *b)
{
    const struct tri_pslg *input = b->c->input;
    struct tri_point *points = tri_check_array(input->n_points, sizeof *points);
    int32_t n = 0;
    for (int32_t i = 0; points != NULL && i < input->n_points; i++) {
        struct tri_point p = {input->points[2 * (size_t)i], input->points[2 * (size_t)i + 1]};
        if (tri_is_exact_point(p))
            points[n++] = p;
    }
    return make_hull(points, n, &b->hull);
}

static bool is_near(struct tri_point a, struct tri_point b, struct tri_point p, double tolerance)
{
    double x = b.x - a.x, y = b.y - a.y;
    return fabs(x * (p.y - a.y) - y * (p.x - a.x)) <= tolerance * sqrt(x * x + y * y);
}

/* Do both points lie along the same edge of the chain? */
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

/* Does the edge lie along the hull, so that the user may have forgotten the option that allows it? */
static bool may_be_hull(struct border *b, int32_t s)
{
    return (b->hull.chain[0] || find_input_hull(b) == TRI_OK) && is_along_hull(b, s);
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
                        : may_be_hull(b, s) ? ", but along the convex hull: was it made with -c (keep-hull)?" : "");
    }
}

enum tri_status tri_check_border(struct checker *c)
{
    struct border b = {.c = c};
    const struct tri_check_options *o = c->options;
    bool listed = check_is_listed(c), segments = c->input->n_segments > 0;
    if (o->border == TRI_CHECK_BORDER_ANY || (segments && !listed)) /* the segments are not known */
        return TRI_OK;
    bool hull = !segments || o->convex || o->border == TRI_CHECK_BORDER_HULL;
    enum tri_status status = hull ? find_input_hull(&b) : TRI_OK;
    if (status == TRI_OK) {
        tri_check_begin(c, TRI_CHECK_BORDER);
        check_border(&b, hull);
    }
    free_hull(&b.hull);
    return status;
}

/* --- convexity
 *
 * A simple closed boundary visits the corners of its hull in order. Between two corners it must lie along the hull
 * edge that joins them. Vertices on hull edges are rounded to either side, so the tolerance is twice that of
 * segments. */

enum { SEVERAL = -2 };

/* The boundary as a cycle of vertices. */
struct loop {
    struct checker *c;
    int32_t n;             /* number of vertices */
    int32_t *from;         /* [n_frame] boundary edge that starts at the vertex; -1: none; SEVERAL: more than one */
    int32_t *vertex;       /* [n] counter-clockwise */
    struct hull hull; /* hull of these vertices */
};

static void list_boundary(struct loop *l)
{
    const struct checker *c = l->c;
    for (int32_t v = 0; v < c->n_frame; v++)
        l->from[v] = -1;
    for (int32_t e = 0; e < c->boundary.n; e++) {
        int32_t v = c->border[e][0];
        l->from[v] = l->from[v] == -1 ? e : SEVERAL;
    }
}

static void fault_at(struct loop *l, int32_t v)
{
    tri_check_fault(l->c, TRI_CHECK_HULL, "the boundary is not convex at vertex %ld", check_frame_vertex(l->c, v));
}

/* Collects the cycle. Returns false if the boundary is not a single cycle. */
static bool walk_loop(struct loop *l)
{
    const struct checker *c = l->c;
    int32_t e = 0;
    do {
        l->vertex[l->n++] = c->border[e][0];
        int32_t next = l->from[c->border[e][1]];
        if (next < 0) {
            fault_at(l, c->border[e][1]);
            return false;
        }
        e = next;
    } while (e != 0 && l->n < c->boundary.n);
    if (e == 0 && l->n == c->boundary.n)
        return true;
    tri_check_fault(l->c, TRI_CHECK_HULL, "the boundary has %lld edges, but its loop through vertex %ld only %ld",
                    (long long)c->boundary.n, check_frame_vertex(c, c->border[0][0]), (long)l->n);
    return false;
}

static enum tri_status find_loop_hull(struct loop *l)
{
    struct tri_point *points = tri_check_array(l->n, sizeof *points);
    for (int32_t i = 0; points != NULL && i < l->n; i++)
        points[i] = check_point(l->c, l->vertex[i]);
    return make_hull(points, l->n, &l->hull);
}

static bool is_corner(const struct loop *l, int32_t place)
{
    const struct tri_point p = check_point(l->c, l->vertex[place]);
    const struct hull *h = &l->hull;
    return bsearch(&p, h->chain[0], (size_t)h->n[0], sizeof p, compare_points) != NULL ||
           bsearch(&p, h->chain[1], (size_t)h->n[1], sizeof p, compare_points) != NULL;
}

static int32_t next_corner(const struct loop *l, int32_t place)
{
    do
        place = (place + 1) % l->n;
    while (!is_corner(l, place));
    return place;
}

/* Tests whether the vertices after `place`, up to the next hull corner, are close to the hull edge. Returns the
 * index of that corner, or -1 if they are not. */
static int32_t follow_edge(struct loop *l, int32_t place)
{
    int32_t next = next_corner(l, place);
    struct tri_point a = check_point(l->c, l->vertex[place]), b = check_point(l->c, l->vertex[next]);
    double x = b.x - a.x, y = b.y - a.y, most = 2 * l->c->tolerance * sqrt(x * x + y * y);
    for (int32_t i = (place + 1) % l->n; i != next; i = (i + 1) % l->n) {
        struct tri_point p = check_point(l->c, l->vertex[i]);
        if (fabs(x * (p.y - a.y) - y * (p.x - a.x)) > most) {
            fault_at(l, l->vertex[i]);
            return -1;
        }
    }
    return next;
}

static enum tri_status judge(struct loop *l)
{
    tri_check_begin(l->c, TRI_CHECK_HULL);
    list_boundary(l);
    if (l->c->boundary.n == 0 || !walk_loop(l))
        return TRI_OK;
    enum tri_status status = find_loop_hull(l);
    int32_t first = status == TRI_OK ? next_corner(l, 0) : -1, place = first;
    while (place >= 0 && (place = follow_edge(l, place)) != first) {
    }
    return status;
}

enum tri_status tri_check_hull(struct checker *c)
{
    struct loop l = {.c = c, .from = tri_check_array(c->n_frame, sizeof *l.from),
                     .vertex = tri_check_array(c->boundary.n, sizeof *l.vertex)};
    enum tri_status status = l.from != NULL && l.vertex != NULL ? judge(&l) : TRI_NO_MEMORY;
    free_hull(&l.hull);
    free(l.from);
    free(l.vertex);
    return status;
}
