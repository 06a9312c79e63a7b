/* Lawson's flips (1977). If the vertex across an edge lies in the circumcircle of a triangle, the edge is replaced by
 * the other diagonal of its quadrilateral, provided that is convex. Each flip lowers the surface of the triangulation
 * lifted to the paraboloid, so the algorithm ends, at the constrained Delaunay triangulation (Lee & Lin 1986). */
#include "triangle/cdt/flip.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

void tri_flips_free(struct tri_flips *f) { free(f->touched); }

static bool make_room(struct tri_flips *f)
{
    return tri_grow(&f->touched, &f->capacity, f->n_touched + 3, sizeof *f->touched);
}

bool tri_flip_touch(struct tri_flips *f, tri_triangle_id t)
{
    assert(t >= 0 && t < f->mesh->n_triangles && tri_is_live(&f->mesh->tri[t]));
    if (!make_room(f))
        return false;
    for (int e = 0; e < 3; e++)
        f->touched[f->n_touched++] = tri_code(t, e);
    return true;
}

/* With near apex n, right r, far apex o and left s, t becomes (n, r, o) and the neighbour becomes (n, o, s). */
tri_triangle_id tri_flip_edge(struct tri_flips *f, tri_triangle_id t, int e)
{
    struct tri_mesh *mesh = f->mesh;
    struct tri_triangle *near = &mesh->tri[t];
    tri_triangle_id u = tri_of(near->n[e]);
    int g = tri_edge(near->n[e]);
    struct tri_triangle *far = &mesh->tri[u];
    assert(near->n[e] >= 0 && far->n[g] == tri_code(t, e));
    tri_vertex_id n = near->v[e], r = near->v[tri_next[e]], s = near->v[tri_prev[e]], o = far->v[g];
    tri_link nr = near->n[tri_prev[e]], sn = near->n[tri_next[e]];
    tri_link ro = far->n[tri_next[g]], os = far->n[tri_prev[g]];
    assert(far->v[tri_next[g]] == s && far->v[tri_prev[g]] == r && n != o);
    near->v[0] = n, near->v[1] = r, near->v[2] = o;
    near->n[0] = ro, near->n[1] = tri_code(u, 2), near->n[2] = nr;
    far->v[0] = n, far->v[1] = o, far->v[2] = s;
    far->n[0] = os, far->n[1] = sn, far->n[2] = tri_code(t, 1);
    tri_relink(mesh, ro, r, tri_code(t, 0));
    tri_relink(mesh, nr, n, tri_code(t, 2));
    tri_relink(mesh, os, o, tri_code(u, 0));
    tri_relink(mesh, sn, s, tri_code(u, 1));
    if (f->corner) {
        f->corner[n] = f->corner[r] = f->corner[o] = t;
        f->corner[s] = u;
    }
    if (f->degree) {
        f->degree[n]++, f->degree[o]++;
        f->degree[r]--, f->degree[s]--;
    }
    return u;
}

static bool is_convex(const struct tri_mesh *mesh, tri_triangle_id t, int e)
{
    assert(mesh->tri[t].n[e] >= 0);
    const struct tri_triangle *near = &mesh->tri[t];
    struct tri_point n = mesh->xy[near->v[e]], r = mesh->xy[near->v[tri_next[e]]], s = mesh->xy[near->v[tri_prev[e]]];
    struct tri_point o = mesh->xy[tri_apex(mesh, near->n[e])];
    return tri_orient2d(n, r, o) > 0 && tri_orient2d(n, o, s) > 0;
}

/* Does the apex across edge e of t lie inside the circumcircle of t? */
static bool is_illegal(const struct tri_flips *f, tri_triangle_id t, int e)
{
    const struct tri_mesh *mesh = f->mesh;
    const tri_vertex_id *v = mesh->tri[t].v;
    tri_link link = mesh->tri[t].n[e];
    assert(link >= 0 && tri_is_live(&mesh->tri[tri_of(link)]));
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    struct tri_point apex = mesh->xy[tri_apex(mesh, link)];
    return f->ties_stay ? tri_incircle(a, b, c, apex) > 0 : tri_in_circle(a, b, c, apex);
}

