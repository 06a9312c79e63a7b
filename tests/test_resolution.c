/* Limits of coordinates: vertices near a segment but distinct from it, figures of any scale, and figures that are too
   small. */
#include <float.h>

#include "support.h"

static struct tri_mesh refined(const struct tri_pslg *pslg, double angle, bool conforming)
{
    struct tri_options options = support_quality(angle, 0);
    options.quality.conforming = conforming;
    return support_generate(pslg, &options, NULL);
}

static void judge(const struct tri_pslg *pslg, double angle, bool conforming)
{
    struct tri_check_options options = {.min_angle = angle, .max_bad = -1};
    options.delaunay = conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    struct tri_mesh mesh = refined(pslg, angle, conforming);
    support_judge(&mesh, pslg, &options, false, NULL);
    tri_mesh_free(&mesh);
}

/* A slanted segment in a box, and beside it a vertex at a given number of resolutions. A segment may end at the
   vertex. */
static struct tri_pslg beside(double resolutions, double slope, bool ends)
{
    struct tri_pslg pslg = support_pslg(8, 6, 0, 0);
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1);
    for (int k = 0; k < 4; k++)
        support_add_segment(&pslg, k, (k + 1) % 4);
    double length = sqrt(1 + slope * slope), x = -slope / length, y = 1 / length;
    support_add_point(&pslg, -0.5, -0.5 * slope);
    support_add_point(&pslg, 0.6, 0.6 * slope);
    support_add_segment(&pslg, 4, 5);
    support_add_point(&pslg, 0.1 + resolutions * 0x1p-52 * x, 0.1 * slope + resolutions * 0x1p-52 * y);
    if (ends)
        support_add_segment(&pslg, 6, support_add_point(&pslg, 0.1 + 0.3 * x, 0.1 * slope + 0.3 * y));
    return pslg;
}

/* From a distance of 64 resolutions on, the angle bound is met there. From 100 on, all circles of -D are empty. */
static void test_vertices_near_a_segment_are_features(void **state)
{
    (void)state;
    static const double resolutions[] = {64, 80, 100, 128, 200};
    for (size_t i = 0; i < sizeof resolutions / sizeof *resolutions; i++)
        for (int k = 0; k < 6; k++) {
            struct tri_pslg pslg = beside(resolutions[i], 0.25 + 0.1 * (k / 2), k % 2);
            judge(&pslg, 28, false);
            if (resolutions[i] >= 100)
                judge(&pslg, 20, true);
            tri_pslg_free(&pslg);
        }
}

/* A ground plan with a corner that lies 115 resolutions from a wall. */
static void test_a_corner_near_a_wall_is_meshed(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("regress/near_wall.poly", &pslg));
    judge(&pslg, 20, true);
    judge(&pslg, 28, false);
    tri_pslg_free(&pslg);
}

/* Three by three slanted cells, each a ring of its own. More copies of them are moved by up to the given number of
   resolutions. */
static struct tri_pslg map_of(int copies, double resolutions, uint64_t seed)
{
    enum { CELLS = 3 };
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(4 * CELLS * CELLS * copies, 4 * CELLS * CELLS * copies, 0, 0);
    double at[CELLS + 1][CELLS + 1][2];
    for (int i = 0; i < (CELLS + 1) * (CELLS + 1); i++) {
        at[i / (CELLS + 1)][i % (CELLS + 1)][0] = 0.2 * (i / (CELLS + 1) + 0.3 * support_unit(&random));
        at[i / (CELLS + 1)][i % (CELLS + 1)][1] = 0.2 * (i % (CELLS + 1) + 0.3 * support_unit(&random));
    }
    for (int i = 0; i < copies * CELLS * CELLS; i++) {
        double reach = i < CELLS * CELLS ? 0 : resolutions * 0x1p-52;
        for (int k = 0; k < 4; k++) {
            const double *p = at[i / CELLS % CELLS + (k == 1 || k == 2)][i % CELLS + k / 2];
            support_add_point(&pslg, p[0] + reach * (2 * support_unit(&random) - 1),
                              p[1] + reach * (2 * support_unit(&random) - 1));
        }
        for (int k = 0; k < 4; k++)
            support_add_segment(&pslg, 4 * i + k, 4 * i + (k + 1) % 4);
    }
    return pslg;
}

static int32_t count_refined(struct tri_pslg pslg)
{
    struct tri_mesh mesh = refined(&pslg, 20, false);
    int32_t n = mesh.n_triangles;
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    return n;
}

/* Details within rounding are not treated as features if there are many of them: each would need hundreds of
   triangles. */
static void test_borders_within_rounding_are_no_features(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 5; seed++) {
        int32_t once = count_refined(map_of(1, 0, seed));
        for (double resolutions = 1; resolutions <= 128; resolutions *= 2)
            assert_true(count_refined(map_of(2, resolutions, seed)) <= 24 * once);
    }
}

