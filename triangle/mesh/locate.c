/* First, each point is located by a walk that starts where the last walk ended, with the points sorted along a Hilbert
 * curve. If triangles are long and thin, no order of the points keeps walks short. So the total number of steps is
 * limited to the number of triangles, and the remaining points are located by a plane sweep.
 *
 * THE PLANE SWEEP visits the subsegments from left to right and keeps their order along the sweep line in a tree
 * (Shamos & Hoey 1976). Subsegments do not cross, so the triangle above the nearest subsegment below a point lies in
 * the point's face. */
#include "triangle/mesh/locate.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/heap_sort.h"
#include "triangle/base/order.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/geometry/predicates.h"

enum { NOT_FOUND = -2 };

struct walk {
    const struct tri_mesh *mesh;
    tri_triangle_id at; /* the triangle where the last walk ended */
    int64_t steps; /* steps left */
};

/* One step of a visibility walk to q. Returns the triangle across an edge of t that separates t from q, TRI_NONE if
 * that edge is on the boundary, or t if t holds q. In a constrained triangulation such a walk may cycle, so the first
 * edge to be tested changes with the step number. */
static tri_triangle_id step_towards(const struct tri_mesh *mesh, tri_triangle_id t, int64_t step, struct tri_point q)
{
    assert(step >= 0 && tri_is_live(&mesh->tri[t]));
    const tri_vertex_id *v = mesh->tri[t].v;
    for (int k = 0; k < 3; k++) {
        int e = (int)((k + step) % 3);
        if (tri_orient2d(mesh->xy[v[tri_next[e]]], mesh->xy[v[tri_prev[e]]], q) < 0) {
            tri_halfedge beyond = tri_across(mesh, tri_code(t, e));
            return beyond == TRI_NONE ? TRI_NONE : tri_of(beyond);
        }
    }
    return t;
}

/* Returns the triangle that holds q, TRI_NONE if q is outside the hull (the hull is convex, so a walk that leaves it
 * cannot return), or NOT_FOUND if the step limit was reached. */
static tri_triangle_id walk_to(struct walk *w, struct tri_point q)
{
    for (; w->steps > 0; w->steps--) {
        tri_triangle_id next = step_towards(w->mesh, w->at, w->steps, q);
        if (next == w->at || next == TRI_NONE)
            return next;
        w->at = next;
    }
    return NOT_FOUND;
}

/* --- the plane sweep */

struct event {
    struct tri_point at;
    tri_halfedge code; /* 2 * subsegment + end (0: left, 1: right), or ~number of a point */
};

struct sweep {
    const struct tri_mesh *mesh;
    struct event *event; /* [2 * n_subs + points] */
    int32_t n_events;
    int32_t *start; /* [n_subs] work space: subsegments that start at one point */
    struct tri_order order;
};

/* At the same point, subsegments come before query points. */
static int compare_events(const void *a, const void *b)
{
    const struct event *e = a, *f = b;
    int order = tri_compare_places(e->at, f->at);
    return order != 0 ? order : (e->code < f->code) - (e->code > f->code);
}

/* Returns which end of the subsegment is the left one: 0 or 1. */
static int left_end(const struct tri_mesh *mesh, tri_sub_id s)
{
    const tri_vertex_id *v = mesh->sub[s].v;
    return tri_compare_places(mesh->xy[v[0]], mesh->xy[v[1]]) > 0;
}

static struct tri_point end_of(const struct tri_mesh *mesh, tri_sub_id s, int right)
{
    return mesh->xy[mesh->sub[s].v[left_end(mesh, s) ^ right]];
}

/* > 0: q lies above subsegment s; 0: q lies on its line. */
static double height_over(const struct tri_mesh *mesh, tri_sub_id s, struct tri_point q)
{
    assert(s >= 0 && s < mesh->n_subs);
    return tri_orient2d(end_of(mesh, s, 0), end_of(mesh, s, 1), q);
}

struct place {
    const struct tri_mesh *mesh;
    struct tri_point q;
};

static bool is_below(const void *place, tri_sub_id s)
{
    const struct place *at = place;
    return height_over(at->mesh, s, at->q) > 0;
}

/* Returns the highest subsegment below q, or TRI_NONE. */
static tri_sub_id find_below(const struct sweep *w, struct tri_point q)
{
    return tri_order_find(&w->order, is_below, &(struct place){w->mesh, q});
}

/* Does a lie below b? Both start at the same point. */
static bool is_lower(const void *mesh, tri_sub_id a, tri_sub_id b)
{
    return height_over(mesh, a, end_of(mesh, b, 1)) > 0;
}

/* Handles the events at one point: removes subsegments that end there and inserts those that start there. */
static void handle_ends(struct sweep *w, const struct event *event, int32_t n)
{
    int32_t n_start = 0;
    assert(n > 0);
    for (int32_t i = 0; i < n; i++) {
        if (event[i].code & 1)
            tri_order_remove(&w->order, event[i].code >> 1);
        else
            w->start[n_start++] = event[i].code >> 1;
    }
    tri_heap_sort(w->start, n_start, is_lower, w->mesh);
    assert(n_start <= w->mesh->n_subs);
    tri_sub_id below = find_below(w, event->at);
    for (int32_t i = 0; i < n_start; i++) {
        tri_order_insert(&w->order, w->start[i], below);
        below = w->start[i];
    }
}

