/* Bounds on areas, the size function, and the size test. */
#include "triangle/size/asked.h"

#include <assert.h>

/* Area over squared edge of an equilateral triangle: sqrt(3) / 4. */
static const double EQUILATERAL = 0.43301270189221932;

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

static void shrink(double at[2], const double centroid[2], double factor)
{
    at[0] = centroid[0] + factor * (at[0] - centroid[0]);
    at[1] = centroid[1] + factor * (at[1] - centroid[1]);
}

/* A length that is not above 0 wants nothing: no mesh could have it. */
static bool is_above_length(const struct tri_quality *q, const double *const place[4], double area)
{
    for (int k = 0; k < 4; k++) {
        double length = q->edge_length(q->edge_length_user, place[k]);
        if (length > 0 && area > EQUILATERAL * length * length)
            return true;
    }
    return false;
}

bool tri_is_refused(const struct tri_asked *asked, struct tri_point p, struct tri_point q, struct tri_point r,
                    double scale)
{
    const struct tri_quality *quality = asked->quality;
    const double unit = asked->mesh->unit;
    double a[2] = {p.x * unit, p.y * unit}, b[2] = {q.x * unit, q.y * unit}, c[2] = {r.x * unit, r.y * unit};
    const double centroid[2] = {(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3}, factor = 1 / sqrt(scale);
    const double *const place[4] = {centroid, a, b, c};
    const double area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) / scale;
    assert(scale > 0 && tri_asks_caller(quality));
    if (quality->edge_length && is_above_length(quality, place, area))
        return true;
    if (!quality->unsuitable)
        return false;
    for (int k = 1; k < 4 && scale != 1; k++)
        shrink(k == 1 ? a : k == 2 ? b : c, centroid, factor);
    return quality->unsuitable(quality->unsuitable_user, a, b, c, area) != 0;
}

bool tri_is_unsuitable(const struct tri_asked *asked, const tri_vertex_id v[3])
{
    const struct tri_point *xy = asked->mesh->xy;
    return tri_is_refused(asked, xy[v[0]], xy[v[1]], xy[v[2]], tri_area_scale(asked->quality));
}

bool tri_is_too_large(const struct tri_asked *asked, const struct tri_triangle *t, const struct tri_shape *shape)
{
    return shape->area2 > tri_area2_bound(asked, t->region) ||
           (tri_asks_caller(asked->quality) && tri_is_unsuitable(asked, t->v));
}

/* Does the test refuse the equilateral triangle with this edge about a place? */
static bool refuses_edge(const struct tri_asked *asked, struct tri_point p, double edge)
{
    const struct tri_quality *quality = asked->quality;
    const double half = 0.5 * edge, low = edge / 3.4641016151377546, high = 2 * low, unit = asked->mesh->unit;
    const double a[2] = {(p.x - half) * unit, (p.y - low) * unit}, b[2] = {(p.x + half) * unit, (p.y - low) * unit};
    const double c[2] = {p.x * unit, (p.y + high) * unit}, area = EQUILATERAL * (edge * unit) * (edge * unit);
    return quality->unsuitable(quality->unsuitable_user, a, b, c, area) != 0;
}

static double probe(const struct tri_asked *asked, struct tri_point p, double longest)
{
    enum { DEEPEST = 16 };
    double edge = longest;
    for (int k = 0; k <= DEEPEST; k++, edge *= 0.5)
        if (!refuses_edge(asked, p, edge))
            return k > 0 ? 1.4142135623730951 * edge : ANY_LENGTH;
    return ANY_LENGTH;
}

double tri_asked_length(const struct tri_asked *asked, struct tri_point p, double longest)
{
    const struct tri_quality *quality = asked->quality;
    const double coarser = sqrt(tri_area_scale(quality)), unit = asked->mesh->unit;
    double length = ANY_LENGTH;
    if (quality->edge_length) {
        const double at[2] = {p.x * unit, p.y * unit}, here = quality->edge_length(quality->edge_length_user, at);
        length = here > 0 ? tri_lesser(length, coarser * here / unit) : length;
    }
    return quality->unsuitable ? tri_lesser(length, coarser * probe(asked, p, longest / coarser)) : length;
}
