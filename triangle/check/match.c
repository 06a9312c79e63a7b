/* Half-edges without other side in their part: matched across parts, when all have been seen.
 *
 * Sorted by edge, the two sides of one stand side by side. One alone is a boundary edge; more than two, or two on the
 * same side, are faults, and count as boundary edges, too. */
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/check/store.h"

static int compare_edges(const struct check_open *a, const struct check_open *b)
{
    int64_t low = a->from < a->to ? a->from : a->to, other = b->from < b->to ? b->from : b->to;
    int64_t high = a->from + a->to - low, far = b->from + b->to - other;
    return low != other ? (low < other ? -1 : 1) : (high > far) - (high < far);
}

static int compare_opens(const void *left, const void *right)
{
    const struct check_open *a = left, *b = right;
    int order = compare_edges(a, b);
    return order != 0 ? order : (a->half_edge > b->half_edge) - (a->half_edge < b->half_edge);
}

static int compare_half_edges(const void *left, const void *right)
{
    const struct check_boundary_edge *a = left, *b = right;
    return (a->half_edge > b->half_edge) - (a->half_edge < b->half_edge);
}

/* The first of them tells, as all do. */
static void tell_bad(struct checker *c, const struct check_open *at, int64_t n)
{
    int64_t same = 0;
    for (int64_t i = 0; i < n; i++)
        same += at[i].from == at->from;
    c->at = at->half_edge;
    tri_check_fault(c, TRI_CHECK_EDGES, "%ld triangles lie on the %s side of edge %ld-%ld of triangle %ld",
                    (long)(same > 1 ? same : n - same), same > 1 ? "same" : "other", check_number(c, at->from),
                    check_number(c, at->to), check_number(c, at->half_edge / 3));
    c->at = 0;
    c->report->item[TRI_CHECK_EDGES].count += n - 1;
}

static enum tri_status keep(struct checker *c, const struct check_open *e)
{
    struct check_boundary *b = &c->boundary;
    if (!tri_grow_far(&b->at, &b->room, b->n + 1, sizeof *b->at))
        return TRI_NO_MEMORY;
    b->at[b->n++] = (struct check_boundary_edge){e->from, e->to, e->half_edge, e->attribute, e->constrained};
    return TRI_OK;
}

/* The half-edges of one edge. */
static enum tri_status match_edge(struct checker *c, const struct check_open *at, int64_t n)
{
    if (n == 2 && at[0].from == at[1].to) {
        tri_check_matched(c, &at[0], &at[1]);
        return TRI_OK;
    }
    if (n == 1)
        tri_check_matched(c, at, NULL);
    else
        tell_bad(c, at, n);
    enum tri_status status = TRI_OK;
    for (int64_t i = 0; i < n && status == TRI_OK; i++)
        status = keep(c, &at[i]);
    return status;
}

static enum tri_status match_all(struct checker *c, struct check_open *at, int64_t n)
{
    enum tri_status status = TRI_OK;
    if (n > 1)
        qsort(at, (size_t)n, sizeof *at, compare_opens);
    for (int64_t i = 0, next; i < n && status == TRI_OK; i = next) {
        for (next = i + 1; next < n && compare_edges(&at[i], &at[next]) == 0; next++) {
        }
        status = match_edge(c, at + i, next - i);
    }
    return status;
}

static void count(struct checker *c)
{
    struct tri_check_report *r = c->report;
    int64_t first;
    r->n_used_points = tri_check_count(c, c->n_points, check_is_used, &first);
    r->n_boundary_edges = c->boundary.n;
    r->n_edges = (3 * c->n_triangles + c->boundary.n) / 2;
    for (int64_t i = 0; i < c->boundary.n; i++) {
        c->state[c->boundary.at[i].from] |= CHECK_BOUNDARY;
        c->state[c->boundary.at[i].to] |= CHECK_BOUNDARY;
    }
}

enum tri_status tri_check_match(struct checker *c)
{
    tri_check_begin(c, TRI_CHECK_EDGES);
    tri_check_release_part(c); /* room for the others; it comes back when asked for */
    enum tri_status status = tri_check_store_drain(c, match_all);
    if (status != TRI_OK)
        return status;
    if (c->boundary.n > 1)
        qsort(c->boundary.at, (size_t)c->boundary.n, sizeof *c->boundary.at, compare_half_edges);
    count(c);
    return c->boundary.n > INT32_MAX / 2 ? TRI_TOO_LARGE : TRI_OK;
}
