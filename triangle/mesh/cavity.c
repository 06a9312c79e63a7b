/* Search and fill of cavities; see the header for the theorems. */
#include "triangle/mesh/cavity.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

/* The error of the determinant is at most (10 + 96 u) u * permanent, with u = 2^-53 (Shewchuk 1997, section 4.4). The
 * permanent is the sum of l_a (|b_x c_y| + |b_y c_x|). By Cauchy-Schwarz and 2 s t <= s^2 + t^2 it is at most l_a l_b +
 * l_b l_c + l_c l_a, which is at most a third of (l_a + l_b + l_c)^2. The factor is rounded up to cover the rounding of
 * that square. Nothing underflows in the range of predicates.h. */
static const double INCIRCLE_BOUND = 4e-16;

void tri_cavity_free(struct tri_cavity *cavity)
{
    free(cavity->tri);
    free(cavity->corner);
    free(cavity->edge);
    free(cavity->wall);
    free(cavity->pending);
    *cavity = (struct tri_cavity){0};
}

/* Items that the arrays hold beyond one for each triangle: two edges, the pending edges among them, and one entry that
 * marks the end of the last edge. Each side of a split adds two corners. */
enum { EXTRA_ITEMS = 5 };

/* Result of one attempt if the arrays are too small. They must not move during a search, so the caller enlarges them
 * and starts the search again. */
#define TOO_LARGE TRI_SEARCH_NO_MEMORY

static bool grow(struct tri_cavity *c)
{
    const struct tri_growing arrays[] = {{&c->tri, sizeof *c->tri}, {&c->corner, sizeof *c->corner},
                                         {&c->edge, sizeof *c->edge}, {&c->wall, sizeof *c->wall},
                                         {&c->pending, sizeof *c->pending}};
    return tri_grow_together(arrays, 5, &c->capacity, c->capacity + 1, EXTRA_ITEMS);
}

bool tri_fence_owns(const struct tri_fence *fence, const struct tri_mesh *mesh, tri_triangle_id t)
{
    for (int k = 0; fence && k < 3; k++)
        if (!tri_fence_holds(fence, mesh->xy[mesh->tri[t].v[k]]))
            return false;
    return true;
}

/* Is p in the circumdisk of a, b, c? The caller passes the determinant and the sum of the l. If the floating-point
 * filter cannot decide the sign, which is rare, exact arithmetic does. */
static inline bool in_circle(const struct tri_mesh *mesh, struct tri_point p, const struct tri_cavity_corner *a,
                             const struct tri_cavity_corner *b, const struct tri_cavity_corner *c, double sum,
                             double det)
{
    if (fabs(det) > INCIRCLE_BOUND * (sum * sum))
        return det > 0;
    return tri_in_circle_near(mesh->xy[a->v], mesh->xy[b->v], mesh->xy[c->v], p);
}

static enum tri_search stop_at(struct tri_cavity *c, tri_vertex_id a, tri_vertex_id b)
{
    c->beyond[0] = a;
    c->beyond[1] = b;
    return TRI_SEARCH_BEYOND;
}

/* Traverses the cavity depth first, left first. This yields the boundary edges in order: each pending edge starts where
 * the last boundary edge ends, and the first one starts at corner a. A pending edge carries the cross product of its
 * ends. So one of the three products of an incircle test is known, and the other two are passed on with the next
 * edges. */
static enum tri_search explore(struct tri_cavity *c, const struct tri_mesh *mesh, int32_t n_pending,
                               const struct tri_cavity_corner *a)
{
    const struct tri_triangle *const tri = mesh->tri;
    const struct tri_point *const xy = mesh->xy, p = c->p;
    struct tri_cavity_corner *q = c->corner + c->n_corners;
    struct tri_cavity_edge *ring = c->edge + c->n_edges;
    struct tri_pending *pending = c->pending + n_pending - 1, edge = *pending;
    tri_triangle_id *took = c->tri + c->n_tri, *const most = c->tri + c->capacity;
    uint32_t mixed = 0;
    for (;;) {
        if (edge.link >= 0) {
            const struct tri_triangle *t = &tri[edge.link >> 2];
            int e = edge.link & 3;
            q->v = t->v[e];
            q->r = tri_relative(&xy[q->v], p);
            double left = tri_cross(a->r, q->r), right = tri_cross(q->r, edge.end->r);
            double det = a->r.l * right + edge.end->r.l * left - q->r.l * edge.area2;
            if (in_circle(mesh, p, a, q, edge.end, a->r.l + edge.end->r.l + q->r.l, det)) {
                if (c->fence && !tri_fence_holds(c->fence, xy[q->v])) {
                    c->n_tri = (int32_t)(took - c->tri);
                    return TRI_SEARCH_FENCED;
                }
                if (took == most)
                    return TOO_LARGE;
                assert(t->v[tri_next[e]] == edge.end->v && t->v[tri_prev[e]] == a->v);
                *took++ = edge.link >> 2;
                mixed |= (uint32_t)(t->region ^ c->region);
                *pending++ = (struct tri_pending){right, edge.end, t->n[tri_prev[e]], t->region};
                edge = (struct tri_pending){left, q++, t->n[tri_next[e]], t->region};
                continue;
            }
        } else {
            if (edge.link == TRI_BEYOND)
                return stop_at(c, a->v, edge.end->v);
            c->wall[c->n_wall++] = (int32_t)(ring - c->edge);
        }
        *ring++ = (struct tri_cavity_edge){edge.area2, a, edge.link, edge.region};
        a = edge.end;
        if (pending == c->pending)
            break;
        edge = *--pending;
    }
    /* A final entry marks the end of the last edge, so loops over edges need no special case. The chain on the left of
     * a split ends where the chain on the right begins. */
    ring->a = a;
    c->n_tri = (int32_t)(took - c->tri);
    c->n_corners = (int32_t)(q - c->corner);
    c->n_edges = (int32_t)(ring - c->edge);
    c->mixed |= mixed;
    return TRI_SEARCH_FOUND;
}

