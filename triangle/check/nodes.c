/* Midside nodes of triangles with six nodes.
 *
 * Each lies at the rounded midpoint of its edge, computed from one end or the other. It has the marker of its
 * subsegment (0 on other edges) and the mean of the ends' attributes. Two adjacent triangles must share the node of
 * their edge. Nodes of different edges lie at different positions, so it suffices to compare the number of nodes
 * with the number of edges.
 *
 * Triangles are read again in slices, with the data of the points that they refer to. */
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { SLICE = 1 << 12 }; /* triangles */

struct subsegment {
    int64_t ends[2]; /* ascending */
    int32_t marker;  /* marker of the subsegment */
};

/* A slice of triangles, with the data of the points that they refer to. */
struct slice {
    int64_t first, n_triangles; /* triangles first .. first + n_triangles - 1 */
    int64_t *corners, *middles; /* [n_triangles][3] */
    int64_t n_named, *named;    /* [n_named] points in the slice, ascending */
    double *places;             /* [n_named][2] positions */
    int32_t *markers;           /* [n_named] markers, if they are checked */
    double *attributes;         /* [n_named][n_attributes] */
};

struct trial {
    struct checker *c;
    int64_t n_nodes;                /* points including midside nodes */
    int32_t n_attributes;           /* attributes per point; 0: none are checked */
    bool markers;                   /* true: markers are checked */
    uint8_t *is_named;              /* [n_nodes - n_points] 1: the node belongs to an edge of some triangle */
    struct subsegment *subsegments; /* [n_subsegments] sorted by ends */
    int64_t n_subsegments;          /* number of subsegments */
    struct slice slice;             /* current slice */
};

static int compare_subsegments(const void *left, const void *right)
{
    const struct subsegment *a = left, *b = right;
    int order = tri_check_compare_numbers(&a->ends[0], &b->ends[0]);
    return order != 0 ? order : tri_check_compare_numbers(&a->ends[1], &b->ends[1]);
}

static struct subsegment subsegment_of(int64_t a, int64_t b, int32_t marker)
{
    return (struct subsegment){{a < b ? a : b, a < b ? b : a}, marker};
}

static void list_subsegments(struct trial *t)
{
    const struct checker *c = t->c;
    for (int64_t s = 0; s < t->n_subsegments; s++)
        t->subsegments[s] = subsegment_of(c->listed[2 * s], c->listed[2 * s + 1], c->segment_markers[s]);
    qsort(t->subsegments, (size_t)t->n_subsegments, sizeof *t->subsegments, compare_subsegments);
}

static int32_t marker_of(const struct trial *t, int64_t a, int64_t b)
{
    const struct subsegment wanted = subsegment_of(a, b, 0);
    const struct subsegment *found = bsearch(&wanted, t->subsegments, (size_t)t->n_subsegments,
                                             sizeof *t->subsegments, compare_subsegments);
    return found != NULL ? found->marker : 0;
}

/* --- a slice */

static bool is_node(const struct trial *t, int64_t m) { return m >= t->c->n_points && m < t->n_nodes; }

static void list_named(struct trial *t)
{
    struct slice *s = &t->slice;
    int64_t n = 0;
    for (int64_t i = 0; i < 3 * s->n_triangles; i++) {
        s->named[n++] = s->corners[i];
        if (is_node(t, s->middles[i]))
            s->named[n++] = s->middles[i];
    }
    s->n_named = tri_check_distinct(s->named, n);
}

static enum tri_status read_named(struct trial *t, enum tri_check_array array, size_t bytes, void *out)
{
    return tri_check_gather(t->c, array, t->slice.named, t->slice.n_named, bytes, out);
}

static enum tri_status read_slice(struct trial *t)
{
    struct slice *s = &t->slice;
    enum tri_status status = tri_check_read(t->c, TRI_CHECK_CORNERS, s->first, s->n_triangles, s->corners);
    status = status ? status : tri_check_read(t->c, TRI_CHECK_MIDDLES, s->first, s->n_triangles, s->middles);
    if (status != TRI_OK)
        return status;
    list_named(t);
    status = read_named(t, TRI_CHECK_POINTS, 2 * sizeof *s->places, s->places);
    if (status == TRI_OK && t->markers)
        status = read_named(t, TRI_CHECK_POINT_MARKERS, sizeof *s->markers, s->markers);
    if (status == TRI_OK && t->n_attributes > 0)
        status = read_named(t, TRI_CHECK_POINT_ATTRIBUTES, (size_t)t->n_attributes * sizeof *s->attributes,
                            s->attributes);
    return status;
}

/* Returns the index of v in the arrays of the slice. */
static size_t find(const struct slice *s, int64_t v)
{
    const int64_t *at = bsearch(&v, s->named, (size_t)s->n_named, sizeof v, tri_check_compare_numbers);
    return (size_t)(at - s->named);
}

/* --- checks */

/* Is m the midpoint of a and b, rounded from either end? */
static bool is_half_way(double m, double a, double b)
{
    return m == tri_round_coordinate(a + 0.5 * (b - a)) || m == tri_round_coordinate(b + 0.5 * (a - b));
}

static bool is_between(double m, double a, double b) { return m == a + 0.5 * (b - a) || m == b + 0.5 * (a - b); }

