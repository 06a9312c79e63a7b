/* Triangulates the two polygons left and right of a new edge by divide and conquer.
 *
 * The vertices left of ab, in the order in which edges from them cross ab, form a chain from a to b; those on the right
 * form a chain from b to a. A vertex may occur several times in a chain, so the algorithm works on places in the chain.
 *
 * INVARIANT. The string of places i < k is the shortest path from i to k inside the polygon. The pockets between the
 * chain and its string have a constrained Delaunay triangulation. The string from a to b is the edge ab.
 *
 * MERGE (docs/theory.md, recovering an edge). Two adjacent strings are merged by a rising bubble, in O(log m) rounds
 * that each make and remove O(m) triangles. Sources: L. Guibas and J. Stolfi, Primitives for the Manipulation of
 * General Subdivisions and the Computation of Voronoi Diagrams, ACM Transactions on Graphics 4 (1985), section 9; D. T.
 * Lee and A. K. Lin, Generalized Delaunay Triangulation for Planar Graphs, Discrete & Computational Geometry 1
 * (1986). */
#include "triangle/cdt/recover.h"

#include <assert.h>
#include <stdbool.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

/* A place in one of the two chains; the left chain comes first. Border i joins places i and i + 1. During the
 * triangulation, corners of triangles are places. Links are codes, ~i for border i, or ~(places + i) for the piece of a
 * string that starts at place i. */
struct tri_recovery_place {
    tri_vertex_id vertex;
    tri_link outer;     /* border: link of the mesh on its outer side */
    union {
        tri_halfedge code; /* border, until the triangles are freed: half-edge of its triangle */
        int32_t twin;      /* border, afterwards: another border along the same edge, or TRI_NONE */
    };
    int32_t inner;      /* border: link on its inner side */
    int32_t prev, next; /* string: neighbouring places */
    int32_t above;      /* string: link above the piece to `next` */
};

/* A place on one side of the gap, with the link across its edge towards lr. */
struct tri_recovery_node {
    int32_t place, link;
};

/* A merge in progress: the gap above the edge lr. Its two sides are stacks of places up to j. */
struct gap {
    struct tri_recovery *r;
    struct tri_mesh *mesh;
    int32_t end[2], base; /* l and r; the link below lr */
    struct tri_recovery_node *side[2];
    int32_t n[2];
};

void tri_recovery_free(struct tri_recovery *r)
{
    free(r->crossed);
    free(r->pool);
    free(r->at);
    free(r->gap[0]);
    free(r->gap[1]);
    *r = (struct tri_recovery){0};
}

/* --- crossed triangles */

static bool add_crossed(struct tri_recovery *r, tri_halfedge code)
{
    if (!tri_grow(&r->crossed, &r->crossed_capacity, r->n_crossed + 1, sizeof *r->crossed))
        return false;
    r->crossed[r->n_crossed++] = code;
    return true;
}

/* Lists the edges through which ab enters triangles; for the first triangle, the edge through which ab leaves it. */
static bool list_crossed(struct tri_recovery *r, const struct tri_mesh *mesh, tri_triangle_id t, tri_vertex_id a,
                         tri_vertex_id b)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    tri_halfedge code = tri_code(t, v[0] == a ? 0 : v[1] == a ? 1 : 2);
    tri_vertex_id o = a;
    assert(a != b && tri_apex(mesh, code) == a);
    r->n_crossed = 0;
    r->n_left = 1;
    if (!add_crossed(r, code))
        return false;
    while (o != b) {
        code = *tri_link_at(mesh, code);
        assert(code >= 0); /* not a subsegment */
        if (!add_crossed(r, code))
            return false;
        o = tri_apex(mesh, code);
        double side = o == b ? 0 : tri_orient2d(mesh->xy[a], mesh->xy[b], mesh->xy[o]);
        assert(o == b || side != 0); /* not on a vertex */
        r->n_left += side > 0;
        code = tri_code(tri_of(code), side > 0 ? tri_next[tri_edge(code)] : tri_prev[tri_edge(code)]);
    }
    r->n_left += 2; /* the first vertex, and b */
    assert(r->n_crossed >= 2 && r->n_left >= 3 && r->n_left <= r->n_crossed + 1);
    return true;
}

