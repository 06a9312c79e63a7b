/* Where refinement gives up: narrow spaces, flat triangles, hubs of many segments. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

#include "tests/support.h"
#include "triangle/size/gap.h"

/* Refines a rectangle of length 1 and this height to 20 degrees. Returns the number of triangles; *in_narrow_gap: how
 * many stay bad in narrow gaps. */
static int32_t refine_rectangle(double height, int64_t *in_narrow_gap)
{
    struct tri_pslg pslg = support_pslg(4, 4, 0, 0);
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 1, 0);
    support_add_point(&pslg, 1, height);
    support_add_point(&pslg, 0, height);
    for (int32_t i = 0; i < 4; i++)
        support_add_segment(&pslg, i, (i + 1) % 4);
    struct tri_options options = support_quality(20, 0);
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    int64_t count[TRI_EXCUSES];
    tri_count_bad(&mesh, &options.quality, &report.quality, NULL, count);
    *in_narrow_gap = count[TRI_EXCUSE_NARROW_GAP];
    for (int k = 0; k < TRI_EXCUSES; k++)
        assert_true(k == TRI_EXCUSE_NARROW_GAP || count[k] == 0);
    int32_t triangles = mesh.n_triangles;
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    return triangles;
}

static void test_thin_rectangles_are_filled_while_that_is_cheap(void **state)
{
    (void)state;
    int64_t in_narrow_gap;
    assert_in_range(refine_rectangle(1e-3, &in_narrow_gap), 500, 3000);
    assert_int_equal(in_narrow_gap, 0);
    assert_in_range(refine_rectangle(1e-5, &in_narrow_gap), 50000, 300000);
    assert_int_equal(in_narrow_gap, 0);
    assert_in_range(refine_rectangle(1e-8, &in_narrow_gap), 2, 100);
    assert_true(in_narrow_gap > 0);
}

/* Two segments of length 1 are `width` apart at their start and `width + spread` apart at their end. Returns the cost
 * of filling the space between them, computed at the start, over the integral of 1 / width. */
static double cost_over_integral(double width, double spread)
{
    struct tri_point xy[] = {{0, 0}, {1, 0}, {0, width}, {1, width + spread}};
    struct tri_parent parents[] = {{.v = {0, 1}}, {.v = {2, 3}}};
    struct tri_mesh mesh = {.xy = xy, .parents = parents, .limits.shortest2 = 0x1p-90};
    double cost = tri_filling_cost(&mesh, 0, 1, xy[0], xy[2]);
    return cost / (spread > 0 ? log1p(spread / width) / spread : 1 / width);
}

static void test_filling_cost_matches_the_integral(void **state)
{
    (void)state;
    const double WIDTHS[] = {1e-9, 1e-6, 1e-3, 0.1}, SPREADS[] = {0, 1e-9, 1e-6, 1e-3, 0.1};
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 5; k++) {
            double ratio = cost_over_integral(WIDTHS[i], SPREADS[k]);
            assert_true(ratio > 0.99 && ratio < 1.6);
        }
}

/* Rounding puts split points off their segment, next to a triangle that is even flatter. The mesh must stay
 * Delaunay. */
static void test_flat_neighbour_keeps_the_mesh_delaunay(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(4, 1, 0, 0);
    support_add_point(&pslg, -2.010477735624757, 0.9787641567595076);
    support_add_point(&pslg, -0.9999439256018043, -0.010589884421148416);
    support_add_point(&pslg, -3.0210115456477102, 1.9681181979401634);
    support_add_point(&pslg, -3.0316014300688585, 2.968062123541968);
    support_add_segment(&pslg, 0, 1);
    struct tri_options options = support_quality(20, 0);
    struct tri_report report;
    options.keep_hull = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_check_options asked = {.max_bad = mesh.n_triangles, .border = TRI_CHECK_BORDER_HULL};
    support_judge(&mesh, &pslg, &asked, false, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Many parents at one vertex are sorted by direction, regardless of their order in the input. */
static void test_spokes_of_a_hub_are_in_order(void **state)
{
    (void)state;
    enum { N = 200 };
    struct support_random random = {5};
    struct tri_pslg pslg = support_pslg(N + 1, N, 0, 0);
    struct tri_options options = tri_defaults();
    support_add_point(&pslg, 0.25, -0.5);
    for (int32_t i = 0; i < N; i++)
        support_add_point(&pslg, support_unit(&random) - 0.5, support_unit(&random) - 0.75);
    for (int32_t i = 0; i < N; i++)
        support_add_segment(&pslg, i % 2 ? 0 : i + 1, i % 2 ? i + 1 : 0);
    options.use_segments = options.keep_hull = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    int32_t first = mesh.incidence.start[0], n = mesh.incidence.start[1] - first, wraps = 0;
    assert_true(n >= N);
    for (int32_t i = 0; i < n; i++) {
        const int32_t *a = mesh.parents[mesh.incidence.parent[first + i]].v;
        const int32_t *b = mesh.parents[mesh.incidence.parent[first + (i + 1) % n]].v;
        struct tri_point p = mesh.xy[a[a[0] == 0]], q = mesh.xy[b[b[0] == 0]];
        wraps += p.y < -0.5 && q.y >= -0.5;
        assert_true(tri_orient2d(mesh.xy[0], p, q) > 0);
    }
    assert_int_equal(wraps, 1);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_thin_rectangles_are_filled_while_that_is_cheap),
        cmocka_unit_test(test_filling_cost_matches_the_integral),
        cmocka_unit_test(test_flat_neighbour_keeps_the_mesh_delaunay),
        cmocka_unit_test(test_spokes_of_a_hub_are_in_order),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