static void judge_attributes(struct trial *t, int64_t m, const int64_t ends[2])
{
    const struct slice *s = &t->slice;
    const size_t n = (size_t)t->n_attributes;
    const double *at[3] = {s->attributes + n * find(s, m), s->attributes + n * find(s, ends[0]),
                           s->attributes + n * find(s, ends[1])};
    for (size_t k = 0; k < n; k++)
        if (!is_between(at[0][k], at[1][k], at[2][k]))
            tri_check_fault(t->c, TRI_CHECK_VERTEX_ATTRIBUTES,
                            "attribute %zu of node %ld is not the mean of those at the ends of edge %ld-%ld",
                            k, check_number(t->c, m), check_number(t->c, ends[0]), check_number(t->c, ends[1]));
}

static void judge_node(struct trial *t, int64_t triangle, int64_t m, const int64_t ends[2])
{
    struct checker *c = t->c;
    const struct slice *s = &t->slice;
    const long a = check_number(c, ends[0]), b = check_number(c, ends[1]);
    if (!is_node(t, m)) {
        tri_check_fault(c, TRI_CHECK_NODES, "triangle %ld has no midside node on edge %ld-%ld",
                        check_number(c, triangle), a, b);
        return;
    }
    const double *p = s->places + 2 * find(s, m), *u = s->places + 2 * find(s, ends[0]),
                 *v = s->places + 2 * find(s, ends[1]);
    t->is_named[m - c->n_points] = 1;
    if (!is_half_way(p[0], u[0], v[0]) || !is_half_way(p[1], u[1], v[1]))
        tri_check_fault(c, TRI_CHECK_NODES, "node %ld of triangle %ld is not at the midpoint of edge %ld-%ld",
                        check_number(c, m), check_number(c, triangle), a, b);
    if (t->markers && s->markers[find(s, m)] != marker_of(t, ends[0], ends[1]))
        tri_check_fault(c, TRI_CHECK_NODES, "node %ld of edge %ld-%ld has marker %ld instead of %ld",
                        check_number(c, m), a, b, (long)s->markers[find(s, m)], (long)marker_of(t, ends[0], ends[1]));
    if (t->n_attributes > 0)
        judge_attributes(t, m, ends);
}

static enum tri_status judge_slice(struct trial *t)
{
    const struct slice *s = &t->slice;
    enum tri_status status = read_slice(t);
    for (int64_t i = 0; i < 3 * s->n_triangles && status == TRI_OK; i++) {
        const int64_t *corner = s->corners + i / 3 * 3;
        judge_node(t, s->first + i / 3, s->middles[i], (int64_t[2]){corner[(i + 1) % 3], corner[(i + 2) % 3]});
    }
    return status;
}

static void count_nodes(struct trial *t)
{
    struct checker *c = t->c;
    int64_t n = 0;
    for (int64_t i = 0; i < t->n_nodes - c->n_points; i++)
        n += t->is_named[i];
    if (check_good(c, TRI_CHECK_EDGES) && check_good(c, TRI_CHECK_NODES) && n != c->report->n_edges)
        tri_check_fault(c, TRI_CHECK_NODES, "there are %lld midside nodes and %lld edges", (long long)n,
                        (long long)c->report->n_edges);
}

/* --- the whole mesh */

static bool get_room(struct trial *t)
{
    struct slice *s = &t->slice;
    const size_t row = (size_t)t->n_attributes * sizeof *s->attributes;
    t->is_named = tri_check_zeros(t->n_nodes - t->c->n_points, sizeof *t->is_named);
    t->subsegments = tri_check_array(t->n_subsegments, sizeof *t->subsegments);
    s->corners = tri_check_array(3 * SLICE, sizeof *s->corners);
    s->middles = tri_check_array(3 * SLICE, sizeof *s->middles);
    s->named = tri_check_array(6 * SLICE, sizeof *s->named);
    s->places = tri_check_array(6 * SLICE, 2 * sizeof *s->places);
    s->markers = tri_check_array(6 * SLICE, sizeof *s->markers);
    s->attributes = tri_check_array(6 * SLICE, row > 0 ? row : 1);
    return t->is_named != NULL && t->subsegments != NULL && s->corners != NULL && s->middles != NULL &&
           s->named != NULL && s->places != NULL && s->markers != NULL && s->attributes != NULL;
}

static void release(struct trial *t)
{
    void *arrays[] = {t->is_named, t->subsegments, t->slice.corners, t->slice.middles, t->slice.named,
                      t->slice.places, t->slice.markers, t->slice.attributes};
    for (size_t i = 0; i < sizeof arrays / sizeof *arrays; i++)
        free(arrays[i]);
}

enum tri_status tri_check_nodes(struct checker *c)
{
    if (!check_is_given(c, TRI_CHECK_MIDDLES))
        return TRI_OK;
    struct trial t = {.c = c, .n_nodes = c->source->n_nodes > c->n_points ? c->source->n_nodes : c->n_points};
    t.markers = check_is_given(c, TRI_CHECK_POINT_MARKERS) && check_is_given(c, TRI_CHECK_SEGMENT_MARKERS);
    t.n_subsegments = t.markers ? c->source->n_segments : 0;
    t.n_attributes = check_is_given(c, TRI_CHECK_POINT_ATTRIBUTES) ? c->source->n_point_attributes : 0;
    enum tri_status status = get_room(&t) ? TRI_OK : TRI_NO_MEMORY;
    tri_check_begin(c, TRI_CHECK_NODES);
    if (status == TRI_OK)
        list_subsegments(&t);
    for (int64_t first = 0; first < c->n_triangles && status == TRI_OK; first += SLICE) {
        t.slice.first = first;
        t.slice.n_triangles = c->n_triangles - first < SLICE ? c->n_triangles - first : SLICE;
        status = judge_slice(&t);
    }
    if (status == TRI_OK)
        count_nodes(&t);
    release(&t);
    return status;
}