enum { MORE_PLACES = 4 }; /* more places than crossed triangles: a and b occur in both chains */

static int32_t n_places(const struct tri_recovery *r) { return r->n_crossed + MORE_PLACES; }

static bool make_room(struct tri_recovery *r)
{
    const struct tri_growing arrays[] = {{&r->pool, sizeof *r->pool}, {&r->at, sizeof *r->at},
                                         {&r->gap[0], sizeof *r->gap[0]}, {&r->gap[1], sizeof *r->gap[1]}};
    return tri_grow_together(arrays, 4, &r->room, r->n_crossed, MORE_PLACES);
}

static void set_border(struct tri_recovery *r, const struct tri_mesh *mesh, int32_t i, tri_triangle_id t, int e)
{
    assert(i >= 0 && i < n_places(r));
    r->at[i].outer = mesh->tri[t].n[e];
    r->at[i].code = tri_code(t, e);
}

/* Fills both chains. If ab enters a triangle through edge f, the edge starts left of ab and ends right of it. */
static void list_places(struct tri_recovery *r, const struct tri_mesh *mesh)
{
    int32_t left = 0, right = n_places(r) - 1;
    tri_triangle_id t = tri_of(r->crossed[0]);
    int k = tri_edge(r->crossed[0]);
    const tri_vertex_id *v = mesh->tri[t].v;
    r->at[left].vertex = r->at[right].vertex = v[k];
    set_border(r, mesh, left, t, tri_next[k]);
    r->at[++left] = (struct tri_recovery_place){.vertex = v[tri_prev[k]]};
    r->at[--right] = (struct tri_recovery_place){.vertex = v[tri_next[k]]};
    set_border(r, mesh, right, t, tri_prev[k]);
    for (int32_t i = 1; i < r->n_crossed; i++) {
        int f = tri_edge(r->crossed[i]);
        t = tri_of(r->crossed[i]);
        v = mesh->tri[t].v;
        bool last = i + 1 == r->n_crossed, is_left = !last && mesh->tri[t].n[tri_next[f]] == r->crossed[i + 1];
        if (last || is_left) {
            set_border(r, mesh, left, t, tri_prev[f]);
            r->at[++left] = (struct tri_recovery_place){.vertex = v[f]};
        }
        if (!is_left) {
            r->at[--right] = (struct tri_recovery_place){.vertex = v[f]};
            set_border(r, mesh, right, t, tri_next[f]);
        }
    }
    assert(left == r->n_left - 1 && right == r->n_left);
}

/* Frees the crossed triangles, and finds pairs of borders that are two sides of one edge. */
static void clear_triangles(struct tri_recovery *r, struct tri_mesh *mesh)
{
    r->n_free = 0;
    for (int32_t i = r->n_crossed - 1; i >= 0; i--) {
        mesh->tri[tri_of(r->crossed[i])].v[0] = TRI_NONE;
        r->pool[r->n_free++] = tri_of(r->crossed[i]);
    }
    for (int32_t i = 0; i < n_places(r) - 1; i++)
        if (i != r->n_left - 1)
            mesh->tri[tri_of(r->at[i].code)].n[tri_edge(r->at[i].code)] = i;
    for (int32_t i = 0; i < n_places(r) - 1; i++) {
        const struct tri_triangle *beyond = r->at[i].outer >= 0 ? &mesh->tri[tri_of(r->at[i].outer)] : NULL;
        bool inside = i != r->n_left - 1 && beyond && !tri_is_live(beyond);
        r->at[i].twin = inside ? beyond->n[tri_edge(r->at[i].outer)] : TRI_NONE;
    }
}

/* --- divide and conquer */

