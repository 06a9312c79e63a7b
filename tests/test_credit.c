/* Points on credit: how they are counted, and that no call inserts more than it may. */
#include "sched/schedule.h"
#include "support.h"
#include "triangle/credit.h"

static double sizes[4] = {1, -1, 2, 3};
static const struct tri_mesh mesh_of_four = {.feature = sizes, .n_vertices = 4};

static void test_corners_grant_credit(void **state)
{
    (void)state;
    static const tri_vertex_id first[3] = {0, 1, 2}, second[3] = {2, 1, 3};
    struct tri_credit credit = {0};
    assert_false(tri_has_credit(&credit, TRI_CLAIM_POOR));
    assert_true(tri_meet_corners(&credit, &mesh_of_four, first) && tri_meet_corners(&credit, &mesh_of_four, first));
    assert_int_equal(credit.granted, 6 * 2 * TRI_CREDIT); /* vertex 1 is on credit, the others are met once */
    assert_true(tri_meet_corners(&credit, &mesh_of_four, second));
    assert_int_equal(credit.granted, 6 * 3 * TRI_CREDIT);
    tri_credit_free(&credit);
}

/* Of a worklist: a sixth of each corner that is not on credit, if at least half of them belong to triangles that ask,
 * and twice those that do if fewer. */
static void test_triangles_that_ask_grant_credit(void **state)
{
    (void)state;
    static const tri_vertex_id all[3] = {0, 2, 3}, some[3] = {2, 1, 3};
    for (int good = 0; good < 5; good++) {
        struct tri_grantors grantors = {0};
        struct tri_credit credit = {0};
        tri_list_corners(&grantors, &mesh_of_four, some, true);
        for (int i = 0; i < good; i++)
            tri_list_corners(&grantors, &mesh_of_four, all, false);
        tri_grant(&credit, &grantors);
        assert_int_equal(credit.granted, (good > 0 ? 4 : 2) * TRI_CREDIT);
    }
}

static void take(struct tri_credit *credit, int points, enum tri_claim claim)
{
    for (int i = 0; i < points; i++) {
        assert_true(tri_has_credit(credit, claim));
        tri_count_credit(credit, true);
    }
    assert_false(tri_has_credit(credit, claim));
}

/* All that is granted, then twice and once as much more. */
static void test_points_are_counted(void **state)
{
    (void)state;
    struct tri_credit credit = {0};
    tri_count_credit(&credit, false);
    tri_count_credit(&credit, false);
    take(&credit, 2 * TRI_CREDIT, TRI_CLAIM_NEARLY_GOOD);
    take(&credit, 4 * TRI_CREDIT, TRI_CLAIM_FAIR);
    take(&credit, 2 * TRI_CREDIT, TRI_CLAIM_POOR);
}

struct count {
    int32_t on_credit, others, triangles;
    bool capped;
};

static struct count count_points(const struct tri_mesh *mesh, const struct tri_refine_report *report)
{
    struct count count = {.triangles = mesh->n_triangles, .capped = report->hit_cap};
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        *(tri_is_on_credit(mesh, v) ? &count.on_credit : &count.others) += 1;
    return count;
}

/* cell > 0: by the schedule, with so many triangles in a cell. */
static struct count refine_as(const struct tri_pslg *pslg, struct tri_options options, int32_t cell)
{
    struct tri_report report;
    struct par_report schedule = {0};
    options.keep_hull = true;
    options.refine = cell == 0;
    struct tri_mesh mesh = support_generate(pslg, &options, &report);
    struct par_options how = par_defaults();
    how.threads = 1;
    how.cell_triangles = cell;
    if (cell > 0)
        assert_int_equal(par_refine(&mesh, &options.quality, &how, &schedule, NULL), TRI_OK);
    struct count count = count_points(&mesh, cell > 0 ? &schedule.total : &report.quality);
    par_report_free(&schedule);
    tri_mesh_free(&mesh);
    return count;
}

static struct count refine(const struct tri_pslg *pslg, double angle, int32_t cell)
{
    return refine_as(pslg, support_quality(angle, 0), cell);
}

