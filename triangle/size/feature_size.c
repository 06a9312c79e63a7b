/* Feature sizes, and why refinement for angles terminates.
 *
 * Every vertex v has a size s(v), an estimate of Ruppert's local feature size (1995):
 *   - an input vertex: its distance from the vertices and segments of its triangles;
 *   - a point p for a triangle with shortest edge ab: the smaller of s(a) + TRI_SLOPE * |ap| and s(b) + TRI_SLOPE *
 *     |bp|, inherited like insertion radii (Shewchuk 2002);
 *   - a split point: the same from all vertices around it, but at most its distance from other features;
 *   - a point inserted for sizes: at most its distance from its neighbours.
 * Distances that coordinates do not resolve are not features (limits.shortest2, tri_touches). Neither are the widths
 * of unfilled gaps (gap.h) and of their ends.
 * RULE. A triangle whose shortest edge ab is shorter than min(s(a), s(b)) / TRI_SHRINK is not refined for its angle.
 * THEOREM (docs/theory.md, sizes). At most C * integral of dx / s(x)^2 points are inserted for angles, with C
 * independent of the bound and of the insertion order. Up to a constant, Ruppert's algorithm inserts as many. */
#include "triangle/size/feature_size.h"

#include <assert.h>

#include "triangle/geometry/shape.h"
#include "triangle/mesh/parents.h"
#include "triangle/mesh/surface.h"
#include "triangle/size/gap.h"
#include "triangle/tunables.h"

/* Does the corner project onto the opposite edge rather than beyond one of its ends? Arguments are squared lengths. */
static bool is_beside(double edge, double left, double right) { return left <= right + edge && right <= left + edge; }

/* Parallel estimation over shares of the triangles. Each share owns a range of vertices: triangles are sorted along
 * a curve by their vertices, so each share begins with a higher vertex than the previous one. Corners owned by
 * another share are processed afterwards; the minimum of all estimates does not depend on the order. */
struct estimate {
    struct tri_mesh *mesh;                  /* sizes go into mesh->feature */
    tri_vertex_id own[TRI_MOST_SHARES + 1]; /* share i owns the vertices own[i] .. own[i + 1] - 1 */
};

static void divide_vertices(struct estimate *e)
{
    size_t shares = tri_shares(e->mesh->n_triangles);
    e->own[0] = 0;
    for (size_t i = 1; i < shares; i++) {
        tri_vertex_id v = e->mesh->tri[tri_share(i, e->mesh->n_triangles).first].v[0];
        e->own[i] = v > e->own[i - 1] ? v : e->own[i - 1];
        assert(e->own[i] >= e->own[i - 1] && e->own[i] < e->mesh->n_vertices);
    }
    e->own[shares] = e->mesh->n_vertices;
}

/* Lowers the size of corner k to its smallest distance from the other corners and from the opposite wall, as far as
 * these distances are features. */
static void estimate_corner(struct tri_mesh *mesh, const struct tri_triangle *t, const struct tri_shape *shape, int k)
{
    double edge = shape->l[k], left = shape->l[tri_next[k]], right = shape->l[tri_prev[k]];
    bool wall = t->n[k] < 0 && is_beside(edge, left, right);
    double distance2[3] = {left, right, wall ? shape->area2 * shape->area2 / edge : HUGE_VAL};
    tri_vertex_id v = t->v[k], other[2] = {t->v[tri_prev[k]], t->v[tri_next[k]]};
    for (int i = 0; i < 3; i++)
        if (distance2[i] >= mesh->limits.shortest2 && sqrt(distance2[i]) < mesh->feature[v] &&
            !(i < 2 ? tri_spans_gap(mesh, v, other[i]) : tri_lines_gap(mesh, mesh->sub[~t->n[k]].parent, v)))
            mesh->feature[v] = sqrt(distance2[i]);
}

static bool owns(const struct estimate *e, size_t share, tri_vertex_id v)
{
    return v >= e->own[share] && v < e->own[share + 1];
}

/* Processes the share's triangles at its own vertices, or (`own` false) at vertices of other shares. */
static void estimate_share(const struct estimate *e, size_t share, bool own)
{
    struct tri_mesh *mesh = e->mesh;
    const struct tri_range range = tri_share(share, mesh->n_triangles);
    for (tri_triangle_id i = range.first; i < range.last; i++) {
        const struct tri_triangle *t = &mesh->tri[i];
        const bool is_own[3] = {owns(e, share, t->v[0]), owns(e, share, t->v[1]), owns(e, share, t->v[2])};
        if (!tri_is_live(t) || (!own && is_own[0] && is_own[1] && is_own[2]))
            continue;
        const struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
        for (int k = 0; k < 3; k++)
            if (is_own[k] == own)
                estimate_corner(mesh, t, &shape, k);
    }
}

