/* Judging triangles. */
#include "triangle/refine/criterion.h"

#include <assert.h>

/* Twice a bound of the caller's. The unit is a power of two; its square may be beyond the range of doubles. */
static double to_area2(const struct tri_criterion *c, double bound)
{
    return 2 * (bound * tri_area_scale(c->options) / c->mesh->unit / c->mesh->unit);
}

struct tri_criterion tri_criterion_of_areas(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    struct tri_criterion c = {.mesh = mesh, .options = options, .area2 = HUGE_VAL};
    if (options->max_area > 0)
        c.area2 = to_area2(&c, options->max_area);
    return c;
}

struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    struct tri_criterion c = tri_criterion_of_areas(mesh, options);
    c.bounds = tri_bounds_for(options->min_angle, options->conforming);
    return c;
}

double tri_area2_in_region(const struct tri_criterion *c, tri_region_id region)
{
    double own = c->mesh->regions[region].max_area;
    return own > 0 ? tri_lesser(to_area2(c, own), c->area2) : c->area2;
}

static void shrink(double at[2], const double centroid[2], double factor)
{
    at[0] = centroid[0] + factor * (at[0] - centroid[0]);
    at[1] = centroid[1] + factor * (at[1] - centroid[1]);
}

/* The answer of a test in the caller's units, about a triangle of a mesh with this unit, shrunk as tri_is_refused has
 * it. */
static bool says_yes(tri_unsuitable *test, void *user, double unit, struct tri_point p, struct tri_point q,
                     struct tri_point r, double scale)
{
    assert(test && scale > 0);
    double a[2] = {p.x * unit, p.y * unit}, b[2] = {q.x * unit, q.y * unit}, c[2] = {r.x * unit, r.y * unit};
    double area = 0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]));
    if (scale != 1) {
        double centroid[2] = {(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3}, factor = 1 / sqrt(scale);
        shrink(a, centroid, factor);
        shrink(b, centroid, factor);
        shrink(c, centroid, factor);
    }
    return test(user, a, b, c, area / scale) != 0;
}

bool tri_is_refused(const struct tri_refine_options *options, double unit, struct tri_point p, struct tri_point q,
                    struct tri_point r, double scale)
{
    return says_yes(options->unsuitable, options->unsuitable_user, unit, p, q, r, scale);
}

bool tri_is_unsuitable(const struct tri_criterion *criterion, const tri_vertex_id v[3])
{
    const struct tri_refine_options *options = criterion->options;
    const struct tri_point *xy = criterion->mesh->xy;
    return tri_is_refused(options, criterion->mesh->unit, xy[v[0]], xy[v[1]], xy[v[2]], tri_area_scale(options));
}

bool tri_is_too_large(const struct tri_criterion *c, const struct tri_triangle *t, const struct tri_shape *shape)
{
    return shape->area2 > tri_area2_bound(c, t->region) || (c->options->unsuitable && tri_is_unsuitable(c, t->v));
}

bool tri_is_urgent(const struct tri_criterion *c, const tri_vertex_id v[3])
{
    const struct tri_refine_options *options = c->options;
    const struct tri_point *xy = c->mesh->xy;
    return !options->urgent || says_yes(options->urgent, options->urgent_user, c->mesh->unit, xy[v[0]], xy[v[1]],
                                        xy[v[2]], 1);
}

enum tri_badness tri_judge(const struct tri_criterion *c, const struct tri_triangle *t, const struct tri_shape *shape)
{
    double product = tri_longer_product(shape->l[0], shape->l[1], shape->l[2]);
    bool flat = shape->area2 * shape->area2 < c->bounds.sin2 * product;
    if ((!flat && !tri_is_too_large(c, t, shape)) || !tri_is_urgent(c, t->v))
        return TRI_GOOD;
    return flat ? TRI_BAD_ANGLE : TRI_BAD_SIZE;
}

bool tri_is_protected(const struct tri_refine_options *options, const struct tri_subsegment *s)
{
    return options->protect >= 2 || (options->protect == 1 && tri_is_boundary(s));
}

bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape)
{
    return shape->area2 * shape->area2 < mesh->limits.shortest2 * tri_longest2(shape);
}