static void begin_search(struct tri_cavity *c, struct tri_point p)
{
    c->p = p;
    c->n_tri = c->n_corners = c->n_edges = c->n_wall = 0;
    c->mixed = 0;
}

/* Explores triangle t and the triangles across n of its edges, in order from `first`. If p is not in the circumdisk of
 * t, because of rounding or because t is nearly flat, the fan would not be Delaunay. */
static enum tri_search explore_from(struct tri_cavity *c, const struct tri_mesh *mesh, tri_triangle_id t, int first,
                                    int n)
{
    const struct tri_triangle *start = &mesh->tri[t];
    assert(first >= 0 && first < 3 && (n == 2 || n == 3));
    assert(t >= 0 && tri_is_live(start));
    if (c->n_tri + 2 > c->capacity)
        return TOO_LARGE;
    c->region = start->region;
    c->tri[c->n_tri++] = t;
    if (c->fence && !tri_fence_owns(c->fence, mesh, t))
        return TRI_SEARCH_FENCED;
    struct tri_cavity_corner *q = c->corner + c->n_corners;
    for (int k = 0; k < 3; k++)
        q[k] = (struct tri_cavity_corner){tri_relative(&mesh->xy[start->v[k]], c->p), start->v[k]};
    c->n_corners += 3;
    double area2[3] = {tri_cross(q[1].r, q[2].r), tri_cross(q[2].r, q[0].r), tri_cross(q[0].r, q[1].r)};
    double det = q[0].r.l * area2[0] + q[1].r.l * area2[1] + q[2].r.l * area2[2];
    bool distinct = q[0].r.l != 0 && q[1].r.l != 0 && q[2].r.l != 0;
    if (!distinct || !in_circle(mesh, c->p, &q[0], &q[1], &q[2], q[0].r.l + q[1].r.l + q[2].r.l, det))
        return TRI_SEARCH_OUTSIDE;
    int e = first;
    for (int32_t k = n - 1; k >= 0; k--, e = tri_next[e])
        c->pending[k] = (struct tri_pending){area2[e], &q[tri_prev[e]], start->n[e], start->region};
    return explore(c, mesh, n, &q[tri_next[first]]);
}

enum tri_search tri_cavity_search(struct tri_cavity *c, const struct tri_mesh *mesh, struct tri_point p,
                                  tri_triangle_id t)
{
    assert(tri_is_live(&mesh->tri[t]));
    if (!tri_is_in_range(p)) /* the circumcentre of a nearly flat triangle: maybe in its disk, but not in the domain */
        return TRI_SEARCH_OUTSIDE;
    enum tri_search found;
    do {
        begin_search(c, p);
        found = explore_from(c, mesh, t, 0, 3);
    } while (found == TOO_LARGE && grow(c));
    return found;
}

/* Does p see every edge counter-clockwise? Rounding may place a split point off its subsegment. */
static bool sees_edges(const struct tri_cavity *c, const struct tri_mesh *mesh, int32_t first, int32_t end)
{
    assert(0 <= first && first <= end && end <= c->n_edges);
    for (int32_t i = first; i < end; i++) {
        const struct tri_cavity_corner *a = c->edge[i].a, *b = c->edge[i + 1].a;
        if (a->r.l == 0 || tri_orient2d(c->p, mesh->xy[a->v], mesh->xy[b->v]) <= 0)
            return false;
    }
    return true;
}

static int compare_links(const void *a, const void *b)
{
    const struct tri_pending *p = a, *q = b;
    return (p->link > q->link) - (p->link < q->link);
}

