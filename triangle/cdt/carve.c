/* Flood fills over triangles that stop at segments.
 *
 * INVARIANT: a flood marks whole components of the mesh minus its segments, so a dead and a live triangle can only meet
 * at a subsegment. Therefore removing dead triangles changes links of subsegments only. Dead triangles have the region
 * DEAD. */
#include "triangle/cdt/carve.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/locate.h"

enum { DEAD = -1 };

struct flood {
    struct tri_mesh *mesh;
    int32_t open;      /* floods cross segments from this number on */
    int32_t *stack;    /* [n_triangles]; each flood pushes a triangle at most once */
    struct tri_carve_report report;
    struct tri_emptied holes;
};

static bool is_dead(const struct flood *f, tri_triangle_id t) { return f->mesh->tri[t].region == DEAD; }

/* Returns the half-edge across an edge that floods cross; TRI_NONE: they do not. */
static tri_halfedge passage(const struct flood *f, tri_triangle_id t, int e)
{
    const tri_link link = f->mesh->tri[t].n[e];
    if (link >= 0 || f->mesh->parents[f->mesh->sub[~link].parent].segment < f->open)
        return link >= 0 ? link : TRI_NONE;
    return tri_across(f->mesh, tri_code(t, e));
}

/* Assigns the region to all triangles reachable from `start` that have no region yet. */
static void flood_from(const struct flood *f, tri_triangle_id start, tri_region_id region)
{
    struct tri_triangle *tri = f->mesh->tri;
    int32_t n = 0;
    assert(start >= 0 && start < f->mesh->n_triangles);
    if (tri[start].region != 0)
        return;
    tri[start].region = region;
    f->stack[n++] = start;
    while (n > 0) {
        tri_triangle_id t = f->stack[--n];
        for (int e = 0; e < 3; e++) {
            const tri_halfedge beyond = passage(f, t, e);
            if (beyond != TRI_NONE && tri[tri_of(beyond)].region == 0) {
                assert(n < f->mesh->n_triangles);
                tri[tri_of(beyond)].region = region;
                f->stack[n++] = tri_of(beyond);
            }
        }
    }
}

/* Is the edge a hull edge along which no input segment runs, or only segments that floods cross? */
static bool is_bare_hull(const struct flood *f, tri_triangle_id t, int e)
{
    const tri_link link = f->mesh->tri[t].n[e];
    if (link >= 0 || tri_across(f->mesh, tri_code(t, e)) != TRI_NONE)
        return false;
    const int32_t segment = f->mesh->parents[f->mesh->sub[~link].parent].segment;
    return segment == TRI_NONE || segment >= f->open;
}

static void kill_concavities(struct flood *f)
{
    const struct tri_mesh *mesh = f->mesh;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int e = 0; e < 3; e++)
            if (is_bare_hull(f, t, e))
                flood_from(f, t, DEAD);
}

/* --- depth (carve.h, even_odd) */

enum { UNSEEN, WAITING, SEEN };

/* State of a breadth-first traversal by depth: `stack` holds triangles of the current depth, `next` those across its
 * barriers. */
struct depth_flood {
    const struct tri_mesh *mesh;
    uint8_t *state;         /* [n_triangles] UNSEEN, WAITING or SEEN */
    int32_t *stack, *next;  /* [n_triangles] */
    int32_t n, n_next;
};

static void visit_triangle(struct depth_flood *d, tri_triangle_id t)
{
    if (d->state[t] == SEEN)
        return;
    assert(d->n < d->mesh->n_triangles);
    d->state[t] = SEEN;
    d->stack[d->n++] = t;
}

static void defer_triangle(struct depth_flood *d, tri_triangle_id t)
{
    if (d->state[t] != UNSEEN)
        return;
    assert(d->n_next < d->mesh->n_triangles);
    d->state[t] = WAITING;
    d->next[d->n_next++] = t;
}

static void cross_edge(struct depth_flood *d, tri_halfedge code)
{
    tri_link link = *tri_link_at(d->mesh, code);
    tri_halfedge other = tri_across(d->mesh, code);
    if (other == TRI_NONE)
        return;
    if (link < 0 && d->mesh->parents[d->mesh->sub[~link].parent].odd)
        defer_triangle(d, tri_of(other));
    else
        visit_triangle(d, tri_of(other));
}

/* Starts at the triangles along the hull: at depth 0, or at depth 1 if the hull edge is a barrier. Pushes those at
 * depth 0 first. */