/* Do all corners of t, and the apex across its edge e, belong to the block? */
static bool is_in_block(const struct tri_flips *f, tri_triangle_id t, int e)
{
    const struct tri_mesh *mesh = f->mesh;
    const tri_vertex_id *v = mesh->tri[t].v;
    return f->home[v[0]] == f->block && f->home[v[1]] == f->block && f->home[v[2]] == f->block &&
           f->home[tri_apex(mesh, mesh->tri[t].n[e])] == f->block;
}

bool tri_flip_legalise(struct tri_flips *f)
{
    struct tri_mesh *mesh = f->mesh;
    while (f->n_touched > 0) {
        tri_halfedge code = f->touched[--f->n_touched];
        tri_triangle_id t = tri_of(code);
        int e = tri_edge(code);
        if (mesh->tri[t].n[e] < 0 || (f->home && !is_in_block(f, t, e)) || !is_illegal(f, t, e) ||
            !is_convex(mesh, t, e))
            continue;
        if (f->history && !tri_flip_history_add(f->history, mesh, t, e))
            return false;
        tri_triangle_id u = tri_flip_edge(f, t, e);
        if (!tri_flip_touch(f, t) || !tri_flip_touch(f, u))
            return false;
    }
    return true;
}

/* --- flips in a whole mesh */

/* Triangles with an edge to be flipped, found in parallel over shares of the mesh. Each edge is tested from its
 * triangle with the lower number. */
struct flip_candidates {
    struct tri_flips *flips;
    tri_triangle_id *candidate; /* [n_triangles] one list per share, starting at the first triangle of the share */
    int32_t n[TRI_MOST_SHARES];
};

static void list_candidates_share(void *context, size_t share)
{
    struct flip_candidates *s = context;
    const struct tri_mesh *mesh = s->flips->mesh;
    struct tri_range range = tri_share(share, mesh->n_triangles);
    uint32_t step = 0;
    for (tri_triangle_id t = range.first; t < range.last && !tri_stop_is_due(mesh->stop, &step); t++)
        for (int e = 0; e < 3; e++)
            if (mesh->tri[t].n[e] > tri_code(t, e) && is_illegal(s->flips, t, e)) {
                s->candidate[range.first + s->n[share]++] = t;
                break;
            }
    assert(s->n[share] <= range.last - range.first);
}

/* Touches the edges to triangles with higher numbers, so each edge is touched from one side only. */
static bool touch_upwards(struct tri_flips *f, tri_triangle_id t)
{
    if (!make_room(f))
        return false;
    for (int e = 0; e < 3; e++)
        if (f->mesh->tri[t].n[e] > tri_code(t, e))
            f->touched[f->n_touched++] = tri_code(t, e);
    return true;
}

/* Flips until all edges are Delaunay. An edge not changed by any flip has been tested; all others have been touched and
 * made legal. */
static enum tri_status flip_all(const struct flip_candidates *s, struct tri_error *error)
{
    struct tri_flips *f = s->flips;
    enum tri_status status = tri_stop_is_asked(f->mesh->stop) ? tri_fail_stopped(error) : TRI_OK;
    uint32_t step = 0;
    for (size_t share = 0; share < tri_shares(f->mesh->n_triangles); share++) {
        const tri_triangle_id *candidate = s->candidate + tri_share(share, f->mesh->n_triangles).first;
        for (int32_t i = 0; !status && i < s->n[share]; i++)
            if (tri_stop_is_due(f->mesh->stop, &step))
                status = tri_fail_stopped(error);
            else if (!touch_upwards(f, candidate[i]) || !tri_flip_legalise(f))
                status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for flips");
    }
    return status;
}

enum tri_status tri_flip_to_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor,
                                     struct tri_error *error)
{
    struct tri_flip_history history = {0};
    struct tri_flips f = {.mesh = mesh, .ties_stay = true, .history = mesh->n_regions > 1 ? &history : NULL};
    struct flip_candidates s = {&f, malloc(((size_t)mesh->n_triangles + 1) * sizeof *s.candidate), {0}};
    enum tri_status status = TRI_OK;
    if (!s.candidate || (f.history && !tri_flip_history_begin(f.history, mesh)))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for flips");
    if (!status) {
        tri_execute(executor, tri_shares(mesh->n_triangles), list_candidates_share, &s);
        status = flip_all(&s, error);
    }
    if (!status && f.history)
        tri_flip_history_settle(f.history, mesh);
    tri_flip_history_free(&history);
    tri_flips_free(&f);
    free(s.candidate);
    return status;
}