/* A zigzag in a box, and a copy of it at the given distance. */
static struct tri_pslg zigzag(int copies, double away, uint64_t seed)
{
    enum { STEPS = 6 };
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(4 + 2 * (STEPS + 1), 4 + 2 * STEPS, 0, 0);
    double height[STEPS + 1];
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k == 1 || k == 2, k / 2);
    for (int k = 0; k < 4; k++)
        support_add_segment(&pslg, k, (k + 1) % 4);
    for (int k = 0; k <= STEPS; k++)
        height[k] = 0.5 + 0.1 * support_unit(&random);
    for (int copy = 0; copy < copies; copy++)
        for (int k = 0; k <= STEPS; k++) {
            double x = copy * away * (2 * support_unit(&random) - 1), y = copy * away * (1 + support_unit(&random));
            int32_t v = support_add_point(&pslg, 0.1 + 0.8 * k / STEPS + x, height[k] + y);
            if (k > 0)
                support_add_segment(&pslg, v - 1, v);
        }
    return pslg;
}

/* The space between two lines is too expensive to fill, and its width at ends and corners is not treated as a
   feature. */
static void test_a_line_drawn_twice_is_not_filled(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 5; seed++) {
        int32_t once = count_refined(zigzag(1, 0, seed));
        for (int exponent = -48; exponent <= -20; exponent += 4)
            assert_true(count_refined(zigzag(2, ldexp(1, exponent), seed)) <= 2 * once);
    }
}

static struct tri_pslg scaled(const struct tri_pslg *pslg, int exponent)
{
    struct tri_pslg copy = support_pslg(pslg->n_points, pslg->n_segments, 0, 0);
    for (int32_t v = 0; v < pslg->n_points; v++)
        support_add_point(&copy, ldexp(pslg->points[2 * v], exponent), ldexp(pslg->points[2 * v + 1], exponent));
    for (int32_t s = 0; s < pslg->n_segments; s++)
        support_add_segment(&copy, pslg->segments[2 * s], pslg->segments[2 * s + 1]);
    return copy;
}

/* Every vertex lies at a double: the coordinates that are written are those that the predicates used. */
static void assert_exact(const struct tri_mesh *mesh)
{
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        double at[2];
        tri_mesh_place(mesh, v, at);
        assert_true(at[0] / mesh->unit == mesh->xy[v].x && at[1] / mesh->unit == mesh->xy[v].y);
    }
}

static void test_the_mesh_is_the_same_at_any_scale(void **state)
{
    (void)state;
    static const int exponents[] = {0, 199, 900, -99, -216, -800, -810, -900, -980};
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 20, 10, 3);
    struct tri_mesh usual = refined(&pslg, 28, false);
    struct support_set expected = support_triangles(&usual);
    for (size_t i = 0; i < sizeof exponents / sizeof *exponents; i++) {
        struct tri_pslg other = scaled(&pslg, exponents[i]);
        struct tri_mesh mesh = refined(&other, 28, false);
        struct support_set found = support_triangles(&mesh);
        assert_true(support_same(&expected, &found));
        assert_exact(&mesh);
        support_set_free(&found);
        tri_mesh_free(&mesh);
        tri_pslg_free(&other);
    }
    support_set_free(&expected);
    tri_mesh_free(&usual);
    tri_pslg_free(&pslg);
}

/* Near the origin of a tiny figure, points differ only in the last representable doubles. */
static void test_no_rounding_folds_a_tiny_mesh(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct support_random random = {seed};
        struct tri_pslg pslg = support_pslg(16, 8, 0, 0);
        const double size = seed % 2 ? 1e-300 : DBL_MIN;
        for (int k = 0; k < 4; k++)
            support_add_point(&pslg, k == 1 || k == 2 ? size : -size, k >= 2 ? size : -size);
        for (int k = 0; k < 12; k++)
            support_add_point(&pslg, ldexp(support_below(&random, 400) - 200, -1074),
                              ldexp(support_below(&random, 400) - 200, -1074));
        for (int k = 0; k < 8; k++)
            support_add_segment(&pslg, 4 + support_below(&random, 12), 4 + support_below(&random, 12));
        struct tri_options options = tri_defaults();
        options.use_segments = options.keep_hull = true;
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        struct tri_check_options check = {.max_bad = -1, .border = TRI_CHECK_BORDER_HULL};
        support_judge(&mesh, &pslg, &check, false, NULL);
        assert_exact(&mesh);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_subnormal_figures_are_refused(void **state)
{
    (void)state;
    for (int exponent = -1074; exponent <= -1022; exponent += 13) {
        struct tri_pslg square = support_square(1, 0, 1), tiny = scaled(&square, exponent);
        struct tri_options options = support_quality(20, 0);
        struct tri_report report;
        struct tri_mesh mesh;
        struct tri_error error = {0};
        enum tri_status status = tri_generate(&mesh, &tiny, &options, &report, &error);
        assert_int_equal(status, exponent < -1022 ? TRI_BAD_INPUT : TRI_OK);
        assert_true(status == TRI_OK || error.text[0]);
        if (!status)
            tri_mesh_free(&mesh);
        tri_pslg_free(&tiny);
        tri_pslg_free(&square);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_vertices_near_a_segment_are_features),
        cmocka_unit_test(test_a_corner_near_a_wall_is_meshed),
        cmocka_unit_test(test_borders_within_rounding_are_no_features),
        cmocka_unit_test(test_a_line_drawn_twice_is_not_filled),
        cmocka_unit_test(test_the_mesh_is_the_same_at_any_scale),
        cmocka_unit_test(test_no_rounding_folds_a_tiny_mesh),
        cmocka_unit_test(test_subnormal_figures_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
