/* Attributes that are linear in the plane stay so. */
#include "triangle/mesh/interpolate.h"

#include "tests/support.h"

enum { CORNERS = 3, NEW = 3, MADE = 4 };

/* Three corners and a vertex to come, with two attributes that are linear in the plane. */
static struct tri_mesh corners(struct tri_point *xy, double *attributes)
{
    for (int32_t v = 0; v < CORNERS; v++) {
        attributes[2 * v] = 1 + 2 * xy[v].x - 3 * xy[v].y;
        attributes[2 * v + 1] = xy[v].y;
    }
    return (struct tri_mesh){.xy = xy, .n_vertices = MADE, .n_attributes = 2, .attributes = attributes};
}

static void assert_linear(const struct tri_point *p, const double *attributes)
{
    assert_true(fabs(attributes[0] - (1 + 2 * p->x - 3 * p->y)) < 1e-12);
    assert_true(fabs(attributes[1] - p->y) < 1e-12);
}

static void test_edges(void **state)
{
    (void)state;
    for (int i = 0; i <= 4; i++) {
        struct tri_point xy[MADE] = {{0, 0}, {4, 1}, {1, 3}, {1 + 3 * i / 4.0, 3 - 2 * i / 4.0}};
        double attributes[2 * MADE] = {0};
        struct tri_mesh mesh = corners(xy, attributes);
        tri_interpolate_edge(&mesh, 2, 1, i / 4.0, NEW);
        assert_linear(&xy[NEW], attributes + 2 * NEW);
    }
}

/* The ends of an edge are met exactly. */
static void test_ends(void **state)
{
    (void)state;
    struct tri_point xy[MADE] = {{0.1, 0.7}, {0.3, 0.9}, {1, 3}, {0.1, 0.7}};
    double attributes[2 * MADE] = {0};
    struct tri_mesh mesh = corners(xy, attributes);
    tri_interpolate_edge(&mesh, 0, 1, 0, NEW);
    assert_memory_equal(attributes, attributes + 2 * NEW, 2 * sizeof *attributes);
}

static void test_triangles(void **state)
{
    (void)state;
    static const struct tri_point at[] = {{1, 1}, {0, 0}, {4, 1}, {1, 3}, {2, 0.5}, {2, 1.5}};
    const int32_t v[] = {0, 1, 2};
    for (size_t i = 0; i < sizeof at / sizeof *at; i++) {
        struct tri_point xy[MADE] = {{0, 0}, {4, 1}, {1, 3}, at[i]};
        double attributes[2 * MADE] = {0};
        struct tri_mesh mesh = corners(xy, attributes);
        tri_interpolate_triangle(&mesh, v, NEW);
        assert_linear(&xy[NEW], attributes + 2 * NEW);
    }
}

/* Where rounding puts a vertex beyond its edge, or beside a triangle that has hardly any area. */
static void test_range_is_kept(void **state)
{
    (void)state;
    static const int32_t v[] = {0, 1, 2};
    static const struct tri_point at[] = {{0.5, 1e-16}, {0.5, -1}, {7, 0}, {-7, 0}};
    static const double height[] = {3e-16, 0};
    for (size_t i = 0; i < 2 * sizeof at / sizeof *at; i++) {
        struct tri_point xy[MADE] = {{0, 0}, {1, 0}, {0.5, height[i % 2]}, at[i / 2]};
        double attributes[2 * MADE] = {0, 5, 1, 5, 0.25, 5};
        struct tri_mesh mesh = {.xy = xy, .n_vertices = MADE, .n_attributes = 2, .attributes = attributes};
        for (int how = 0; how < 3; how++) {
            if (how == 2)
                tri_interpolate_triangle(&mesh, v, NEW);
            else
                tri_interpolate_edge(&mesh, 0, 1, how == 0 ? 1.25 : -0.25, NEW);
            assert_true(attributes[2 * NEW] >= 0 && attributes[2 * NEW] <= 1 && attributes[2 * NEW + 1] == 5);
        }
    }
}

static void test_no_attributes(void **state)
{
    (void)state;
    struct tri_point xy[MADE] = {{0, 0}, {4, 1}, {1, 3}, {1, 1}};
    struct tri_mesh mesh = {.xy = xy, .n_vertices = MADE};
    tri_interpolate_edge(&mesh, 0, 1, 0.5, NEW);
    tri_interpolate_triangle(&mesh, (const int32_t[]){0, 1, 2}, NEW);
    assert_null(mesh.attributes);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_edges),
        cmocka_unit_test(test_ends),
        cmocka_unit_test(test_triangles),
        cmocka_unit_test(test_range_is_kept),
        cmocka_unit_test(test_no_attributes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