static void set_link(struct gap *g, tri_link link, tri_link other)
{
    int32_t n = n_places(g->r);
    assert(link >= 0 || ~link < 2 * n);
    if (link >= 0)
        *tri_link_at(g->mesh, link) = other;
    else if (~link < n)
        g->r->at[~link].inner = other;
    else
        g->r->at[~link - n].above = other;
}

static void join(struct gap *g, tri_link x, tri_link y)
{
    set_link(g, x, y);
    set_link(g, y, x);
}

static struct tri_point point_at(const struct gap *g, int32_t place)
{
    return g->mesh->xy[g->r->at[place].vertex];
}

/* Is the angle below q less than 180 degrees, between places p < q < s that see q? */
static bool is_slack(const struct gap *g, int32_t p, int32_t q, tri_sub_id s)
{
    assert(p < q && q < s);
    return tri_orient2d(point_at(g, p), point_at(g, q), point_at(g, s)) < 0;
}

static void push(struct gap *g, int side, int32_t place, tri_link link)
{
    assert(g->n[side] < n_places(g->r));
    g->side[side][g->n[side]++] = (struct tri_recovery_node){place, link};
}

/* Finds where the string of i..k leaves the strings of i..j and j..k. The parts between become the sides of the gap. */
static void open_gap(struct gap *g, int32_t i, int32_t j, int32_t k)
{
    struct tri_recovery_place *at = g->r->at;
    int32_t l = at[j].prev, r = at[j].next;
    assert(i <= l && l < j && j < r && r <= k);
    g->n[0] = g->n[1] = 0;
    push(g, 0, j, at[l].above);
    push(g, 1, j, at[j].above);
    for (;;) {
        if (l != i && is_slack(g, at[l].prev, l, r)) {
            push(g, 0, l, at[at[l].prev].above);
            l = at[l].prev;
        } else if (r != k && is_slack(g, l, r, at[r].next)) {
            push(g, 1, r, at[r].above);
            r = at[r].next;
        } else {
            break;
        }
    }
    at[l].next = r;
    at[r].prev = l;
    g->end[0] = l;
    g->end[1] = r;
    g->base = ~(n_places(g->r) + l);
}

/* Removes triangles on one side of the gap that violate the Delaunay property. Returns the next place on that side, or
 * TRI_NONE if the base does not see it. */
static int32_t candidate(struct gap *g, int side)
{
    if (g->n[side] == 0)
        return TRI_NONE;
    struct tri_point l = point_at(g, g->end[0]), r = point_at(g, g->end[1]);
    struct tri_recovery_node *top = &g->side[side][g->n[side] - 1];
    if (tri_orient2d(l, r, point_at(g, top->place)) <= 0)
        return TRI_NONE;
    while (top->link >= 0) {
        struct tri_triangle *t = &g->mesh->tri[tri_of(top->link)];
        int e = tri_edge(top->link);
        tri_vertex_id apex = t->v[e];
        if (!tri_in_circle(l, r, point_at(g, top->place), point_at(g, apex)))
            break;
        assert(tri_is_live(t) && g->r->n_free < g->r->n_crossed);
        g->r->pool[g->r->n_free++] = tri_of(top->link);
        t->v[0] = TRI_NONE;
        top->link = t->n[side == 0 ? tri_next[e] : tri_prev[e]];
        push(g, side, apex, t->n[side == 0 ? tri_prev[e] : tri_next[e]]);
        top++;
    }
    return top->place;
}

static int choose(struct gap *g)
{
    int32_t left = candidate(g, 0), right = candidate(g, 1);
    assert(left != TRI_NONE || right != TRI_NONE);
    if (left == TRI_NONE || right == TRI_NONE)
        return left == TRI_NONE;
    assert(left == right || g->r->at[left].vertex != g->r->at[right].vertex);
    return left != right && tri_in_circle(point_at(g, g->end[0]), point_at(g, g->end[1]), point_at(g, left),
                                          point_at(g, right));
}

