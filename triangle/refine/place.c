/* The usual new point. */
#include "triangle/refine/place.h"

#include <assert.h>
#include <math.h>

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
