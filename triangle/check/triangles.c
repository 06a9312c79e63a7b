/* Corners are vertices, vertices are in the range of the exact predicates, and every triangle is strictly
 * counter-clockwise. */
#include "triangle/check/internal.h"

static bool is_no_vertex(const struct checker *c, int32_t h)
{
    int32_t v = c->mesh->triangles[h];
    return v < 0 || v >= c->mesh->n_points;
}

static void tell_corner(struct checker *c, int32_t h)
{
    tri_check_fault(c, TRI_CHECK_ARRAYS, "triangle %ld has corner %ld, which is not a vertex", check_number(c, h / 3),
                    check_number(c, c->mesh->triangles[h]));
}

static bool is_out_of_range(const struct checker *c, int32_t v)
{
    return !tri_is_exact_point(check_point(c, v));
}

static void tell_range(struct checker *c, int32_t v)
{
    struct tri_point p = check_point(c, v);
    tri_check_fault(c, TRI_CHECK_ARRAYS, "vertex %ld at (%.17g, %.17g) is beyond the range of exact arithmetic",
                    check_number(c, v), check_given(c, p.x), check_given(c, p.y));
}

void tri_check_arrays(struct checker *c)
{
    tri_check_each(c, TRI_CHECK_ARRAYS, c->n_half_edges, is_no_vertex, tell_corner);
    tri_check_each(c, TRI_CHECK_ARRAYS, c->mesh->n_points, is_out_of_range, tell_range);
}

static double twice_area(const struct checker *c, int32_t t)
{
    const int32_t *v = c->mesh->triangles + 3 * (size_t)t;
    return tri_orient2d(check_point(c, v[0]), check_point(c, v[1]), check_point(c, v[2]));
}

static bool is_turned(const struct checker *c, int32_t t)
{
    return !(twice_area(c, t) > 0);
}

static void tell_turned(struct checker *c, int32_t t)
{
    const int32_t *v = c->mesh->triangles + 3 * (size_t)t;
    tri_check_fault(c, TRI_CHECK_ORIENTATION, "triangle %ld (%ld %ld %ld) is %s", check_number(c, t),
                    check_number(c, v[0]), check_number(c, v[1]), check_number(c, v[2]),
                    twice_area(c, t) < 0 ? "clockwise" : "flat");
}

void tri_check_orientation(struct checker *c)
{
    tri_check_each(c, TRI_CHECK_ORIENTATION, c->mesh->n_triangles, is_turned, tell_turned);
}
