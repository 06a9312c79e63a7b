/* Subsegments: which half-edges are constrained, and which subsegments meet at a vertex.
 *
 * Where the mesh comes without a list, its boundary edges are the subsegments; then nothing can be wrong with them. */
#include <assert.h>

#include "triangle/check/internal.h"

static enum tri_status take_boundary(struct checker *c)
{
    c->own_segments = tri_check_array(2 * c->report->n_boundary_edges, sizeof *c->own_segments);
    if (c->own_segments == NULL)
        return TRI_NO_MEMORY;
    if (c->report->n_boundary_edges > INT32_MAX / 2)
        return TRI_TOO_LARGE;
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] >= 0)
            continue;
        c->own_segments[2 * (size_t)c->n_segments] = check_org(c, h);
        c->own_segments[2 * (size_t)c->n_segments + 1] = check_dest(c, h);
        c->n_segments++;
    }
    c->segments = c->own_segments;
    return TRI_OK;
}

static void constrain(struct checker *c, int32_t s)
{
    int32_t a = c->segments[2 * (size_t)s], b = c->segments[2 * (size_t)s + 1];
    struct check_edge e = tri_check_find_edge(c, a, b);
    int32_t h = e.there, g = e.back;
    int32_t any = h >= 0 ? h : g;
    if (c->mesh->segments == NULL) {
        assert(any >= 0);
    } else if (any < 0) {
        tri_check_fault(c, TRI_CHECK_SUBSEGMENTS, "subsegment %ld (%ld-%ld) is not an edge of the mesh",
                        check_number(c, s), check_number(c, a), check_number(c, b));
    } else if (check_is_constrained(c, any)) {
        tri_check_fault(c, TRI_CHECK_SUBSEGMENTS, "subsegment %ld (%ld-%ld) is listed twice", check_number(c, s),
                        check_number(c, a), check_number(c, b));
    }
    if (h >= 0)
        c->constrained[h >> 3] |= (uint8_t)(1u << (h & 7));
    if (g >= 0)
        c->constrained[g >> 3] |= (uint8_t)(1u << (g & 7));
}

static enum tri_status group_by_vertex(struct checker *c)
{
    int32_t n = c->mesh->n_points;
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
    for (int32_t i = 0; i < 2 * c->n_segments; i++) { /* as in group_corners */
        if (check_is_listed_well(c, i >> 1))
            c->fan[c->fan_first[c->segments[i]]++] = i;
    }
    for (int32_t i = n; i > 0; i--)
        c->fan_first[i] = c->fan_first[i - 1];
    c->fan_first[0] = 0;
    return TRI_OK;
}

static bool is_unlisted(const struct checker *c, int32_t h)
{
    return c->link[h] < 0 && !check_is_constrained(c, h);
}

static void tell_unlisted(struct checker *c, int32_t h)
{
    tri_check_fault(c, TRI_CHECK_BOUNDARY, "boundary edge %ld-%ld of triangle %ld is not a subsegment",
                    check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)), check_number(c, h / 3));
}

enum tri_status tri_check_subsegments(struct checker *c)
{
    c->constrained = tri_check_zeros(c->n_half_edges / 8, 1);
    if (c->constrained == NULL)
        return TRI_NO_MEMORY;
    c->segments = c->mesh->segments;
    c->n_segments = c->segments != NULL ? c->mesh->n_segments : 0;
    if (c->segments == NULL) {
        enum tri_status status = take_boundary(c);
        if (status != TRI_OK)
            return status;
    } else {
        tri_check_begin(c, TRI_CHECK_SUBSEGMENTS);
    }
    for (int32_t s = 0; s < c->n_segments; s++) {
        if (check_is_listed_well(c, s)) {
            constrain(c, s);
        } else {
            tri_check_fault(c, TRI_CHECK_SUBSEGMENTS,
                            "subsegment %ld has an end that is not a vertex, or two equal ends",
                            check_number(c, s));
        }
    }
    if (c->mesh->segments != NULL)
        tri_check_each(c, TRI_CHECK_BOUNDARY, c->n_half_edges, is_unlisted, tell_unlisted);
    return group_by_vertex(c);
}
