/* What the mesher makes of thousands of tangles (see tangles.h), each put before the judge: triangulated, with hull and
 * carved, and refined. TANGLES: how many of each family. */
#include "tangles.h"
#include "triangle/crossing.h"

static struct tri_options triangulated(void)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    return options;
}

/* New points are limited: rounding makes features of any smallness. */
static struct tri_options refined(double min_angle, bool conforming)
{
    struct tri_options options = support_quality(min_angle, 0);
    options.quality.conforming = conforming;
    options.quality.max_steiner = 2000;
    return options;
}

static void expect_good(int family, uint64_t seed, struct tri_options options)
{
    struct tri_pslg pslg = tangles_make(family, seed);
    struct tri_check_options asked = {.max_bad = INT64_MAX, .ignore_holes = true};
    struct tri_check_report judgement;
    struct tri_report report;
    struct tri_error error = {0};
    struct tri_mesh mesh;
    char text[SUPPORT_TEXT];
    if (tri_generate(&mesh, &pslg, &options, &report, &error) != TRI_OK)
        fail_msg("%s, seed %d: %s", tangles_name(family), (int)seed, error.text);
    asked.border = options.keep_hull ? TRI_CHECK_BORDER_HULL : TRI_CHECK_BORDER_SEGMENTS;
    asked.convex = options.keep_hull && !options.refine && !mesh.twin;
    if (mesh.n_triangles > 0 && !support_passes(&mesh, &pslg, &asked, false, &judgement, text))
        fail_msg("%s, seed %d: %s", tangles_name(family), (int)seed, text);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void expect_all_good(struct tri_options options, int n)
{
    for (int family = 0; family < tangles_families(); family++)
        for (int seed = 0; seed < n; seed++)
            expect_good(family, (uint64_t)seed, options);
}

static void test_with_hull(void **state)
{
    (void)state;
    struct tri_options options = triangulated();
    options.keep_hull = true;
    expect_all_good(options, TANGLES);
}

static void test_carved(void **state)
{
    (void)state;
    expect_all_good(triangulated(), TANGLES);
}

static void test_refined(void **state)
{
    (void)state;
    expect_all_good(refined(20, false), TANGLES / 6);
    expect_all_good(refined(30, true), TANGLES / 6);
}

/* Each crossing is that of the input segments, so that errors do not add up along the one that hundreds cross. */
static void test_crossings_do_not_drift(void **state)
{
    (void)state;
    int32_t crossings = 0;
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct tri_constrain_report report;
        struct tri_pslg pslg = tangles_make(tangles_families() - 1, seed);
        struct tri_mesh mesh = support_constrained(&pslg, &report);
        for (int32_t s = 0; report.bent == 0 && s < mesh.n_subs; s++) {
            struct tri_point p = mesh.xy[mesh.sub[s].v[1]];
            if (mesh.parents[mesh.sub[s].parent].segment != 0)
                continue;
            assert_true(tri_line_distance(mesh.xy[0], mesh.xy[1], p) <= tri_resolution(p));
            crossings++;
        }
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_true(crossings > 500);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_with_hull),
        cmocka_unit_test(test_carved),
        cmocka_unit_test(test_refined),
        cmocka_unit_test(test_crossings_do_not_drift),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