/* Does a triangle occur twice in the cavity, or lie across its boundary? Sorts in c->pending, which no search uses at
 * this time. */
static bool repeats_itself(const struct tri_cavity *c)
{
    size_t n = (size_t)c->n_tri;
    for (int32_t i = 0; i < c->n_tri; i++)
        c->pending[i].link = c->tri[i];
    qsort(c->pending, n, sizeof *c->pending, compare_links);
    for (int32_t i = 1; i < c->n_tri; i++)
        if (c->pending[i].link == c->pending[i - 1].link)
            return true;
    for (int32_t k = 0; k < c->n_edges; k++) {
        if (c->edge[k].outer < 0)
            continue;
        struct tri_pending beyond = {.link = tri_of(c->edge[k].outer)};
        if (bsearch(&beyond, c->pending, n, sizeof *c->pending, compare_links))
            return true;
    }
    return false;
}

/* Does the cavity overlap itself? If rounding places a split point beside a vertex, the search may go around that
 * vertex and return to triangles that it has visited. */
static bool overlaps_itself(const struct tri_cavity *c, tri_sub_id s)
{
    enum { FEW = 64 };
    for (int32_t i = 0; i < c->n_wall; i++)
        if (c->edge[c->wall[i]].outer == ~s)
            return true;
    if (c->n_tri > FEW)
        return repeats_itself(c);
    for (int32_t i = 0; i < c->n_tri; i++) {
        for (int32_t k = 0; k < i; k++)
            if (c->tri[i] == c->tri[k])
                return true;
        for (int32_t k = 0; k < c->n_edges; k++)
            if (c->edge[k].outer >= 0 && c->edge[k].outer >> 2 == c->tri[i])
                return true;
    }
    return false;
}

/* One attempt, with the arrays at their current size. */
static enum tri_search search_split(struct tri_cavity *c, const struct tri_mesh *mesh, tri_sub_id s, int32_t *n_left)
{
    const struct tri_subsegment *sub = &mesh->sub[s];
    *n_left = c->n_left_tri = 0;
    for (int side = 0; side < 2; side++) {
        int32_t first = c->n_edges;
        if (sub->side[side] == TRI_NONE)
            continue;
        if (sub->side[side] == TRI_BEYOND)
            return stop_at(c, sub->v[0], sub->v[1]);
        tri_halfedge code = sub->side[side];
        assert(*tri_link_at(mesh, code) == ~s);
        enum tri_search found = explore_from(c, mesh, tri_of(code), tri_next[tri_edge(code)], 2);
        if (found != TRI_SEARCH_FOUND)
            return found;
        if (!sees_edges(c, mesh, first, c->n_edges))
            return TRI_SEARCH_OUTSIDE;
        if (side == 0) {
            *n_left = c->n_edges;
            c->n_left_tri = c->n_tri;
        }
    }
    return overlaps_itself(c, s) ? TRI_SEARCH_OUTSIDE : TRI_SEARCH_FOUND;
}

enum tri_search tri_cavity_search_split(struct tri_cavity *c, const struct tri_mesh *mesh, struct tri_point p,
                                        tri_sub_id s, int32_t *n_left)
{
    assert(s >= 0 && tri_is_in_range(p)); /* in a view, s may be at or above n_subs */
    enum tri_search found;
    do {
        begin_search(c, p);
        found = search_split(c, mesh, s, n_left);
    } while (found == TOO_LARGE && grow(c));
    return found;
}

/* Assigns numbers to the triangles of the fan: first those of the cavity, then new ones. A fan has at least as many
 * triangles as its cavity (Euler), so no number is left over. The first number is repeated after the last, as its
 * neighbour in the fan. */
static void number_fan(struct tri_cavity *c, struct tri_mesh *mesh)
{
    assert(c->n_tri <= c->n_edges);
    for (int32_t i = c->n_tri; i < c->n_edges; i++) {
        assert(mesh->n_triangles < mesh->triangle_capacity);
        mesh->tri[mesh->n_triangles].generation = 0;
        c->tri[i] = mesh->n_triangles++;
    }
    c->tri[c->n_edges] = c->tri[0];
}

#ifndef NDEBUG
/* Checks that no other call has changed a triangle of the cavity. */
static bool claim_triangles(const struct tri_cavity *c)
{
    for (int32_t i = 0; i < c->n_tri; i++)
        if (!tri_owners_claim(c->owners, c->tri[i]))
            return false;
    return true;
}
#endif

static bool is_inside(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    struct tri_relative a = tri_relative(&mesh->xy[v[0]], q), b = tri_relative(&mesh->xy[v[1]], q);
    struct tri_relative c = tri_relative(&mesh->xy[v[2]], q);
    return tri_cross(a, b) >= 0 && tri_cross(b, c) >= 0 && tri_cross(c, a) >= 0;
}

