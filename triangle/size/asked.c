/* Bounds on areas, the size function, and the size test. */
#include "triangle/size/asked.h"

#include <assert.h>

/* No bound. */
static const double ANY_LENGTH = 1e100;

/* Twice a bound of the caller's. The unit is a power of two; its square may be beyond the range of doubles. */
static double to_area2(const struct tri_asked *a, double bound)
{
    return 2 * (bound * tri_area_scale(a->quality) / a->mesh->unit / a->mesh->unit);
}

struct tri_asked tri_asked_of(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    struct tri_asked a = {.mesh = mesh, .quality = quality, .area2 = HUGE_VAL};
    if (quality->max_area > 0)
        a.area2 = to_area2(&a, quality->max_area);
    return a;
}

double tri_area2_in_region(const struct tri_asked *a, tri_region_id region)
{
    double own = a->mesh->regions[region].max_area;
    return own > 0 ? tri_lesser(to_area2(a, own), a->area2) : a->area2;
}

/* A length that is not above 0 wants nothing: no mesh could have it. In the mesh's units: squares of the caller's may
 * be beyond the range of doubles. */
static bool is_above_length(const struct tri_asked *asked, const struct tri_point p[4], double area)
{
    const struct tri_quality *q = asked->quality;
    const double unit = asked->mesh->unit;
    for (int k = 3; k >= 0; k--) {
        const double at[2] = {p[k].x * unit, p[k].y * unit}, length = q->edge_length(q->edge_length_user, at) / unit;
        if (length > 0 && area > TRI_EQUILATERAL * length * length)
            return true;
    }
    return false;
}

/* The answer of the size test about a triangle shrunk about a place, to 1 / scale of its area. */
static bool test_refuses(const struct tri_asked *asked, const struct tri_point corner[3], struct tri_point about,
                         double scale)
{
    const double unit = asked->mesh->unit, factor = 1 / sqrt(scale);
    struct tri_point whole[3];
    double p[3][2];
    for (int k = 0; k < 3; k++) {
        whole[k] = (struct tri_point){corner[k].x * unit, corner[k].y * unit};
        p[k][0] = scale == 1 ? whole[k].x : (about.x + factor * (corner[k].x - about.x)) * unit;
        p[k][1] = scale == 1 ? whole[k].y : (about.y + factor * (corner[k].y - about.y)) * unit;
    }
    const double area = tri_area_of(whole[0], whole[1], whole[2]) / scale;
    return asked->quality->unsuitable(asked->quality->unsuitable_user, p[0], p[1], p[2], area) != 0;
}

bool tri_is_refused(const struct tri_asked *asked, struct tri_point a, struct tri_point b, struct tri_point c)
{
    const struct tri_point place[4] = {a, b, c, {(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3}}; /* the last first */
    const double scale = tri_area_scale(asked->quality);
    assert(scale > 0 && tri_asks_caller(asked->quality));
    if (asked->quality->edge_length && is_above_length(asked, place, tri_area_of(a, b, c) / scale))
        return true;
    return asked->quality->unsuitable && test_refuses(asked, place, place[3], scale);
}

bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3])
{
    const struct tri_point *xy = asked->mesh->xy;
    return tri_is_refused(asked, xy[v[0]], xy[v[1]], xy[v[2]]);
}

bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape)
{
    return shape->area2 > tri_area2_bound(asked, t->region) ||
           (tri_asks_caller(asked->quality) && tri_is_unsuitable(asked, t->v));
}

static double probe(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at)
{
    enum { DEEPEST = 16 };
    const double area = tri_area_of(triangle[0], triangle[1], triangle[2]);
    double scale = tri_area_scale(asked->quality);
    for (int k = 0; k <= DEEPEST; k++, scale *= 4)
        if (!test_refuses(asked, triangle, at, scale))
            return k > 0 ? 1 / sqrt(scale) * sqrt(2 * area / TRI_EQUILATERAL) : ANY_LENGTH;
    return ANY_LENGTH;
}

double tri_asked_length(const struct tri_asked *asked, const struct tri_point triangle[3], struct tri_point at)
{
    const struct tri_quality *quality = asked->quality;
    const double coarser = sqrt(tri_area_scale(quality)), unit = asked->mesh->unit;
    double length = ANY_LENGTH;
    if (quality->edge_length) {
        const double p[2] = {at.x * unit, at.y * unit}, here = quality->edge_length(quality->edge_length_user, p);
        length = here > 0 ? tri_lesser(length, here / unit) : length;
    }
    if (quality->unsuitable)
        length = tri_lesser(length, probe(asked, triangle, at));
    return length < ANY_LENGTH ? coarser * length : length;
}
