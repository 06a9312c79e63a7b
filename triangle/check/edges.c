/* Edges: which half-edges are the two sides of one edge, and whether each has one other side at most.
 *
 * Corners are grouped by vertex (counting sort), so that the half-edges between a and b are found by a scan of the
 * triangles at one of them. Scanning the vertex of fewer triangles costs O(n) in all: the sum over the edges of the
 * smaller degree is linear in a planar graph (Chiba & Nishizeki 1985). */
#include <stdlib.h>

#include "triangle/check/internal.h"

static enum tri_status group_corners(struct checker *c)
{
    const int32_t *v = c->mesh->triangles;
    int32_t n = c->mesh->n_points;
    c->first = tri_check_zeros((int64_t)n + 1, sizeof *c->first);
    c->corner = tri_check_array(c->n_half_edges, sizeof *c->corner);
    if (c->first == NULL || c->corner == NULL)
        return TRI_NO_MEMORY;
    for (int32_t h = 0; h < c->n_half_edges; h++)
        c->first[v[h] + 1]++;
    for (int32_t i = 0; i < n; i++)
        c->first[i + 1] += c->first[i];
    /* While a group is filled its start moves to its end, which is the start of the next one: shift them back. */
    for (int32_t h = 0; h < c->n_half_edges; h++)
        c->corner[c->first[v[h]]++] = (struct check_corner){h, v[check_next(h)], v[check_prev(h)]};
    for (int32_t i = n; i > 0; i--)
        c->first[i] = c->first[i - 1];
    c->first[0] = 0;
    return TRI_OK;
}

struct check_edge tri_check_find_edge(const struct checker *c, int32_t a, int32_t b)
{
    struct check_edge e = {-1, -1, 0, 0};
    bool at_a = c->first[a + 1] - c->first[a] <= c->first[b + 1] - c->first[b];
    int32_t at = at_a ? a : b, other = at_a ? b : a;
    for (int32_t i = c->first[at]; i < c->first[at + 1]; i++) {
        const struct check_corner *k = &c->corner[i];
        int32_t out = k->next == other ? check_prev(k->name) : -1, in = k->prev == other ? check_next(k->name) : -1;
        int32_t there = at_a ? out : in, back = at_a ? in : out;
        if (there >= 0)
            e.there = there, e.n_there++;
        if (back >= 0)
            e.back = back, e.n_back++;
    }
    return e;
}

static void pair_half_edge(struct checker *c, int32_t h)
{
    int32_t a = check_org(c, h), b = check_dest(c, h);
    struct check_edge e = tri_check_find_edge(c, a, b);
    if (e.n_there == 1 && e.n_back <= 1) {
        c->link[h] = e.back;
        if (e.back >= 0)
            c->link[e.back] = h;
        return;
    }
    tri_check_fault(c, TRI_CHECK_EDGES, "%d triangles lie on the %s side of edge %ld-%ld of triangle %ld",
                    e.n_there > 1 ? e.n_there : e.n_back, e.n_there > 1 ? "same" : "other", check_number(c, a),
                    check_number(c, b), check_number(c, h / 3));
}

static void compare_neighbors(struct checker *c)
{
    tri_check_begin(c, TRI_CHECK_NEIGHBORS);
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        int32_t expected = c->link[h] < 0 ? -1 : c->link[h] / 3, given = c->mesh->neighbors[h];
        if (given == expected)
            continue;
        tri_check_fault(c, TRI_CHECK_NEIGHBORS,
                        "triangle %ld: neighbor across edge %ld-%ld is given as %ld, but is %ld",
                        check_number(c, h / 3), check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)),
                        given < 0 ? -1L : check_number(c, given), expected < 0 ? -1L : check_number(c, expected));
    }
}

