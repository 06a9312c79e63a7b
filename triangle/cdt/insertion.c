/* Walk, cavity, fan. */
#include "triangle/cdt/insertion.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

/* An edge of the cavity: the code of its triangle outside, and the corner at which it starts. */
struct tri_inserter_edge {
    tri_halfedge outer;
    tri_vertex_id a;
};

/* An edge behind which the search has not looked yet; it starts where the last edge ended. */
struct tri_inserter_pending {
    tri_link link;
    tri_vertex_id end;
};

void tri_inserter_free(struct tri_inserter *b)
{
    free(b->cavity);
    free(b->edge);
    free(b->pending);
}

/* A cavity has two edges more than triangles. */
enum { MORE_EDGES = 2 };

static bool grow(struct tri_inserter *b)
{
    const struct tri_growing arrays[] = {
        {&b->cavity, sizeof *b->cavity}, {&b->edge, sizeof *b->edge}, {&b->pending, sizeof *b->pending}};
    return tri_grow_together(arrays, 3, &b->capacity, b->capacity + 1, MORE_EDGES);
}

static inline bool holds(const struct tri_inserter *b, tri_vertex_id v)
{
    return (uint32_t)(v - b->stretch.first) < (uint32_t)(b->stretch.last - b->stretch.first) || v == TRI_GHOST;
}

bool tri_inserter_owns(const struct tri_inserter *b, const struct tri_triangle *t)
{
    return holds(b, t->v[0]) && holds(b, t->v[1]) && holds(b, t->v[2]);
}

/* Ghost e + 1 sees edge e the other way round; its edge from the hull edge's far end to infinity is shared with the
 * ghost of the edge that starts there. */
void tri_insert_first(const struct tri_point *xy, struct tri_triangle *tri, tri_triangle_id triangle,
                      const tri_vertex_id v[3])
{
    bool left = tri_orient2d(xy[v[0]], xy[v[1]], xy[v[2]]) > 0;
    assert(tri_orient2d(xy[v[0]], xy[v[1]], xy[v[2]]) != 0);
    const tri_vertex_id c[] = {v[left ? 0 : 1], v[left ? 1 : 0], v[2]};
    tri[triangle] = (struct tri_triangle){
        {c[0], c[1], c[2]}, {tri_code(triangle + 1, 0), tri_code(triangle + 2, 0), tri_code(triangle + 3, 0)}, 0, 0};
    for (int e = 0; e < 3; e++) {
        int f = tri_next[e], g = tri_prev[e];
        tri[triangle + e + 1] = (struct tri_triangle){
            {TRI_GHOST, c[g], c[f]},
            {tri_code(triangle, e), tri_code(triangle + g + 1, 2), tri_code(triangle + f + 1, 1)}, 0, 0};
    }
}

/* Strictly between a and b, where the three are collinear. */
static bool between(struct tri_point a, struct tri_point b, struct tri_point q)
{
    return a.x != b.x ? (a.x < q.x) != (b.x < q.x) && q.x != a.x && q.x != b.x
                      : (a.y < q.y) != (b.y < q.y) && q.y != a.y && q.y != b.y;
}

/* A ghost's hull edge runs from -> to with the outside on its left. */
static bool in_ghost(const struct tri_inserter *b, const struct tri_triangle *t, int ghost, struct tri_point q)
{
    assert(ghost >= 0 && t->v[tri_next[ghost]] >= 0 && t->v[tri_prev[ghost]] >= 0);
    struct tri_point from = b->xy[t->v[tri_next[ghost]]], to = b->xy[t->v[tri_prev[ghost]]];
    double side = tri_orient2d(from, to, q);
    return side > 0 || (side == 0 && between(from, to, q));
}

static inline bool in_disk(const struct tri_inserter *b, const struct tri_triangle *t, struct tri_point q)
{
    if ((t->v[0] | t->v[1] | t->v[2]) < 0)
        return in_ghost(b, t, tri_ghost_corner(t), q);
    return tri_in_circle(b->xy[t->v[0]], b->xy[t->v[1]], b->xy[t->v[2]], q);
}

/* A walk by visibility: the triangle contains q, or is a ghost beyond the hull edge that the walk leaves through. Exact
 * orientations: the walk cannot cycle in a Delaunay triangulation. Of a neighbour of what the stretch owns it is the
 * corner across the edge that tells whether the stretch owns it, too. */