static void estimate_own(void *context, size_t share)
{
    const struct estimate *e = context;
    for (tri_vertex_id v = e->own[share]; v < e->own[share + 1]; v++)
        e->mesh->feature[v] = HUGE_VAL;
    estimate_share(e, share, true);
}

/* Sets the size of vertices that have no resolvable distance. */
static void settle_own(void *context, size_t share)
{
    const struct estimate *e = context;
    double *feature = e->mesh->feature;
    for (tri_vertex_id v = e->own[share]; v < e->own[share + 1]; v++)
        feature[v] = feature[v] < HUGE_VAL ? feature[v] : sqrt(e->mesh->limits.shortest2);
}

/* Sets the feature size of every vertex from the triangles around it. O(triangles). */
static void estimate_features(struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct estimate e = {.mesh = mesh};
    divide_vertices(&e);
    tri_execute(executor, tri_shares(mesh->n_triangles), estimate_own, &e);
    for (size_t share = 0; share < tri_shares(mesh->n_triangles); share++)
        estimate_share(&e, share, false);
    tri_execute(executor, tri_shares(mesh->n_triangles), settle_own, &e);
}

double tri_feature_inside(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p, bool sized)
{
    assert(a != b);
    double from_a = sqrt(tri_relative(&mesh->xy[a], p).l), from_b = sqrt(tri_relative(&mesh->xy[b], p).l);
    double inherited = tri_lesser(mesh->feature[a] + TRI_SLOPE * from_a, mesh->feature[b] + TRI_SLOPE * from_b);
    return sized ? tri_lesser(tri_lesser(from_a, from_b), inherited) : inherited;
}

/* Returns the size at point `at` on parent p that follows from vertex v at this distance. */
static double size_from(const struct tri_mesh *mesh, tri_parent_id p, struct tri_point at, tri_vertex_id v,
                        double distance)
{
    int32_t on = mesh->on[v];
    double inherited = mesh->feature[v] + TRI_SLOPE * distance;
    if (distance >= inherited || on == TRI_VERTEX_FREE)
        return inherited;
    bool is_feature = on >= 0 ? tri_is_filled(mesh, p, on, at, mesh->xy[v])
                              : !tri_touches(mesh, p, v) && !tri_lines_gap(mesh, p, v);
    return is_feature ? distance : inherited;
}

/* Returns the distance of the new point from a subsegment on its cavity's boundary; infinity if the point does not
 * project onto the subsegment or the gap between them is not filled. */
static double size_from_wall(const struct tri_mesh *mesh, tri_parent_id p, struct tri_point at, int32_t wall)
{
    const struct tri_subsegment *sub = &mesh->sub[wall];
    struct tri_relative a = tri_relative(&mesh->xy[sub->v[0]], at), b = tri_relative(&mesh->xy[sub->v[1]], at);
    double x = b.x - a.x, y = b.y - a.y, edge = x * x + y * y;
    if (!is_beside(edge, a.l, b.l) || !tri_is_filled(mesh, p, sub->parent, at, mesh->xy[sub->v[0]]))
        return HUGE_VAL;
    return fabs(tri_cross(a, b)) / sqrt(edge);
}

double tri_feature_on_segment(const struct tri_mesh *mesh, const struct tri_cavity *cavity, tri_sub_id s, bool sized)
{
    const struct tri_subsegment *sub = &mesh->sub[s];
    double size = HUGE_VAL, half = HUGE_VAL;
    for (int k = 0; k < 2; k++) {
        double distance = sqrt(tri_relative(&mesh->xy[sub->v[k]], cavity->p).l);
        half = fmin(half, distance);
        size = fmin(size, size_from(mesh, sub->parent, cavity->p, sub->v[k], distance));
    }
    for (int32_t i = 0; i < cavity->n_edges; i++) {
        const struct tri_cavity_corner *corner = cavity->edge[i].a;
        size = fmin(size, size_from(mesh, sub->parent, cavity->p, corner->v, sqrt(corner->r.l)));
        if (cavity->edge[i].outer < 0)
            size = fmin(size, size_from_wall(mesh, sub->parent, cavity->p, ~cavity->edge[i].outer));
    }
    assert(half > 0 && half < HUGE_VAL && size < HUGE_VAL);
    return sized && half < size ? half : size;
}