/* Makes a triangle of the base and the next place on one side; its third edge becomes the new base. */
static void add_triangle(struct gap *g, int side)
{
    assert(g->n[side] > 0 && g->r->n_free > 0);
    struct tri_recovery_node next = g->side[side][--g->n[side]];
    tri_triangle_id triangle = g->r->pool[--g->r->n_free];
    tri_vertex_id *v = g->mesh->tri[triangle].v;
    v[0] = g->end[0];
    v[1] = g->end[1];
    v[2] = next.place;
    join(g, tri_code(triangle, 2), g->base);
    join(g, tri_code(triangle, 1 - side), next.link);
    g->base = tri_code(triangle, side);
    g->end[side] = next.place;
}

static void merge(struct gap *g, int32_t i, int32_t j, int32_t k)
{
    if (!is_slack(g, g->r->at[j].prev, j, g->r->at[j].next))
        return;
    open_gap(g, i, j, k);
    for (;;) {
        for (int side = 0; side < 2; side++)
            if (g->end[1 - side] == j && g->side[side][g->n[side] - 1].place == j) {
                join(g, g->base, g->side[side][g->n[side] - 1].link);
                return;
            }
        add_triangle(g, choose(g));
    }
}

static void triangulate_chain(struct gap *g, int32_t i, int32_t k)
{
    assert(i < k);
    if (k == i + 1) {
        g->r->at[i].next = k;
        g->r->at[k].prev = i;
        join(g, ~i, ~(n_places(g->r) + i));
        return;
    }
    int32_t j = i + (k - i) / 2;
    triangulate_chain(g, i, j);
    triangulate_chain(g, j, k);
    merge(g, i, j, k);
}

/* --- transfer to the mesh */

static void link_walls(struct tri_recovery *r, struct tri_mesh *mesh)
{
    for (int32_t i = 0; i < n_places(r) - 1; i++) {
        int32_t inner = r->at[i].inner, outer = r->at[i].outer, twin = r->at[i].twin;
        if (i == r->n_left - 1)
            continue;
        assert(inner >= 0 && (twin == TRI_NONE || r->at[twin].twin == i));
        struct tri_triangle *t = &mesh->tri[tri_of(inner)];
        t->n[tri_edge(inner)] = twin == TRI_NONE ? outer : r->at[twin].inner;
        if (twin == TRI_NONE)
            tri_relink(mesh, outer, r->at[t->v[tri_next[tri_edge(inner)]]].vertex, inner);
    }
}

static void restore_corners(const struct tri_recovery *r, struct tri_mesh *mesh)
{
    for (int32_t i = 0; i < r->n_crossed; i++) {
        tri_vertex_id *v = mesh->tri[tri_of(r->crossed[i])].v;
        assert(v[0] >= 0 && v[0] < n_places(r)); /* all freed numbers are in use again */
        for (int k = 0; k < 3; k++)
            v[k] = r->at[v[k]].vertex;
    }
}

enum tri_status tri_recover_edge(struct tri_recovery *r, struct tri_mesh *mesh, tri_triangle_id t, tri_vertex_id a,
                                 tri_vertex_id b, tri_halfedge *code, struct tri_error *error)
{
    if (!list_crossed(r, mesh, t, a, b) || !make_room(r))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a segment across %d triangles",
                        (int)r->n_crossed);
    struct gap g = {.r = r, .mesh = mesh, .side = {r->gap[0], r->gap[1]}};
    list_places(r, mesh);
    clear_triangles(r, mesh);
    triangulate_chain(&g, 0, r->n_left - 1);
    triangulate_chain(&g, r->n_left, n_places(r) - 1);
    assert(r->n_free == 0);
    link_walls(r, mesh);
    restore_corners(r, mesh);
    int32_t left = r->at[0].above, right = r->at[r->n_left].above;
    *tri_link_at(mesh, left) = right;
    *tri_link_at(mesh, right) = left;
    *code = left;
    return TRI_OK;
}