static void enter_hull(struct depth_flood *d, bool keep_hull)
{
    const struct tri_mesh *mesh = d->mesh;
    for (int pass = 0; pass < 2; pass++)
        for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
            for (int e = 0; e < 3; e++) {
                tri_link link = mesh->tri[t].n[e];
                if (link >= 0 || tri_across(mesh, tri_code(t, e)) != TRI_NONE)
                    continue;
                const struct tri_parent *parent = &mesh->parents[mesh->sub[~link].parent];
                bool barrier = parent->odd || (keep_hull && parent->segment == TRI_NONE);
                if (pass == 0 && !barrier)
                    visit_triangle(d, t);
                if (pass == 1 && barrier)
                    defer_triangle(d, t);
            }
}

/* INVARIANT: each depth is flooded completely before the next one, so a triangle is first seen at its least depth. A
 * triangle waits at most once, and visit_triangle() may visit it while it waits. */
static void kill_depths(struct flood *f, struct depth_flood *d, bool keep_hull)
{
    enter_hull(d, keep_hull);
    for (bool even = true; d->n + d->n_next > 0; even = !even) {
        while (d->n > 0) {
            tri_triangle_id t = d->stack[--d->n];
            assert(d->state[t] == SEEN);
            if (even)
                f->mesh->tri[t].region = DEAD;
            for (int e = 0; e < 3; e++)
                cross_edge(d, tri_code(t, e));
        }
        int32_t n = d->n_next;
        d->n_next = 0;
        for (int32_t k = 0; k < n; k++)
            visit_triangle(d, d->next[k]);
    }
}

static enum tri_status kill_even(struct flood *f, bool keep_hull, struct tri_error *error)
{
    size_t n = (size_t)f->mesh->n_triangles + 1;
    struct depth_flood d = {f->mesh, calloc(n, 1), f->stack, malloc(n * sizeof *d.next), 0, 0};
    enum tri_status status = TRI_OK;
    if (d.state && d.next)
        kill_depths(f, &d, keep_hull);
    else
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the depth of %d triangles",
                          (int)f->mesh->n_triangles);
    free(d.state);
    free(d.next);
    return status;
}

/* --- point location */

/* Locates n points, whose coordinates are the first two of every `width` numbers. The caller frees *faces. */
static enum tri_status locate(const struct tri_mesh *mesh, const double *places, int32_t n, int32_t width,
                              int32_t **faces, struct tri_error *error)
{
    struct tri_point *points = malloc(((size_t)n + 1) * sizeof *points);
    assert(n >= 0 && width >= 2);
    *faces = malloc(((size_t)n + 1) * sizeof **faces);
    enum tri_status status = TRI_OK;
    if (!points || !*faces)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to locate %d points", (int)n);
    for (int32_t k = 0; !status && k < n; k++) {
        const double *at = places + (size_t)k * (size_t)width;
        points[k] = tri_to_units(mesh, at[0], at[1]);
    }
    status = status ? status : tri_locate_faces(mesh, points, n, *faces, error);
    free(points);
    return status;
}

/* Does a subsegment that stops floods end at corner k of triangle t? */
static bool ends_sub(const struct flood *f, tri_triangle_id t, int k)
{
    tri_vertex_id v = f->mesh->tri[t].v[k];
    tri_triangle_id at = t;
    do {
        tri_halfedge beyond = passage(f, at, tri_next[tri_corner_of(&f->mesh->tri[at], v)]);
        if (beyond == TRI_NONE)
            return true;
        at = tri_of(beyond);
    } while (at != t);
    return false;
}

/* Does q lie on a subsegment that stops floods? t is the triangle that tri_locate_faces has returned for q; in this
 * case q is on its boundary. */
static bool is_between_faces(const struct flood *f, tri_triangle_id t, struct tri_point q)
{
    const struct tri_mesh *mesh = f->mesh;
    const tri_vertex_id *v = mesh->tri[t].v;
    bool on_sub = false;
    for (int k = 0; k < 3; k++)
        if (tri_compare_places(mesh->xy[v[k]], q) == 0)
            return ends_sub(f, t, k);
    for (int e = 0; e < 3; e++) {
        double side = tri_orient2d(mesh->xy[v[tri_next[e]]], mesh->xy[v[tri_prev[e]]], q);
        if (side < 0)
            return false;
        on_sub = on_sub || (side == 0 && passage(f, t, e) == TRI_NONE);
    }
    return on_sub;
}

