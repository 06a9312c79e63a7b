/* Subsegments, and the frame: the vertices of subsegments, of the boundary and of the input.
 *
 * If the mesh has no list of subsegments, its boundary edges are used, and nothing about them needs checking. */
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/check/internal.h"

enum tri_status tri_check_list_segments(struct checker *c)
{
    int64_t n = c->source->n_segments;
    if (!check_is_listed(c))
        return TRI_OK;
    c->listed = tri_check_array(2 * n, sizeof *c->listed);
    c->sides = tri_check_array(n, sizeof *c->sides);
    if (c->listed == NULL || c->sides == NULL)
        return TRI_NO_MEMORY;
    enum tri_status status = tri_check_read(c, TRI_CHECK_SEGMENT_ENDS, 0, n, c->listed);
    for (int64_t s = 0; s < n && status == TRI_OK; s++) {
        int64_t *v = c->listed + 2 * s;
        c->sides[s][0] = c->sides[s][1] = (struct check_side){-1, 0};
        if (v[0] < 0 || v[0] >= c->n_points || v[1] < 0 || v[1] >= c->n_points || v[0] == v[1])
            v[0] = v[1] = -1;
    }
    if (status != TRI_OK || !check_is_given(c, TRI_CHECK_SEGMENT_MARKERS))
        return status;
    c->segment_markers = tri_check_array(n, sizeof *c->segment_markers);
    return c->segment_markers == NULL ? TRI_NO_MEMORY
                                      : tri_check_read(c, TRI_CHECK_SEGMENT_MARKERS, 0, n, c->segment_markers);
}

/* --- vertices of the frame */

static int64_t take_ends(int64_t *out, const int64_t *ends, int64_t n)
{
    int64_t k = 0;
    for (int64_t i = 0; i < n; i++) {
        if (ends[i] >= 0)
            out[k++] = ends[i];
    }
    return k;
}

static enum tri_status list_vertices(struct checker *c)
{
    int64_t n_listed = check_is_listed(c) ? 2 * c->source->n_segments : 0;
    int64_t n_input = c->input != NULL ? c->input->n_points : 0;
    int64_t *v = tri_check_array(n_listed + n_input + 2 * c->boundary.n, sizeof *v), n;
    c->vertex = v;
    if (v == NULL)
        return TRI_NO_MEMORY;
    n = take_ends(v, c->listed, n_listed);
    n += take_ends(v + n, c->found, n_input);
    for (int64_t i = 0; i < c->boundary.n; i++) {
        v[n++] = c->boundary.at[i].from;
        v[n++] = c->boundary.at[i].to;
    }
    n = tri_check_distinct(v, n);
    if (n > INT32_MAX / 2)
        return TRI_TOO_LARGE;
    c->n_frame = (int32_t)n;
    return tri_resize(&c->vertex, (size_t)n + 1, sizeof *v) ? TRI_OK : TRI_NO_MEMORY; /* shrinks the array to the
                                                                                         remaining vertices */
}

static enum tri_status read_places(struct checker *c)
{
    const size_t bytes = 2 * sizeof *c->points;
    c->points = tri_check_array(c->n_frame, bytes);
    return c->points == NULL ? TRI_NO_MEMORY
                             : tri_check_gather(c, TRI_CHECK_POINTS, c->vertex, c->n_frame, bytes, c->points);
}

/* Returns the frame number of a vertex, or -1 if it is not in the frame. */
int32_t tri_check_in_frame(const struct checker *c, int64_t v)
{
    const int64_t *found = bsearch(&v, c->vertex, (size_t)c->n_frame, sizeof v, tri_check_compare_numbers);
    return found != NULL ? (int32_t)(found - c->vertex) : -1;
}

/* Converts subsegments and boundary edges to vertices of the frame. */
static enum tri_status translate(struct checker *c)
{
    bool listed = check_is_listed(c);
    c->n_segments = (int32_t)(listed ? c->source->n_segments : c->boundary.n);
    c->border = tri_check_array(c->boundary.n, sizeof *c->border);
    c->segments = tri_check_array(2 * (int64_t)c->n_segments, sizeof *c->segments);
    if (!listed)
        c->sides = tri_check_array(c->n_segments, sizeof *c->sides);
    c->twin = tri_check_array(c->input != NULL ? c->input->n_points : 0, sizeof *c->twin);
    if (c->border == NULL || c->segments == NULL || c->sides == NULL || c->twin == NULL)
        return TRI_NO_MEMORY;
    for (int64_t i = 0; i < c->boundary.n; i++) {
        c->border[i][0] = tri_check_in_frame(c, c->boundary.at[i].from);
        c->border[i][1] = tri_check_in_frame(c, c->boundary.at[i].to);
    }
    for (int32_t s = 0; s < c->n_segments; s++) {
        for (int k = 0; k < 2; k++)
            c->segments[2 * s + k] = listed ? tri_check_in_frame(c, c->listed[2 * s + k]) : c->border[s][k];
        if (!listed) {
            c->sides[s][0] = (struct check_side){c->boundary.at[s].half_edge, 0};
            c->sides[s][1] = (struct check_side){-1, 0};
        }
    }
    for (int32_t i = 0; c->input != NULL && i < c->input->n_points; i++)
        c->twin[i] = tri_check_in_frame(c, c->found[i]);
    free(c->listed);
    c->listed = NULL;
    return TRI_OK;
}

