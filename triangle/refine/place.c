/* The standard point of a bad triangle, and the fallback for sizes. */
#include "triangle/refine/place.h"

#include <assert.h>
#include <math.h>

#include "triangle/geometry/predicates.h"

struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach)
{
    int s = shape->shortest;
    assert(s >= 0 && s < 3 && reach >= 0);
    struct tri_point a = xy[v[tri_next[s]]], b = xy[v[tri_prev[s]]], c = xy[v[s]];
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double l = shape->l[s], lc = cx * cx + cy * cy;
    double scale = 0.5 / shape->area2;
    double x = (cy * l - by * lc) * scale, y = (bx * lc - cx * l) * scale; /* circumcentre relative to a */
    double mx = 0.5 * bx, my = 0.5 * by, hx = x - mx, hy = y - my;
    if (hx * hx + hy * hy > reach * reach) {
        double height = reach / sqrt(l);
        x = mx - height * by;
        y = my + height * bx;
    }
    return (struct tri_point){tri_round_coordinate(a.x + x), tri_round_coordinate(a.y + y)};
}

/* Points for triangles that are too large and whose standard point cannot be inserted.
 *
 * The standard point may be impossible: it may lie beyond a wall that must not be split, outside the range of
 * coordinates, or on a vertex. Then the triangle's longest subsegment is split, if it is at least half as long as
 * the longest edge. If there is no such subsegment, the centroid is inserted. The centroid is always possible: it
 * lies in its triangle, hence in the circumdisk, and sees its whole cavity (cavity.h).
 *
 * THEOREM (docs/theory.md, areas). Both steps happen finitely often, however the rest of refinement proceeds. So
 * every triangle whose smallest height is more than three shortest edges (some 100 ulps) meets the bound on areas.
 *
 * RULE. Beside walls that must not be split (-Y), some triangles get no centroid, because a centroid would not
 * shorten the wall's edge. This holds for triangles at least 4,096 times as long as high that only the caller's size
 * test rejects, if the test also rejects the lowest possible triangle on the same longest edge. If wanted lengths
 * are given, it holds for triangles smaller than an equilateral triangle with edges h. */

tri_sub_id tri_long_wall(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         tri_triangle_id triangle, const struct tri_shape *shape)
{
    assert(tri_is_live(&mesh->tri[triangle]));
    tri_sub_id found = TRI_NONE;
    double length2 = 0.25 * tri_longest2(shape);
    for (int e = 0; e < 3; e++) {
        tri_link link = mesh->tri[triangle].n[e];
        if (link < 0 && shape->l[e] >= length2 && !tri_is_protected(quality, &mesh->sub[~link])) {
            found = ~link;
            length2 = shape->l[e];
        }
    }
    return found;
}

/* Returns the apex of the lowest triangle on edge ab that may still get a centroid. */
static struct tri_point lowest_apex(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b,
                                    struct tri_point apex, double height)
{
    const double share = fmin(3 * sqrt(mesh->limits.finest2) / height, 1);
    const struct tri_point m = tri_point_between(a, b, 0.5);
    return (struct tri_point){m.x + share * (apex.x - m.x), m.y + share * (apex.y - m.y)};
}

bool tri_is_walled_in(const struct tri_asked *asked, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const struct tri_mesh *mesh = asked->mesh;
    const struct tri_triangle *t = &mesh->tri[triangle];
    const double longest2 = tri_longest2(shape), LOW = 4096;
    const int e = shape->l[0] == longest2 ? 0 : shape->l[1] == longest2 ? 1 : 2;
    if (asked->quality->lengths && asked->quality->protect > 0 && !tri_asks_caller(asked->quality)) {
        const double h = tri_wanted_of(asked, t->v[0]);
        return shape->area2 <= tri_lesser(2 * TRI_EQUILATERAL * h * h, tri_area2_bound(asked, t->region));
    }
    if (!tri_asks_caller(asked->quality) || asked->quality->protect == 0 || LOW * shape->area2 > longest2 ||
        shape->area2 > tri_area2_bound(asked, t->region))
        return false;
    const struct tri_point a = mesh->xy[t->v[tri_next[e]]], b = mesh->xy[t->v[tri_prev[e]]];
    const struct tri_point low = lowest_apex(mesh, a, b, mesh->xy[t->v[e]], shape->area2 / sqrt(longest2));
    return tri_is_refused(asked, a, b, low);
}

bool tri_centroid(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape,
                  struct tri_point *p)
{
    assert(tri_is_live(&mesh->tri[triangle]));
    const tri_vertex_id *v = mesh->tri[triangle].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    p->x = tri_round_coordinate(a.x + ((b.x - a.x) + (c.x - a.x)) / 3);
    p->y = tri_round_coordinate(a.y + ((b.y - a.y) + (c.y - a.y)) / 3);
    if (shape->area2 * shape->area2 < 9 * mesh->limits.finest2 * tri_longest2(shape))
        return false;
    return tri_is_inside(a, b, c, *p);
}
