/* A search around one end, or around both in turns. */
#include "triangle/cdt/rotation.h"

#include <assert.h>
#include <stdbool.h>

#include "triangle/geometry/predicates.h"

enum { HUB = 16 }; /* triangles around a vertex: with more it may be a hub */

/* The next triangle around v, counter-clockwise or clockwise; TRI_NONE at the boundary. */
static tri_triangle_id turn(const struct tri_mesh *mesh, tri_triangle_id t, tri_vertex_id v, bool left)
{
    int k = tri_corner_of(&mesh->tri[t], v);
    tri_halfedge code = tri_across(mesh, tri_code(t, left ? tri_next[k] : tri_prev[k]));
    return code == TRI_NONE ? TRI_NONE : tri_of(code);
}

/* Does the ray from a (corner k of t) to q leave through t: right edge included, left edge not? */
static bool leaves_through(const struct tri_mesh *mesh, tri_triangle_id t, int k, struct tri_point q)
{
    const struct tri_triangle *at = &mesh->tri[t];
    struct tri_point a = mesh->xy[at->v[k]], right = mesh->xy[at->v[tri_next[k]]], left = mesh->xy[at->v[tri_prev[k]]];
    double r = tri_orient2d(a, right, q), s = tri_orient2d(a, left, q);
    if (r == 0) /* on the line of the right edge: ahead, not behind? */
        return (right.x - a.x) * (q.x - a.x) + (right.y - a.y) * (q.y - a.y) > 0;
    return r > 0 && s < 0;
}

static bool along_left(const struct tri_mesh *mesh, tri_triangle_id t, int k, struct tri_point q)
{
    const struct tri_triangle *at = &mesh->tri[t];
    struct tri_point a = mesh->xy[at->v[k]], left = mesh->xy[at->v[tri_prev[k]]];
    return tri_orient2d(a, left, q) == 0 && (left.x - a.x) * (q.x - a.x) + (left.y - a.y) * (q.y - a.y) > 0;
}

/* The search for the triangle at a vertex through which the ray to q leaves, a triangle a step. */
struct rotation {
    tri_vertex_id vertex;
    tri_triangle_id start, t;
    struct tri_point q;
    bool clockwise;
};

static struct rotation rotate_from(const tri_triangle_id *corner, tri_vertex_id a, struct tri_point q)
{
    assert(corner[a] != TRI_NONE);
    return (struct rotation){a, corner[a], corner[a], q, false};
}

/* The triangle, if it is the one at hand (whose left edge counts only where nothing lies beyond it); else TRI_NONE, and
 * the next one is at hand. After the last one r->t is TRI_NONE. */
static tri_triangle_id rotate(const struct tri_mesh *mesh, struct rotation *r)
{
    tri_triangle_id t = r->t;
    int k = tri_corner_of(&mesh->tri[t], r->vertex);
    if (leaves_through(mesh, t, k, r->q) || along_left(mesh, t, k, r->q))
        return t;
    r->t = turn(mesh, t, r->vertex, !r->clockwise);
    if (r->t == TRI_NONE && !r->clockwise) { /* the other way, from the first one's neighbour */
        r->clockwise = true;
        r->t = turn(mesh, r->start, r->vertex, false);
    } else if (r->t == r->start) {
        r->t = TRI_NONE;
    }
    return TRI_NONE;
}

tri_triangle_id tri_find_exit(const struct tri_mesh *mesh, tri_triangle_id *corner, tri_vertex_id *a, tri_vertex_id *b)
{
    const tri_vertex_id from = *a, to = *b;
    tri_triangle_id found = TRI_NONE;
    struct rotation at[2] = {rotate_from(corner, from, mesh->xy[to]), rotate_from(corner, to, mesh->xy[from])};
    int end = 0;
    for (int n = 0; at[end].t != TRI_NONE && (found = rotate(mesh, &at[end])) == TRI_NONE;)
        end = n < HUB ? (n++, 0) : 1 - end;
    if (found == TRI_NONE)
        return TRI_NONE;
    *a = end == 0 ? from : to;
    *b = end == 0 ? to : from;
    return corner[*a] = found;
}