bool tri_has_run_away(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, double l2)
{
    double sa = mesh->feature[a], sb = mesh->feature[b], size = sa < sb ? sa : sb;
    return size * size > TRI_SHRINK * TRI_SHRINK * l2;
}

/* tri_refine_prepare computes, before the first insertion and in this order:
 *
 *   surface: of the attributes of vertices (surface.h)
 *   acute: input vertices at which two subsegments meet at less than 60 degrees
 *   incidence: the parents that end at each vertex, sorted by direction if there are many
 *   limits: the shortest edge that coordinates can resolve
 *   gaps: the most expensive narrow gap that will be filled, from all of the above (gap.h)
 *   features: the distance of each vertex from its surroundings, from all of the above
 *
 * RULE (rounding). Distances of 32 to 256 resolutions are features if at most TRI_FEW_BLURRED vertices are that
 * close to another vertex or a segment. If there are more, the input probably contains lines or points that were
 * computed twice, and such distances are rounding errors. Each one that counts as a feature needs some 100 to 400
 * triangles.
 *
 * INVARIANT. Refinement only reads these values. The only exception: it sets the sizes of vertices that it adds. */

static bool is_input(int32_t on) { return on == TRI_VERTEX_INPUT || on == TRI_VERTEX_ACUTE; }

/* Returns the next subsegment counter-clockwise after s around its end k, inside the mesh; TRI_NONE if the outside
 * comes first. */
static tri_sub_id next_around(const struct tri_mesh *mesh, tri_sub_id s, int k)
{
    tri_halfedge code = mesh->sub[s].side[k];
    while (code != TRI_NONE) { /* edge `code` starts at the vertex and is counter-clockwise in its triangle */
        tri_link link = mesh->tri[tri_of(code)].n[tri_prev[tri_edge(code)]];
        if (link < 0)
            return ~link;
        code = tri_code(tri_of(link), tri_edge(link));
    }
    return TRI_NONE;
}

static void find_acute(struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2; k++) {
            tri_vertex_id v = mesh->sub[s].v[k];
            tri_sub_id other = is_input(mesh->on[v]) ? next_around(mesh, s, k) : TRI_NONE;
            if (other == TRI_NONE || other == s)
                continue;
            struct tri_point o = mesh->xy[v], a = mesh->xy[mesh->sub[s].v[1 - k]];
            struct tri_point b = mesh->xy[mesh->sub[other].v[mesh->sub[other].v[0] == v]];
            double ax = a.x - o.x, ay = a.y - o.y, bx = b.x - o.x, by = b.y - o.y;
            double dot = ax * bx + ay * by, cross = ax * by - ay * bx;
            if (dot > 0 && cross > 0 && 4 * dot * dot > (ax * ax + ay * ay) * (bx * bx + by * by))
                mesh->on[v] = TRI_VERTEX_ACUTE;
        }
}

static double largest_coordinate(const struct tri_mesh *mesh)
{
    double size = 0;
    for (tri_vertex_id v = 0; v < mesh->n_input; v++)
        size = tri_larger(size, tri_larger(fabs(mesh->xy[v].x), fabs(mesh->xy[v].y)));
    return size;
}

/* Computes gaps and sizes; distances below `rounding` are not features. Returns the number of vertices with sizes
 * above `rounding` and below TRI_BLUR times that. (Vertices without triangles have the smallest size.) */
static int32_t find_features(struct tri_mesh *mesh, double rounding, const struct tri_executor *executor)
{
    int32_t n = 0;
    mesh->limits.shortest2 = rounding * rounding;
    tri_choose_gaps(mesh, executor);
    estimate_features(mesh, executor);
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        n += mesh->feature[v] > rounding && mesh->feature[v] < TRI_BLUR * rounding;
    return n;
}

enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    if (mesh->incidence.start)
        return TRI_OK;
    enum tri_status status = tri_surface_keep(mesh, executor, error);
    find_acute(mesh);
    status = status ? status : tri_incidence_list(mesh, error);
    if (status)
        return status;
    const double shortest = TRI_SHORTEST_EDGE * largest_coordinate(mesh);
    mesh->limits.finest2 = shortest * shortest;
    if (find_features(mesh, shortest, executor) > TRI_FEW_BLURRED)
        find_features(mesh, TRI_BLUR * shortest, executor);
    return TRI_OK;
}