static enum tri_status kill_holes(struct flood *f, const struct tri_pslg *pslg, struct tri_error *error)
{
    int32_t *faces;
    enum tri_status status = locate(f->mesh, pslg->holes, pslg->n_holes, 2, &faces, error);
    for (int32_t k = 0; !status && k < pslg->n_holes; k++) {
        const double *at = &pslg->holes[2 * (size_t)k];
        if (faces[k] == TRI_NONE)
            continue;
        if (is_between_faces(f, faces[k], tri_to_units(f->mesh, at[0], at[1]))) {
            f->report.between++;
        } else if (!is_dead(f, faces[k])) {
            f->holes.first = f->holes.n++ == 0 ? k : f->holes.first;
            flood_from(f, faces[k], DEAD);
        }
    }
    free(faces);
    return status;
}

static enum tri_status spread_regions(struct flood *f, const struct tri_pslg *pslg, struct tri_error *error)
{
    struct tri_mesh *mesh = f->mesh;
    if (!tri_resize(&mesh->regions, (size_t)pslg->n_regions + 1, sizeof *mesh->regions))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for regions");
    assert(mesh->n_regions == 1 && !mesh->columns); /* only the entry "no region" */
    mesh->n_regions = pslg->n_regions + 1;
    int32_t *faces;
    enum tri_status status = locate(mesh, pslg->regions, pslg->n_regions, 4, &faces, error);
    for (int32_t k = pslg->n_regions - 1; !status && k >= 0; k--) { /* backwards: a face keeps the last region point */
        const double *r = &pslg->regions[4 * (size_t)k];
        mesh->regions[k + 1] = (struct tri_region){r[2], r[3]};
        if (faces[k] != TRI_NONE)
            flood_from(f, faces[k], k + 1);
    }
    free(faces);
    return status;
}

void tri_mark_ends(struct tri_mesh *mesh, const tri_vertex_id v[2], int32_t marker)
{
    for (int k = 0; k < 2; k++)
        if (mesh->vertex_markers[v[k]] == 0)
            mesh->vertex_markers[v[k]] = marker;
}

void tri_mark_vertices(struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        tri_mark_ends(mesh, mesh->sub[s].v, mesh->sub[s].marker);
}

/* For each edge of a removed triangle that remains as a part of the boundary, sets the parent's guard to the centroid
 * of the triangle. The triangle of an edge and the centroid is then reserved for the parent; no two of these
 * overlap. */
static void guard_boundary(const struct flood *f, tri_triangle_id t)
{
    const struct tri_mesh *mesh = f->mesh;
    const struct tri_triangle *at = &mesh->tri[t];
    assert(is_dead(f, t) && tri_is_live(at));
    struct tri_point a = mesh->xy[at->v[0]], b = mesh->xy[at->v[1]], c = mesh->xy[at->v[2]];
    struct tri_point centroid = {tri_round_coordinate((a.x + b.x + c.x) / 3),
                                 tri_round_coordinate((a.y + b.y + c.y) / 3)};
    bool inside = tri_is_inside(a, b, c, centroid);
    for (int e = 0; e < 3; e++)
        if (at->n[e] < 0) {
            struct tri_parent *parent = &mesh->parents[mesh->sub[~at->n[e]].parent];
            parent->guard = inside ? centroid : mesh->xy[parent->v[1]];
        }
}

static void remove_dead(const struct flood *f)
{
    struct tri_mesh *mesh = f->mesh;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        if (is_dead(f, t))
            guard_boundary(f, t);
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++) {
        struct tri_triangle *at = &mesh->tri[t];
        if (!is_dead(f, t))
            continue;
        for (int e = 0; e < 3; e++) {
            assert(at->n[e] < 0 || is_dead(f, tri_of(at->n[e])));
            if (at->n[e] < 0)
                mesh->sub[~at->n[e]].side[tri_side(&mesh->sub[~at->n[e]], at->v[tri_next[e]])] = TRI_NONE;
        }
        at->v[0] = at->v[1] = at->v[2] = TRI_NONE;
    }
    tri_mesh_compact(mesh);
}

/* --- order of the remaining subsegments */

/* Subsegments and their parents, being sorted. */
struct sorting {
    int32_t *start; /* [n_segments + 2] next position for each input segment; the last is for hull edges without one */
    struct tri_subsegment *sub; /* [n_subs] */
    struct tri_parent *parent;  /* [n_subs] */
};

