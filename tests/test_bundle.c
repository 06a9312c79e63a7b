/* Number of steps for segments that run along each other or along many vertices, within rounding error. */
#include "support.h"

/* N points along a line, as exactly as rounding allows, and four corners around it. */
static struct tri_pslg along_a_line(int32_t n, int32_t segments, double slope)
{
    struct tri_pslg pslg = support_pslg(n + 4, segments, 0, 0);
    for (int32_t i = 0; i < n; i++)
        support_add_point(&pslg, 0.29 * i, slope * 0.29 * i);
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k % 2 ? n : -1, k / 2 ? n : -n);
    return pslg;
}

/* Asserts that the segments are inserted in O(n) steps, as one chain. */
static void assert_short_work(struct tri_pslg *pslg, int32_t n)
{
    struct tri_constrain_report report;
    struct tri_mesh mesh = support_constrained(pslg, &report);
    support_assert_cdt(&mesh, false);
    support_judge_hull(&mesh, pslg);
    assert_int_equal(mesh.n_subs, n - 1 + 4);
    print_message("  %d vertices in one chain: %lld triangles looked at\n", (int)n, (long long)report.looked_at);
    assert_true(report.looked_at < 150 * (int64_t)n);
    tri_mesh_free(&mesh);
    tri_pslg_free(pslg);
}

/* A path to and fro. Each of its segments runs along a third of the points on average, exactly on their line or a
 * little beside it. */
static void check_path_to_and_fro(double slope)
{
    enum { N = 1500 };
    struct support_random random = {11};
    struct tri_pslg pslg = along_a_line(N, N - 1, slope);
    int32_t order[N];
    for (int32_t i = 0; i < N; i++) {
        int32_t j = support_below(&random, i + 1);
        order[i] = order[j];
        order[j] = i;
    }
    for (int32_t i = 1; i < N; i++)
        support_add_segment(&pslg, order[i - 1], order[i]);
    assert_short_work(&pslg, N);
}

static void test_paths_to_and_fro_take_little_work(void **state)
{
    (void)state;
    check_path_to_and_fro(1 / 3.0);
    check_path_to_and_fro(1);
}

/* Segments from one end to all other points, the shortest first. */
static void test_rays_along_a_line_take_little_work(void **state)
{
    (void)state;
    enum { N = 1500 };
    struct tri_pslg pslg = along_a_line(N, N - 1, 0.7);
    for (int32_t i = 1; i < N; i++)
        support_add_segment(&pslg, 0, i);
    assert_short_work(&pslg, N);
}

/* One segment whose far end lies one ulp off the line of all other points. The point nearest to the segment is always
 * the first. */
static void test_a_side_an_ulp_off_takes_little_work(void **state)
{
    (void)state;
    enum { N = 1500 };
    struct tri_pslg pslg = support_pslg(N + 4, 1, 0, 0);
    for (int32_t i = 0; i < N; i++)
        support_add_point(&pslg, 1 + i / (double)N, i == N - 1 ? nextafter(1.9, 2) : 1.9);
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k % 2 ? 0 : 3, k / 2 ? 0 : 3);
    support_add_segment(&pslg, 0, N - 1);
    assert_short_work(&pslg, N);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_paths_to_and_fro_take_little_work),
        cmocka_unit_test(test_rays_along_a_line_take_little_work),
        cmocka_unit_test(test_a_side_an_ulp_off_takes_little_work),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