/* The search for the triangle through which a segment leaves its end: around one end, or alternately around both. */

enum { HUB = 16 }; /* a vertex with more triangles than this may be a hub */

/* Returns the next triangle around v, counter-clockwise or clockwise; TRI_NONE at the boundary. */
static tri_triangle_id next_around(const struct tri_mesh *mesh, tri_triangle_id t, tri_vertex_id v, bool left)
{
    int k = tri_corner_of(&mesh->tri[t], v);
    tri_halfedge code = tri_across(mesh, tri_code(t, left ? tri_next[k] : tri_prev[k]));
    return code == TRI_NONE ? TRI_NONE : tri_of(code);
}

/* Is q, which lies on the line through a and b, on the side of b? */
static bool is_ahead(struct tri_point a, struct tri_point b, struct tri_point q)
{
    return (b.x - a.x) * (q.x - a.x) + (b.y - a.y) * (q.y - a.y) > 0;
}

/* Does the ray from corner k of t to vertex `to` leave through t? Both edges count as parts of t, because there may be
 * no triangle beyond the left edge. */
static bool leaves_through(const struct tri_mesh *mesh, tri_triangle_id t, int k, tri_vertex_id to)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    if (v[tri_next[k]] == to || v[tri_prev[k]] == to)
        return true;
    struct tri_point a = mesh->xy[v[k]], right = mesh->xy[v[tri_next[k]]], left = mesh->xy[v[tri_prev[k]]];
    struct tri_point q = mesh->xy[to];
    double r = tri_orient2d(a, right, q), s = tri_orient2d(a, left, q);
    return (r > 0 && s < 0) || (r == 0 && is_ahead(a, right, q)) || (s == 0 && is_ahead(a, left, q));
}

/* State of a search around a vertex, one triangle per step. The result is the triangle that the ray from the vertex to
 * vertex `to` enters first. */
struct rotation {
    tri_vertex_id vertex;
    tri_triangle_id start, t;
    tri_vertex_id to;
    bool clockwise;
};

static struct rotation rotate_from(const tri_triangle_id *corner, tri_vertex_id a, tri_vertex_id to)
{
    assert(corner[a] != TRI_NONE);
    return (struct rotation){a, corner[a], corner[a], to, false};
}

/* Returns the current triangle if the ray leaves through it. Otherwise moves on to the next triangle and returns
 * TRI_NONE. After the last one r->t is TRI_NONE. */
static tri_triangle_id rotate_step(const struct tri_mesh *mesh, struct rotation *r)
{
    tri_triangle_id t = r->t;
    int k = tri_corner_of(&mesh->tri[t], r->vertex);
    if (leaves_through(mesh, t, k, r->to))
        return t;
    r->t = next_around(mesh, t, r->vertex, !r->clockwise);
    if (r->t == TRI_NONE && !r->clockwise) { /* continue clockwise, from the neighbour of the first one */
        r->clockwise = true;
        r->t = next_around(mesh, r->start, r->vertex, false);
    } else if (r->t == r->start) {
        r->t = TRI_NONE;
    }
    return TRI_NONE;
}

tri_triangle_id tri_find_exit(const struct tri_mesh *mesh, tri_triangle_id *corner, tri_vertex_id *a, tri_vertex_id *b)
{
    const tri_vertex_id from = *a, to = *b;
    tri_triangle_id found = TRI_NONE;
    struct rotation at[2] = {rotate_from(corner, from, to), rotate_from(corner, to, from)};
    int end = 0;
    for (int n = 0; at[end].t != TRI_NONE && (found = rotate_step(mesh, &at[end])) == TRI_NONE;)
        end = n < HUB ? (n++, 0) : 1 - end;
    if (found == TRI_NONE)
        return TRI_NONE;
    *a = end == 0 ? from : to;
    *b = end == 0 ? to : from;
    return corner[*a] = found;
}