static inline tri_triangle_id locate(struct tri_inserter *b, struct tri_point q)
{
    tri_triangle_id t = b->last;
    int from = -1, ghost = tri_ghost_corner(&b->tri[t]);
    assert(tri_inserter_owns(b, &b->tri[t]));
    if (ghost >= 0)
        t = tri_of(b->tri[t].n[ghost]);
    if (ghost >= 0 && !tri_inserter_owns(b, &b->tri[t]))
        return TRI_NONE;
    for (;;) {
        const struct tri_triangle *at = &b->tri[t];
        int k = 0;
        if (from >= 0 && !holds(b, at->v[from]))
            return TRI_NONE;
        if ((at->v[0] | at->v[1] | at->v[2]) < 0)
            return t;
        b->last = t;
        for (; k < 3; k++)
            if (k != from && tri_orient2d(b->xy[at->v[tri_next[k]]], b->xy[at->v[tri_prev[k]]], q) < 0)
                break;
        if (k == 3)
            return t;
        t = tri_of(at->n[k]);
        from = tri_edge(at->n[k]);
    }
}

tri_triangle_id tri_inserter_locate(struct tri_inserter *b, struct tri_point q) { return locate(b, q); }

/* Adds what lies across one edge of the first triangle. */
static enum tri_insertion explore(struct tri_inserter *b, struct tri_point q, tri_link link, tri_vertex_id a,
                                  tri_vertex_id end)
{
    int32_t n_pending = 0;
    for (;;) {
        const struct tri_triangle *t = &b->tri[tri_of(link)];
        int e = tri_edge(link);
        assert(link >= 0 && t->v[tri_next[e]] == end && t->v[tri_prev[e]] == a);
        if (in_disk(b, t, q)) {
            if (!holds(b, t->v[e]))
                return TRI_NOT_OWNED;
            if (b->n_cavity == b->capacity && !grow(b))
                return TRI_INSERTION_NO_MEMORY;
            b->cavity[b->n_cavity++] = tri_of(link);
            b->pending[n_pending++] = (struct tri_inserter_pending){t->n[tri_prev[e]], end};
            link = t->n[tri_next[e]];
            end = t->v[e];
            continue;
        }
        assert(b->n_edges < b->n_cavity + 2 && n_pending <= b->n_cavity);
        b->edge[b->n_edges++] = (struct tri_inserter_edge){link, a};
        if (n_pending == 0)
            return TRI_INSERTED;
        a = end;
        link = b->pending[--n_pending].link;
        end = b->pending[n_pending].end;
    }
}

/* Replaces the cavity by the fan of v. */
static void fill(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id fresh)
{
    tri_triangle_id before = TRI_NONE, first = TRI_NONE;
    assert(b->n_edges == b->n_cavity + 2 && b->n_edges >= 3); /* Euler: a disk without a vertex inside */
    for (int32_t i = 0; i < b->n_edges; i++) {
        tri_triangle_id triangle = i < b->n_cavity ? b->cavity[i] : fresh++;
        tri_halfedge outer = b->edge[i].outer;
        tri_vertex_id end = b->edge[i + 1 < b->n_edges ? i + 1 : 0].a;
        struct tri_triangle *t = &b->tri[triangle];
        tri_link link = before == TRI_NONE ? TRI_NONE : tri_code(before, 1);
        *t = (struct tri_triangle){{v, b->edge[i].a, end}, {outer, TRI_NONE, link}, 0, 0};
        assert(tri_inserter_owns(b, t));
        b->tri[tri_of(outer)].n[tri_edge(outer)] = tri_code(triangle, 0);
        if (before != TRI_NONE)
            b->tri[before].n[1] = tri_code(triangle, 2);
        else
            first = triangle;
        before = triangle;
    }
    b->tri[first].n[2] = tri_code(before, 1);
    b->tri[before].n[1] = tri_code(first, 2);
    b->last = first;
}

enum tri_insertion tri_insert(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id triangle)
{
    struct tri_point q = b->xy[v];
    tri_triangle_id t = locate(b, q);
    if (t == TRI_NONE)
        return TRI_NOT_OWNED;
    const struct tri_triangle start = b->tri[t];
    assert(holds(b, v) && tri_inserter_owns(b, &start) && in_disk(b, &start, q));
    b->n_cavity = b->n_edges = 0;
    if (b->capacity == 0 && !grow(b))
        return TRI_INSERTION_NO_MEMORY;
    b->cavity[b->n_cavity++] = t;
    for (int e = 0; e < 3; e++) {
        enum tri_insertion found = explore(b, q, start.n[e], start.v[tri_next[e]], start.v[tri_prev[e]]);
        if (found != TRI_INSERTED)
            return found;
    }
    fill(b, v, triangle);
    return TRI_INSERTED;
}