static void test_no_more_than_may_be(void **state)
{
    (void)state;
    static const char *const names[] = {"regress/credit_wedge.poly", "regress/credit_grid.poly",
                                        "regress/ranaway_zigzag.poly", "cracked_plate.poly", "naca2412_box.poly"};
    static const double angles[] = {28, 30, 33, 34};
    for (int i = 0; i < 5; i++)
        for (int k = 0; k < 4; k++) {
            struct tri_pslg pslg;
            assert_true(support_read(names[i], &pslg));
            struct count whole = refine(&pslg, angles[k], 0), cells = refine(&pslg, angles[k], 60);
            assert_true(angles[k] > TRI_PROMISED_ANGLE || whole.on_credit + cells.on_credit == 0);
            const int32_t most = 4 * (TRI_ALLOWANCE + TRI_CREDIT * whole.others);
            assert_true(whole.on_credit <= most);
            assert_true(cells.on_credit <= 2 * most); /* those in several blocks grant more */
            assert_true(!whole.capped || i < 3);
            tri_pslg_free(&pslg);
        }
}

/* Where all that is found is on credit, all that comes of it is, and a call has its allowance alone: that of a block,
 * within a fence. */
static void test_what_credit_begets_is_counted(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_options options = support_quality(TRI_USUAL_ANGLE, 0);
    struct tri_report made;
    struct tri_refine_report report;
    static const struct tri_fence around = {-1e9, -1e9, 1e9, 1e9};
    assert_true(support_read("koch_lake.poly", &pslg));
    options.refine = false;
    struct tri_mesh mesh = support_generate(&pslg, &options, &made);
    assert_int_equal(tri_refine_prepare(&mesh, NULL, NULL), TRI_OK);
    for (tri_vertex_id v = 0; v < mesh.n_vertices; v++)
        mesh.feature[v] = -mesh.feature[v];
    options.quality.fence = &around;
    assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
    assert_true(report.hit_cap);
    assert_int_equal(report.inserted_free + report.inserted_on_segments, 4 * TRI_BLOCK_ALLOWANCE);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Features that differ by twelve orders of magnitude: few vertices, and many that theory does promise. */
static void test_graded_figures_are_not_capped(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("nasty/tiny_feature.poly", &pslg));
    for (int angle = 28; angle <= 34; angle += 2)
        assert_false(refine(&pslg, angle, 0).capped);
    tri_pslg_free(&pslg);
}

/* A zigzag with small angles: 562 triangles at 28 degrees, 5,603 at 34. */
static void test_a_mesh_does_not_run_on(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("regress/ranaway_zigzag.poly", &pslg));
    struct count promised = refine(&pslg, TRI_PROMISED_ANGLE, 0), usual = refine(&pslg, TRI_USUAL_ANGLE, 0);
    assert_true(usual.capped && usual.triangles <= 10 * promised.triangles + 3 * TRI_ALLOWANCE);
    tri_pslg_free(&pslg);
}

/* Vertices an ulp off the hull of a turned grid: sizes came down to that gap, and triangles around it grew as small (in
 * one call 2,600 and 5,693, in cells of 60 4,958). */
static void test_gaps_too_fine_for_coordinates_take_no_points(void **state)
{
    (void)state;
    static const char *const names[] = {"regress/credit_grid.poly", "regress/credit_wedge.poly",
                                        "regress/ulp_beside.poly"};
    static const int32_t cell[] = {0, 0, 60}, most[] = {1000, 500, 4000};
    for (int i = 0; i < 3; i++) {
        struct tri_pslg pslg;
        assert_true(support_read(names[i], &pslg));
        assert_true(refine(&pslg, TRI_USUAL_ANGLE, cell[i]).triangles <= most[i]);
        tri_pslg_free(&pslg);
    }
}

/* Nor do they take the place of those that theory promises, and stop: a star of 14 spikes that meet in a hub. */
static void test_credit_is_no_hindrance(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("regress/credit_star.poly", &pslg));
    assert_true(refine(&pslg, 33, 0).triangles >= refine(&pslg, TRI_PROMISED_ANGLE, 0).triangles);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_corners_grant_credit),
        cmocka_unit_test(test_triangles_that_ask_grant_credit),
        cmocka_unit_test(test_points_are_counted),
        cmocka_unit_test(test_no_more_than_may_be),
        cmocka_unit_test(test_what_credit_begets_is_counted),
        cmocka_unit_test(test_graded_figures_are_not_capped),
        cmocka_unit_test(test_a_mesh_does_not_run_on),
        cmocka_unit_test(test_gaps_too_fine_for_coordinates_take_no_points),
        cmocka_unit_test(test_credit_is_no_hindrance),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
