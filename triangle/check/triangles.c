/* Every triangle is strictly counter-clockwise. */
#include "triangle/check/internal.h"

static double twice_area(const struct checker *c, int64_t t)
{
    const int32_t *v = c->part.triangles + 3 * t;
    return tri_orient2d(check_place(c, v[0]), check_place(c, v[1]), check_place(c, v[2]));
}

static bool is_turned(const struct checker *c, int64_t t)
{
    return !(twice_area(c, t) > 0);
}

static void tell_turned(struct checker *c, int64_t t)
{
    const int32_t *v = c->part.triangles + 3 * t;
    tri_check_fault(c, TRI_CHECK_ORIENTATION, "triangle %ld (%ld %ld %ld) is %s", check_part_triangle(c, (int32_t)t),
                    check_part_vertex(c, v[0]), check_part_vertex(c, v[1]), check_part_vertex(c, v[2]),
                    twice_area(c, t) < 0 ? "clockwise" : "flat");
}

void tri_check_orientation(struct checker *c)
{
    tri_check_each(c, TRI_CHECK_ORIENTATION, c->part.first, c->part.n_triangles, is_turned, tell_turned);
}