static bool has_triangle(const struct tri_subsegment *s) { return s->side[0] != TRI_NONE || s->side[1] != TRI_NONE; }

/* Sorts the subsegments that still have a triangle by input segment (counting sort). Returns their number. */
static int32_t sort_subs(const struct tri_mesh *mesh, struct sorting *to, int32_t n_segments)
{
    int32_t kept = 0;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        int32_t k = mesh->parents[mesh->sub[s].parent].segment;
        assert(k == TRI_NONE || (k >= 0 && k < n_segments));
        if (has_triangle(&mesh->sub[s]))
            to->start[(k == TRI_NONE ? n_segments : k) + 1]++, kept++;
    }
    for (int32_t k = 0; k <= n_segments; k++)
        to->start[k + 1] += to->start[k];
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        const struct tri_parent *parent = &mesh->parents[mesh->sub[s].parent];
        if (!has_triangle(&mesh->sub[s]))
            continue;
        int32_t at = to->start[parent->segment == TRI_NONE ? n_segments : parent->segment]++;
        to->sub[at] = mesh->sub[s];
        to->parent[at] = *parent;
    }
    assert(to->start[n_segments] == kept);
    return kept;
}

static void store_subs(struct tri_mesh *mesh, const struct sorting *from, int32_t kept)
{
    for (tri_sub_id s = 0; s < kept; s++) {
        mesh->sub[s] = from->sub[s];
        mesh->sub[s].parent = s;
        mesh->parents[s] = from->parent[s];
        for (int side = 0; side < 2; side++)
            if (mesh->sub[s].side[side] != TRI_NONE)
                *tri_link_at(mesh, mesh->sub[s].side[side]) = ~s;
    }
    mesh->n_subs = mesh->n_parents = kept;
}

static enum tri_status order_subs(struct tri_mesh *mesh, int32_t n_segments, struct tri_error *error)
{
    size_t n = (size_t)mesh->n_subs + 1;
    struct sorting s = {calloc((size_t)n_segments + 2, sizeof *s.start), malloc(n * sizeof *s.sub),
                        malloc(n * sizeof *s.parent)};
    enum tri_status status = TRI_OK;
    assert(mesh->n_subs <= mesh->n_parents);
    if (s.start && s.sub && s.parent)
        store_subs(mesh, &s, sort_subs(mesh, &s, n_segments));
    else
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d subsegments", (int)mesh->n_subs);
    free(s.start);
    free(s.sub);
    free(s.parent);
    return status;
}

/* Marks the triangles to be removed. */
static enum tri_status mark_dead(struct flood *f, const struct tri_pslg *pslg, const struct tri_carve_options *options,
                            struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (options->even_odd)
        status = kill_even(f, options->keep_hull, error);
    else if (!options->keep_hull)
        kill_concavities(f);
    if (!status && !options->ignore_holes)
        status = kill_holes(f, pslg, error);
    tri_triangle_id t = 0;
    while (!status && t < f->mesh->n_triangles && is_dead(f, t))
        t++;
    if (!status && t == f->mesh->n_triangles)
        status = tri_why_empty(&f->report.why, f->mesh, options->even_odd, options->keep_hull, &f->holes, error);
    return status;
}

enum tri_status tri_carve(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_carve_options *options,
                          struct tri_error *error)
{
    size_t n = (size_t)mesh->n_triangles + 1;
    assert(mesh->n_subs == mesh->n_parents); /* each has its own parent */
    struct flood f = {.mesh = mesh, .open = pslg->n_segments - options->n_open, .stack = malloc(n * sizeof *f.stack)};
    enum tri_status status = TRI_OK;
    if (!f.stack)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)mesh->n_triangles);
    tri_mark_vertices(mesh);
    if (!status && mesh->n_triangles > 0) {
        status = mark_dead(&f, pslg, options, error);
        if (!status && options->spread_regions)
            status = spread_regions(&f, pslg, error);
        if (!status)
            remove_dead(&f);
    }
    if (options->report)
        *options->report = f.report;
    free(f.stack);
    return status ? status : order_subs(mesh, pslg->n_segments, error);
}

void tri_mark_boundary(struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        struct tri_subsegment *sub = &mesh->sub[s];
        if (!tri_is_boundary(sub))
            continue;
        if (sub->marker == 0)
            sub->marker = 1;
        tri_mark_ends(mesh, sub->v, 1);
    }
}