enum tri_status tri_check_frame(struct checker *c)
{
    enum tri_status status = list_vertices(c);
    status = status == TRI_OK ? read_places(c) : status;
    return status == TRI_OK ? translate(c) : status;
}

/* --- subsegments are edges and listed once; the boundary consists of subsegments */

static int64_t least_half_edge(const struct checker *c, int32_t s)
{
    int64_t there = c->sides[s][0].half_edge, back = c->sides[s][1].half_edge;
    return there >= 0 && (back < 0 || there < back) ? there : back;
}

struct listing { /* a mesh edge and the subsegment that lists it */
    int64_t edge;
    int32_t s;
};

static int compare_listings(const void *left, const void *right)
{
    const struct listing *a = left, *b = right;
    if (a->edge != b->edge)
        return a->edge < b->edge ? -1 : 1;
    return (a->s > b->s) - (a->s < b->s);
}

/* Sets twice[s] if an earlier subsegment lists the same edge. */
static enum tri_status find_repeated(const struct checker *c, uint8_t *twice)
{
    struct listing *list = tri_check_array(c->n_segments, sizeof *list);
    if (list == NULL)
        return TRI_NO_MEMORY;
    for (int32_t s = 0; s < c->n_segments; s++)
        list[s] = (struct listing){check_is_listed_well(c, s) ? least_half_edge(c, s) : -1, s};
    qsort(list, (size_t)c->n_segments, sizeof *list, compare_listings);
    for (int32_t i = 1; i < c->n_segments; i++)
        twice[list[i].s] = list[i].edge >= 0 && list[i].edge == list[i - 1].edge;
    free(list);
    return TRI_OK;
}

static void judge_listing(struct checker *c, int32_t s, bool twice)
{
    long number = check_number(c, s);
    if (!check_is_listed_well(c, s)) {
        tri_check_fault(c, TRI_CHECK_SUBSEGMENTS,
                        "subsegment %ld has an end that is not a vertex, or two equal ends", number);
        return;
    }
    long a = check_frame_vertex(c, c->segments[2 * s]), b = check_frame_vertex(c, c->segments[2 * s + 1]);
    if (least_half_edge(c, s) < 0)
        tri_check_fault(c, TRI_CHECK_SUBSEGMENTS, "subsegment %ld (%ld-%ld) is not an edge of the mesh", number, a, b);
    else if (twice)
        tri_check_fault(c, TRI_CHECK_SUBSEGMENTS, "subsegment %ld (%ld-%ld) is listed twice", number, a, b);
}

static void judge_boundary(struct checker *c)
{
    tri_check_begin(c, TRI_CHECK_BOUNDARY);
    for (int64_t i = 0; i < c->boundary.n; i++) {
        const struct check_boundary_edge *e = &c->boundary.at[i];
        if (!e->constrained)
            tri_check_fault(c, TRI_CHECK_BOUNDARY, "boundary edge %ld-%ld of triangle %ld is not a subsegment",
                            check_number(c, e->from), check_number(c, e->to), check_number(c, e->half_edge / 3));
    }
}

static enum tri_status judge_listings(struct checker *c)
{
    uint8_t *twice = tri_check_zeros(c->n_segments, 1);
    enum tri_status status = twice == NULL ? TRI_NO_MEMORY : find_repeated(c, twice);
    tri_check_begin(c, TRI_CHECK_SUBSEGMENTS);
    for (int32_t s = 0; s < c->n_segments && status == TRI_OK; s++)
        judge_listing(c, s, twice[s]);
    free(twice);
    if (status == TRI_OK)
        judge_boundary(c);
    return status;
}

static enum tri_status group_by_vertex(struct checker *c)
{
    int32_t n = c->n_frame;
    c->fan_first = tri_check_zeros((int64_t)n + 1, sizeof *c->fan_first);
    c->fan = tri_check_array(2 * (int64_t)c->n_segments, sizeof *c->fan);
    if (c->fan_first == NULL || c->fan == NULL)
        return TRI_NO_MEMORY;
    for (int32_t i = 0; i < 2 * c->n_segments; i++) {
        if (check_is_listed_well(c, i >> 1))
            c->fan_first[c->segments[i] + 1]++;
    }
    for (int32_t i = 0; i < n; i++)
        c->fan_first[i + 1] += c->fan_first[i];
    for (int32_t i = 0; i < 2 * c->n_segments; i++) { /* grouped as in edges.c */
        if (check_is_listed_well(c, i >> 1))
            c->fan[c->fan_first[c->segments[i]]++] = i;
    }
    memmove(c->fan_first + 1, c->fan_first, (size_t)n * sizeof *c->fan_first);
    c->fan_first[0] = 0;
    return TRI_OK;
}

enum tri_status tri_check_subsegments(struct checker *c)
{
    enum tri_status status = check_is_listed(c) ? judge_listings(c) : TRI_OK;
    return status == TRI_OK ? group_by_vertex(c) : status;
}
