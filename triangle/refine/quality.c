/* Bounds, and the usual new point. */
#include "triangle/refine/quality.h"

#include <assert.h>

#include "triangle/geometry/degrees.h"
#include "triangle/tunables.h"

struct tri_bounds tri_bounds_for(double min_angle, bool conforming)
{
    struct tri_bounds bounds = {0, 0, 0};
    if (!(min_angle > 0)) {
        /* No bound: still keep away from subsegments, as for 20 degrees, or triangles come out flat. */
        bounds.lens_cos2 = conforming ? 0 : 0.58682408883346604; /* cos^2 of 40 degrees */
        return bounds;
    }
    double cosine = tri_cos_degrees(min_angle < 60 ? min_angle : 60), twice = 2 * cosine * cosine - 1;
    bounds.sin2 = 1 - cosine * cosine;
    if (!conforming)
        bounds.lens_cos2 = twice > 0 ? twice * twice : 0;
    /* The off-centre that sees its edge under exactly the angle bound lies at 0.5 of this (Üngör 2004); 0.2% nearer,
     * rounding cannot make the new triangle bad. */
    bounds.off_centre = TRI_OFF_CENTRE * sqrt((1 + cosine) / (1 - cosine));
    return bounds;
}

struct tri_point tri_place(const struct tri_point *xy, const tri_vertex_id v[3], const struct tri_shape *shape,
                           double reach)
{
    int s = shape->shortest;
    assert(s >= 0 && s < 3 && reach >= 0);
    struct tri_point a = xy[v[tri_next[s]]], b = xy[v[tri_prev[s]]], c = xy[v[s]];
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y;
    double l = shape->l[s], lc = cx * cx + cy * cy;
    double scale = 0.5 / shape->area2;
    double x = (cy * l - by * lc) * scale, y = (bx * lc - cx * l) * scale; /* circumcentre from a */
    double mx = 0.5 * bx, my = 0.5 * by, hx = x - mx, hy = y - my;
    if (hx * hx + hy * hy > reach * reach) {
        double height = reach / sqrt(l);
        x = mx - height * by;
        y = my + height * bx;
    }
    return (struct tri_point){tri_round_coordinate(a.x + x), tri_round_coordinate(a.y + y)};
}