enum tri_status tri_check_edges(struct checker *c)
{
    enum tri_status status = group_corners(c);
    if (status != TRI_OK)
        return status;
    c->link = tri_check_array(c->n_half_edges, sizeof *c->link);
    if (c->link == NULL)
        return TRI_NO_MEMORY;
    tri_check_begin(c, TRI_CHECK_EDGES);
    for (int32_t h = 0; h < c->n_half_edges; h++)
        c->link[h] = -2;
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] == -2)
            pair_half_edge(c, h);
    }
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] < 0)
            c->link[h] = -1, c->report->n_boundary_edges++;
    }
    c->report->n_edges = ((int64_t)c->n_half_edges + c->report->n_boundary_edges) / 2;
    for (int32_t v = 0; v < c->mesh->n_points; v++)
        c->report->n_used_points += check_is_used(c, v);
    if (c->mesh->neighbors != NULL && check_good(c, TRI_CHECK_EDGES))
        compare_neighbors(c);
    return TRI_OK;
}

/* How often the triangles at each vertex sweep over the direction +x: an exact measure of their turning that needs no
 * arithmetic, since triangle v a b, counter-clockwise, covers it just if a is not above v and b is. */
enum tri_status tri_check_stars(struct checker *c)
{
    const int32_t *v = c->mesh->triangles;
    uint8_t *turns = tri_check_zeros(c->mesh->n_points, 1), *boundary = tri_check_zeros(c->mesh->n_points, 1);
    enum tri_status status = turns == NULL || boundary == NULL ? TRI_NO_MEMORY : TRI_OK;
    if (status != TRI_OK)
        goto done;
    tri_check_begin(c, TRI_CHECK_STARS);
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        int32_t a = check_org(c, h), b = check_dest(c, h);
        double y = check_point(c, v[h]).y;
        if (check_point(c, a).y <= y && y < check_point(c, b).y && turns[v[h]] < UINT8_MAX)
            turns[v[h]]++;
        if (c->link[h] < 0)
            boundary[a] = boundary[b] = 1;
    }
    for (int32_t i = 0; i < c->mesh->n_points; i++) {
        if (!check_is_used(c, i) || turns[i] == 1 || (boundary[i] && turns[i] == 0))
            continue;
        tri_check_fault(c, TRI_CHECK_STARS, "the triangles around vertex %ld wind around it %d times",
                        check_number(c, i), turns[i]);
    }
done:
    free(turns);
    free(boundary);
    return status;
}

/* Boundary edge that leaves v, -1: none, -2: several. */
static int32_t only_boundary_edge_from(const struct checker *c, int32_t v)
{
    int32_t found = -1;
    for (int32_t i = c->first[v]; i < c->first[v + 1]; i++) {
        int32_t h = check_prev(c->corner[i].name);
        if (c->link[h] >= 0)
            continue;
        if (found >= 0)
            return -2;
        found = h;
    }
    return found;
}

/* A simple closed boundary that never turns right is convex; two of them are two hulls. */
void tri_check_hull(struct checker *c)
{
    tri_check_begin(c, TRI_CHECK_HULL);
    int32_t start = -1;
    for (int32_t h = 0; h < c->n_half_edges && start < 0; h++) {
        if (c->link[h] < 0)
            start = h;
    }
    if (start < 0)
        return;
    int64_t n = 0;
    int32_t h = start;
    do {
        int32_t next = only_boundary_edge_from(c, check_dest(c, h));
        if (next < 0 || tri_orient2d(check_point(c, check_org(c, h)), check_point(c, check_dest(c, h)),
                                     check_point(c, check_dest(c, next))) < 0) {
            tri_check_fault(c, TRI_CHECK_HULL, "the boundary is not convex at vertex %ld",
                            check_number(c, check_dest(c, h)));
            return;
        }
        h = next;
        n++;
    } while (h != start);
    if (n == c->report->n_boundary_edges)
        return;
    tri_check_fault(c, TRI_CHECK_HULL, "the boundary has %lld edges, but its loop through vertex %ld only %lld",
                    (long long)c->report->n_boundary_edges, check_number(c, check_org(c, start)), (long long)n);
}