/* Regions are restored by walking back through the flips. Before a flip, a point of its quadrilateral lay in that one
 * of the two triangles which is on the point's side of the old diagonal. So a walk from flip to earlier flip, starting
 * at the triangle that holds the point now, ends at the number of the triangle that held it first. The side is decided
 * exactly. If rounding has moved a centroid out of its triangle, the walk ends at a nearby triangle in the same face,
 * because no flip crosses a subsegment. */

struct tri_flip_record {
    tri_triangle_id left, right; /* triangles on both sides of the old diagonal, whose numbers the new ones reuse */
    tri_vertex_id from, to;      /* ends of the old diagonal */
    int32_t left_before, right_before; /* previous flip of each of these triangles, or TRI_NONE */
};

bool tri_flip_history_begin(struct tri_flip_history *h, const struct tri_mesh *mesh)
{
    *h = (struct tri_flip_history){.last = malloc(((size_t)mesh->n_triangles + 1) * sizeof *h->last)};
    for (tri_triangle_id t = 0; h->last && t < mesh->n_triangles; t++)
        h->last[t] = TRI_NONE;
    return h->last;
}

void tri_flip_history_free(struct tri_flip_history *h)
{
    free(h->last);
    free(h->flip);
}

/* The number of flips may be quadratic, so the history is limited. If it is settled early, regions move slightly, as
 * they do when refinement follows refinement. */
static bool is_long(const struct tri_flip_history *h, const struct tri_mesh *mesh)
{
    enum { MOST = 4, FEW = 1 << 20 };
    return h->n > FEW && h->n / MOST >= mesh->n_triangles;
}

bool tri_flip_history_add(struct tri_flip_history *h, struct tri_mesh *mesh, tri_triangle_id t, int e)
{
    const tri_triangle_id u = tri_of(mesh->tri[t].n[e]);
    assert(mesh->tri[t].n[e] >= 0 && t != u);
    if (is_long(h, mesh))
        tri_flip_history_settle(h, mesh);
    if (!tri_grow(&h->flip, &h->capacity, h->n + 1, sizeof *h->flip))
        return false;
    const tri_vertex_id *v = mesh->tri[t].v;
    h->flip[h->n] = (struct tri_flip_record){t, u, v[tri_next[e]], v[tri_prev[e]], h->last[t], h->last[u]};
    h->last[t] = h->last[u] = h->n++;
    return true;
}

static tri_region_id region_before(const struct tri_flip_history *h, const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    const struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    const struct tri_point centroid = {tri_round_coordinate((a.x + b.x + c.x) / 3),
                                       tri_round_coordinate((a.y + b.y + c.y) / 3)};
    for (int32_t at = h->last[t]; at != TRI_NONE;) {
        const struct tri_flip_record *flip = &h->flip[at];
        const bool left = tri_orient2d(mesh->xy[flip->from], mesh->xy[flip->to], centroid) >= 0;
        const int32_t before = left ? flip->left_before : flip->right_before;
        assert(before < at);
        t = left ? flip->left : flip->right;
        at = before;
    }
    return mesh->tri[t].region;
}

void tri_flip_history_settle(struct tri_flip_history *h, struct tri_mesh *mesh)
{
    /* A walk reads only h->last of the triangle at which it starts. So its result can be stored there, and is copied to
     * the mesh after all walks. */
    for (tri_triangle_id t = 0; h->n > 0 && t < mesh->n_triangles; t++)
        if (h->last[t] != TRI_NONE)
            h->last[t] = region_before(h, mesh, t);
    for (tri_triangle_id t = 0; h->n > 0 && t < mesh->n_triangles; t++)
        if (h->last[t] != TRI_NONE) {
            mesh->tri[t].region = h->last[t];
            h->last[t] = TRI_NONE;
        }
    h->n = 0;
}
