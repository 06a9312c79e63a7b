/* The size of features, and why points for angles cannot run away.
 *
 * Above about 28 degrees a new point may lie nearer to its neighbours than the edge that asked for it is long, and
 * points may beget points in ever smaller triangles. So every vertex v knows the size s(v) of the features around it,
 * an estimate of Ruppert's local feature size (1995: how far it is to two features that do not touch):
 *   - for a vertex of the input: how far it is to the vertices and segments that its triangles reach;
 *   - for a point inserted for a triangle with shortest edge ab: min(s(a), s(b)) + SLOPE * |ap|, inherited as insertion
 *     radii are in the proofs of Shewchuk (2002);
 *   - for a split point: the same from all vertices around it, but no more than its distance from other features: from
 *     those that do not touch its segment, unless the space between is a gap too dear to fill (small_angle.h), and
 *     from segments that meet it at less than 60 degrees, unless that is a spike, which is not filled: in such a corner
 *     triangles are as small as it is narrow, though Ruppert's size would be the distance from the vertex where they
 *     meet;
 *   - for a point inserted because of sizes: no more than its distance from its neighbours. A size that is asked for is
 *     a feature.
 * What coordinates do not resolve is no feature: distances below the square root of limits.shortest2 do not count, and
 * where an end of a segment is as near to another segment the two touch (tri_touches), as if they met there, unless it
 * is at less than 60 degrees. (Ruppert's size would fall to that distance, but triangles that bridge it are flat, and
 * stay whatever is around them: 18 points on a turned grid had 2,600 triangles at 34 degrees, 203 of them bad, and have
 * 177, 19 of them bad.) Such sizes are larger than Ruppert's, so the theorem holds with fewer sources.
 * A mesh that is read does not tell which of its vertices refinement made: all are taken for vertices of the input, as
 * those of a mesh without refinement are, so that what had run away is asked for once more. (With sizes of split points
 * for the vertices amid a chain (chain.h) such triangles stay, but so do those along a side that somebody has divided
 * finely: of a mesh made for 41 degrees 22,632 of 686,149 triangles were given up at 30.)
 * RULE. A triangle whose shortest edge ab is shorter than min(s(a), s(b)) / SHRINK is not refined for its angle.
 *
 * THEOREM (nothing runs away). Call sources the vertices whose s is not inherited, and let F(x) be the minimum over all
 * sources w of s(w) + SLOPE * |wx|. F does not grow faster than SLOPE, so s(v) >= F(v) for every vertex, by induction.
 * Under the rule an edge that asks for a point is at least F / SHRINK long. The point lies at least l / (2 sin bound)
 * from all vertices, l being the length of that edge; a subsegment that is split instead is longer than a fixed share
 * of l, since the point sees it under an angle of more than 180 degrees - 2 * bound, or lies behind it. So points for
 * angles keep a distance from each other of a fixed share of F, and there are at most C * integral of dx / F(x)^2 of
 * them: to a constant as many as Ruppert's algorithm inserts for a bound for which it is known to end. C does not
 * depend on the bound, and nothing depends on the order of insertion: it holds for any schedule. What sources at split
 * points add is finite, too: a space between two segments is as wide as s there, so the integral over it is about its
 * length over its width, that is its cost (tri_filling_cost): no more than limits.dearest_gap for segments that do
 * not touch, which is chosen such that all such spaces together cost no more than the mesh can afford; and no more
 * than SHARP (small_angle.c) for each octave of distance from the vertex where two segments meet.
 *
 * SLOPE is about the grading of a mesh of 30 degrees. Without narrow corners as features one random figure in thirty
 * had triangles given up below 34 degrees, in and beside corners of a few degrees.
 *
 * SHRINK falls as the bound rises: 64 for bounds that theory promises, 16 up to 32 degrees, 8 up to 33, 6 beyond. Its
 * square is in the theorem's C, and beyond theory it is what one bad place may cost: a figure of 354 triangles at 25
 * degrees takes 458 at 34 with a SHRINK of 2, and 9,030 with 3, since one short edge lets the mesh grow fine
 * everywhere. So credit.h counts what is inserted beyond theory. Without that, over 2,326 random figures of all
 * families: the most triangles, in times those of 25 degrees, and of a million triangles in meshes of less than three
 * times those how many were given up as having run away:
 *     bound      SHRINK 16      8          6          4
 *     32              13   44   13   72    13  128    24   246
 *     33             170   32   30   68    31  147    26   489
 *     34             232   52   71  180    47  330    42  1541
 * Up to 32 a smaller one gains nothing; 4 costs angles and gains little. Sizes that grow faster among short edges, or
 * with each point asked for there, or less depth for triangles that are nearly good, did no better: once a mesh grows
 * fine it does so at edges of half the size, too.
 */
