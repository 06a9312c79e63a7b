/* Judging triangles. */
#include "triangle/refine/criterion.h"

struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    return (struct tri_criterion){tri_asked_of(mesh, quality),
                                  tri_bounds_for(quality->min_angle, quality->conforming)};
}

enum tri_badness tri_judge(const struct tri_criterion *c, const struct tri_triangle *t, const struct tri_shape *shape)
{
    double product = tri_longer_product(shape->l[0], shape->l[1], shape->l[2]);
    if (shape->area2 * shape->area2 < c->bounds.sin2 * product)
        return TRI_BAD_ANGLE;
    return tri_is_too_large(&c->asked, t, shape) ? TRI_BAD_SIZE : TRI_GOOD;
}

bool tri_is_protected(const struct tri_quality *quality, const struct tri_subsegment *s)
{
    return quality->protect >= 2 || (quality->protect == 1 && tri_is_boundary(s));
}

bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape)
{
    return shape->area2 * shape->area2 < mesh->limits.shortest2 * tri_longest2(shape);
}