/* If regions meet without a subsegment between them, assigns each new triangle the region in which its centroid lies,
 * so regions keep their places. If rounding prevents this, the triangle keeps the region inside its edge. Searches the
 * cavity's triangles first_tri .. end_tri - 1, which lie on the same side of a split subsegment. */
static void place_new_regions(struct tri_cavity *c, const struct tri_mesh *mesh, int32_t first, int32_t end,
                          int32_t first_tri, int32_t end_tri)
{
    assert(0 <= first && first <= end && end <= c->n_edges && 0 <= first_tri && end_tri <= c->n_tri);
    for (int32_t i = first; i < end; i++) {
        struct tri_point a = mesh->xy[c->edge[i].a->v], b = mesh->xy[c->edge[i + 1].a->v];
        struct tri_point centroid = {(a.x + b.x + c->p.x) / 3, (a.y + b.y + c->p.y) / 3};
        for (int32_t k = first_tri; k < end_tri; k++)
            if (is_inside(mesh, c->tri[k], centroid)) {
                c->edge[i].region = mesh->tri[c->tri[k]].region;
                break;
            }
    }
}

void tri_cavity_number_fan(struct tri_cavity *c, struct tri_mesh *mesh)
{
    assert(c->n_tri >= 1 && c->n_edges == c->n_tri + 2); /* Euler: a disk without a vertex inside */
    assert(claim_triangles(c));
    if (c->mixed)
        place_new_regions(c, mesh, 0, c->n_edges, 0, c->n_tri);
    number_fan(c, mesh);
}

/* Makes the triangles of edges first .. end - 1. Links each one to its neighbours in the cycle of all edges, without
 * special cases. If the chain is not closed, the caller corrects the links at its ends. */
static void fill_chain(const struct tri_cavity *c, struct tri_mesh *mesh, tri_vertex_id v, int32_t first, int32_t end)
{
    tri_triangle_id before = c->tri[first > 0 ? first - 1 : c->n_edges - 1];
    assert(0 <= first && first < end && end <= c->n_edges);
    for (int32_t i = first; i < end; before = c->tri[i++])
        tri_make_fan_triangle(mesh, v, &c->edge[i], before, c->tri[i], c->tri[i + 1]);
}

void tri_cavity_fill(struct tri_cavity *c, struct tri_mesh *mesh, tri_vertex_id v)
{
    assert(v >= 0 && v < mesh->n_vertices && mesh->xy[v].x == c->p.x && mesh->xy[v].y == c->p.y);
    tri_cavity_number_fan(c, mesh);
    fill_chain(c, mesh, v, 0, c->n_edges);
}

tri_sub_id tri_cavity_fill_split(struct tri_cavity *c, struct tri_mesh *mesh, tri_vertex_id v, tri_sub_id s,
                                 int32_t n_left)
{
    const struct tri_subsegment old = mesh->sub[s];
    tri_sub_id second = mesh->n_subs++;
    const int32_t ends[2] = {0, n_left};
    assert(mesh->n_subs <= mesh->sub_capacity && s >= 0 && s != second);
    assert(n_left >= 0 && n_left <= c->n_edges && (n_left == 0) == (old.side[0] == TRI_NONE));
    assert(c->n_edges == c->n_tri + (tri_is_boundary(&old) ? 1 : 2)); /* Euler: a disk on each side */
    assert(v >= 0 && v < mesh->n_vertices && v != old.v[0] && v != old.v[1]);
    assert(claim_triangles(c));
    if (c->mixed) {
        place_new_regions(c, mesh, 0, n_left, 0, c->n_left_tri);
        place_new_regions(c, mesh, n_left, c->n_edges, c->n_left_tri, c->n_tri);
    }
    number_fan(c, mesh);
    mesh->sub[s] = (struct tri_subsegment){{old.v[0], v}, {TRI_NONE, TRI_NONE}, old.marker, old.parent};
    mesh->sub[second] = (struct tri_subsegment){{v, old.v[1]}, {TRI_NONE, TRI_NONE}, old.marker, old.parent};
    for (int side = 0; side < 2; side++) {
        int32_t first = ends[side], end = side == 0 ? n_left : c->n_edges;
        if (first == end)
            continue;
        fill_chain(c, mesh, v, first, end);
        /* Seen from the left, the chain runs from v[1] to v[0]; seen from the right, from v[0] to v[1]. */
        tri_sub_id at_start = side == 0 ? second : s, at_end = side == 0 ? s : second;
        mesh->tri[c->tri[first]].n[2] = ~at_start;
        mesh->sub[at_start].side[side] = tri_code(c->tri[first], 2);
        mesh->tri[c->tri[end - 1]].n[1] = ~at_end;
        mesh->sub[at_end].side[side] = tri_code(c->tri[end - 1], 1);
    }
    return second;
}