#include "triangle/feature_size.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/credit.h"
#include "triangle/grow.h"
#include "triangle/quality.h"
#include "triangle/small_angle.h"

static const double SLOPE = 0.5;

/* Is the corner beside the edge opposite to it, not before its start or beyond its end? From squared lengths. */
static bool is_beside(double edge, double left, double right) { return left <= right + edge && right <= left + edge; }

/* Estimates in shares of the triangles. Each share has vertices of its own: triangles that are sorted along a curve, by
 * vertices that are, begin share by share with higher ones. Corners that are another share's come afterwards; the least
 * of all estimates is the same in any order. */
struct estimate {
    struct tri_mesh *mesh;
    tri_vertex_id own[TRI_MOST_SHARES + 1]; /* share i: vertices own[i] .. own[i + 1] - 1 */
    struct crossing {
        tri_triangle_id *item; /* [n] triangles of the share that have a vertex of another one */
        int32_t n, capacity;
        bool lost;             /* no memory to tell, or too many */
    } crossing[TRI_MOST_SHARES];
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

/* The least of its distances from the other corners, and from the wall opposite to it, that coordinates resolve. */
static void estimate_corner(struct tri_mesh *mesh, const struct tri_triangle *t, const struct tri_shape *shape, int k)
{
    double edge = shape->l[k], left = shape->l[tri_next[k]], right = shape->l[tri_prev[k]];
    bool wall = t->n[k] < 0 && is_beside(edge, left, right);
    double distance2[3] = {left, right, wall ? shape->area2 * shape->area2 / edge : HUGE_VAL}, size2 = HUGE_VAL;
    for (int i = 0; i < 3; i++)
        if (distance2[i] >= mesh->limits.shortest2)
            size2 = tri_lesser(size2, distance2[i]);
    mesh->feature[t->v[k]] = tri_lesser(mesh->feature[t->v[k]], sqrt(size2));
}

static bool owns(const struct estimate *e, size_t share, tri_vertex_id v)
{
    return v >= e->own[share] && v < e->own[share + 1];
}

/* At most so many: in a mesh that is in no order they are nearly all, and not worth the memory. */
static void note_crossing(struct crossing *crossing, int32_t most, tri_triangle_id t)
{
    crossing->lost |= crossing->n >= most;
    if (!crossing->lost && tri_grow(&crossing->item, &crossing->capacity, crossing->n + 1, sizeof *crossing->item))
        crossing->item[crossing->n++] = t;
    else
        crossing->lost = true;
}

/* The share's triangles at its own vertices. */
static void estimate_own(void *context, size_t share)
{
    struct estimate *e = context;
    struct tri_mesh *mesh = e->mesh;
    struct tri_range range = tri_share(share, mesh->n_triangles);
    for (tri_vertex_id v = e->own[share]; v < e->own[share + 1]; v++)
        mesh->feature[v] = HUGE_VAL;
    for (tri_triangle_id i = range.first; i < range.last; i++) {
        const struct tri_triangle *t = &mesh->tri[i];
        if (!tri_is_live(t))
            continue;
        struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
        int own = 0;
        for (int k = 0; k < 3; k++)
            if (owns(e, share, t->v[k])) {
                estimate_corner(mesh, t, &shape, k);
                own++;
            }
        if (own < 3)
            note_crossing(&e->crossing[share], (range.last - range.first) / 8, i);
    }
}

/* And at those of other shares. Where they have not been noted, all are looked at. */
static void estimate_others(const struct estimate *e, size_t share)
{
    struct tri_mesh *mesh = e->mesh;
    const struct crossing *crossing = &e->crossing[share];
    struct tri_range range = tri_share(share, mesh->n_triangles);
    int32_t n = crossing->lost ? range.last - range.first : crossing->n;
    for (int32_t i = 0; i < n; i++) {
        const struct tri_triangle *t = &mesh->tri[crossing->lost ? range.first + i : crossing->item[i]];
        if (!tri_is_live(t))
            continue;
        struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
        for (int k = 0; k < 3; k++)
            if (!owns(e, share, t->v[k]))
                estimate_corner(mesh, t, &shape, k);
    }
}

/* Vertices of which no distance can be resolved. */
static void settle_own(void *context, size_t share)
{
    const struct estimate *e = context;
    double *feature = e->mesh->feature;
    for (tri_vertex_id v = e->own[share]; v < e->own[share + 1]; v++)
        feature[v] = feature[v] < HUGE_VAL ? feature[v] : sqrt(e->mesh->limits.shortest2);
}

void tri_estimate_features(struct tri_mesh *mesh, const struct tri_executor *executor)
{
    struct estimate e = {.mesh = mesh};
    divide_vertices(&e);
    tri_execute(executor, tri_shares(mesh->n_triangles), estimate_own, &e);
    for (size_t share = 0; share < tri_shares(mesh->n_triangles); share++) {
        estimate_others(&e, share);
        free(e.crossing[share].item);
    }
    tri_execute(executor, tri_shares(mesh->n_triangles), settle_own, &e);
}

double tri_feature_inside(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p, bool sized)
{
    assert(a != b);
    double sa = fabs(mesh->feature[a]), sb = fabs(mesh->feature[b]), near = sqrt(tri_relative(&mesh->xy[a], p).l);
    double inherited = (sa < sb ? sa : sb) + SLOPE * near;
    return sized && near < inherited ? near : inherited;
}

/* What vertex v, at `distance` from a point on parent p, says about the size there. */
static double size_from(const struct tri_mesh *mesh, tri_parent_id p, struct tri_point at, tri_vertex_id v,
                        double distance)
{
    int32_t on = mesh->on[v];
    double inherited = fabs(mesh->feature[v]) + SLOPE * distance;
    bool is_feature = on >= 0 ? tri_is_filled(mesh, p, on, at, mesh->xy[v])
                              : on != TRI_VERTEX_FREE && !tri_touches(mesh, p, v);
    return is_feature && distance < inherited ? distance : inherited;
}

/* The distance of the new point from a subsegment on its edge, where it lies beside it and that counts. */
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
        const struct tri_cavity_edge *edge = &cavity->edge[i];
        size = fmin(size, size_from(mesh, sub->parent, cavity->p, edge->a, sqrt(edge->ra.l)));
        if (edge->outer < 0)
            size = fmin(size, size_from_wall(mesh, sub->parent, cavity->p, ~edge->outer));
    }
    assert(half > 0 && half < HUGE_VAL && size < HUGE_VAL);
    return sized && half < size ? half : size;
}

/* SHRINK: how many times shorter than the features around them edges may become for angles up to this bound. */
static double shrink_for(double angle)
{
    return angle <= TRI_PROMISED_ANGLE ? 64 : angle <= 32 ? 16 : angle <= 33 ? 8 : 6;
}

bool tri_has_run_away(const struct tri_mesh *mesh, double angle, tri_vertex_id a, tri_vertex_id b, double l2)
{
    double sa = fabs(mesh->feature[a]), sb = fabs(mesh->feature[b]), size = sa < sb ? sa : sb;
    double shrink = shrink_for(angle);
    return size * size > shrink * shrink * l2;
}
