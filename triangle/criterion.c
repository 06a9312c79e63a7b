/* Judging triangles and subsegments. */
#include "triangle/criterion.h"

#include "triangle/cavity.h"
#include "triangle/small_angle.h"

double tri_area2_bound(const struct tri_criterion *c, int32_t region)
{
    double bound = c->options->max_area > 0 ? c->options->max_area : HUGE_VAL;
    if (c->options->region_areas) {
        double own = c->mesh->regions[region].max_area;
        bound = own > 0 && own < bound ? own : bound;
    }
    bound *= c->options->area_scale > 0 ? c->options->area_scale : 1;
    return 2 * (bound / c->mesh->unit / c->mesh->unit);
}

bool tri_is_unsuitable(const struct tri_criterion *criterion, const int32_t v[3], double area2)
{
    const struct tri_refine_options *options = criterion->options;
    const struct tri_point *xy = criterion->mesh->xy;
    double unit = criterion->mesh->unit, a[2] = {xy[v[0]].x * unit, xy[v[0]].y * unit};
    double b[2] = {xy[v[1]].x * unit, xy[v[1]].y * unit}, c[2] = {xy[v[2]].x * unit, xy[v[2]].y * unit};
    return options->unsuitable(options->unsuitable_user, a, b, c, 0.5 * area2 * unit * unit) != 0;
}

enum tri_badness tri_judge(const struct tri_criterion *c, const struct tri_triangle *t, const struct tri_shape *shape)
{
    double product = tri_longer_product(shape->l[0], shape->l[1], shape->l[2]);
    if (shape->area2 * shape->area2 < c->bounds.sin2 * product)
        return TRI_BAD_ANGLE;
    if (shape->area2 > tri_area2_bound(c, t->region))
        return TRI_BAD_SIZE;
    return c->options->unsuitable && tri_is_unsuitable(c, t->v, shape->area2) ? TRI_BAD_SIZE : TRI_GOOD;
}

bool tri_is_protected(const struct tri_refine_options *options, const struct tri_subsegment *s)
{
    bool boundary = s->side[0] == TRI_NONE || s->side[1] == TRI_NONE;
    return options->protect >= 2 || (options->protect == 1 && boundary);
}

bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape)
{
    double longest2 = fmax(shape->l[0], fmax(shape->l[1], shape->l[2]));
    return shape->area2 * shape->area2 < mesh->shortest2 * longest2;
}

bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, int32_t code)
{
    struct tri_point apex = mesh->xy[mesh->tri[tri_of(code)].v[tri_edge(code)]];
    struct tri_relative a = tri_relative(&mesh->xy[s->v[0]], apex), b = tri_relative(&mesh->xy[s->v[1]], apex);
    return a.x * b.x + a.y * b.y < 0;
}

/* The same, and can it be mended? */
static bool is_crowded_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, int32_t code)
{
    if (!tri_is_in_diametral_disk(mesh, s, code))
        return false;
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[tri_of(code)].v);
    return !tri_is_hopeless(mesh, mesh->shortest2, tri_of(code), &shape) && !tri_is_flat(mesh, &shape);
}

bool tri_is_crowded(const struct tri_mesh *mesh, const struct tri_subsegment *s)
{
    return (s->side[0] != TRI_NONE && is_crowded_from(mesh, s, s->side[0])) ||
           (s->side[1] != TRI_NONE && is_crowded_from(mesh, s, s->side[1]));
}