/* Returns the triangle above subsegment s. If q lies on s and there is no triangle above, returns the one below. */
static tri_triangle_id face_at(const struct tri_mesh *mesh, tri_sub_id s, bool is_on)
{
    const tri_halfedge *side = mesh->sub[s].side;
    int above = left_end(mesh, s); /* the left side, if the subsegment runs to the right */
    tri_halfedge code = side[above] != TRI_NONE || !is_on ? side[above] : side[1 - above];
    return code == TRI_NONE ? TRI_NONE : tri_of(code);
}

static tri_triangle_id face_of(const struct sweep *w, struct tri_point q)
{
    tri_sub_id below = find_below(w, q), next = tri_order_above(&w->order, below);
    if (next != TRI_NONE && height_over(w->mesh, next, q) == 0)
        return face_at(w->mesh, next, true);
    return below == TRI_NONE ? TRI_NONE : face_at(w->mesh, below, false);
}

static void list_events(struct sweep *w, const struct tri_point *points, int32_t n, const tri_triangle_id *faces)
{
    for (tri_sub_id s = 0; s < w->mesh->n_subs; s++)
        for (int right = 0; right < 2; right++)
            w->event[w->n_events++] = (struct event){end_of(w->mesh, s, right), 2 * s + right};
    for (int32_t i = 0; i < n; i++)
        if (faces[i] == NOT_FOUND)
            w->event[w->n_events++] = (struct event){points[i], ~i};
    assert(w->n_events >= 2 * w->mesh->n_subs && w->n_events <= 2 * w->mesh->n_subs + n);
    qsort(w->event, (size_t)w->n_events, sizeof *w->event, compare_events);
}

static void sweep(struct sweep *w, tri_triangle_id *faces)
{
    for (int32_t i = 0, n_ends, end; i < w->n_events; i = end) {
        for (end = i; end < w->n_events && tri_compare_places(w->event[i].at, w->event[end].at) == 0;)
            end++;
        for (n_ends = 0; i + n_ends < end && w->event[i + n_ends].code >= 0;)
            n_ends++;
        if (n_ends > 0)
            handle_ends(w, &w->event[i], n_ends);
        int32_t face = n_ends > 0 ? face_at(w->mesh, w->event[i].code >> 1, true) : face_of(w, w->event[i].at);
        for (int32_t k = i + n_ends; k < end; k++)
            faces[~w->event[k].code] = face;
    }
    assert(tri_order_above(&w->order, TRI_NONE) == TRI_NONE);
}

static enum tri_status locate_by_sweep(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n,
                                 tri_triangle_id *faces, struct tri_error *error)
{
    struct sweep w = {.mesh = mesh};
    size_t n_subs = (size_t)mesh->n_subs;
    w.event = malloc((2 * n_subs + (size_t)n) * sizeof *w.event);
    w.start = malloc((n_subs + 1) * sizeof *w.start);
    bool room = tri_order_init(&w.order, mesh->n_subs) == TRI_OK && w.event && w.start;
    if (room) {
        list_events(&w, points, n, faces);
        sweep(&w, faces);
    }
    free(w.event);
    free(w.start);
    tri_order_clear(&w.order);
    return room ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to locate %d points", (int)n);
}

/* --- walks and sweep combined */

/* Lists the points within the range of the predicates in `order`, sorted along the curve. Returns their number. */
static int32_t sort_points_in_range(const struct tri_point *points, int32_t n, int32_t *order, uint64_t *scratch)
{
    int32_t n_order = 0;
    for (int32_t i = 0; i < n; i++)
        if (tri_is_in_range(points[i]))
            order[n_order++] = i;
    tri_hilbert_order(points, order, n_order, scratch, NULL);
    return n_order;
}

enum tri_status tri_locate_faces(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n,
                                 tri_triangle_id *faces, struct tri_error *error)
{
    int32_t *order = malloc(((size_t)n + 1) * sizeof *order);
    uint64_t *scratch = malloc((2 * (size_t)n + 1) * sizeof *scratch);
    bool room = order && scratch, all = true;
    if (room) {
        struct walk w = {mesh, 0, mesh->n_triangles};
        for (int32_t i = 0; i < n; i++)
            faces[i] = TRI_NONE; /* points out of range are outside */
        int32_t n_order = mesh->n_triangles > 0 ? sort_points_in_range(points, n, order, scratch) : 0;
        for (int32_t i = 0; i < n_order; i++) {
            faces[order[i]] = walk_to(&w, points[order[i]]);
            all = all && faces[order[i]] != NOT_FOUND;
        }
    }
    free(order);
    free(scratch);
    if (!room)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to locate %d points", (int)n);
    return all ? TRI_OK : locate_by_sweep(mesh, points, n, faces, error);
}

tri_triangle_id tri_walk_to(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q)
{
    for (int64_t step = 0; step < 3 * (int64_t)mesh->n_triangles; step++) {
        tri_triangle_id next = step_towards(mesh, t, step, q);
        if (next == t || next == TRI_NONE)
            return next;
        t = next;
    }
    return TRI_NONE;
}

tri_sub_id tri_sub_under(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q)
{
    const struct tri_triangle *at = &mesh->tri[t];
    for (int e = 0; e < 3; e++)
        if (at->n[e] < 0 && tri_orient2d(mesh->xy[at->v[tri_next[e]]], mesh->xy[at->v[tri_prev[e]]], q) == 0)
            return ~at->n[e];
    return TRI_NONE;
}
