/* Counts and shapes are compared with known meshes, Euler's formula, and the checker's own measurements. */
#include "triangle/mesh/topology.h"

#include "tests/support.h"

static struct tri_counts counted(const struct tri_mesh *mesh)
{
    struct tri_counts counts;
    assert_int_equal(tri_count_mesh(&counts, mesh, NULL, NULL), TRI_OK);
    return counts;
}

/* An equilateral triangle with a right-angled one on its base. */
static struct tri_mesh two_triangles(double scale)
{
    struct tri_pslg pslg = support_pslg(4, 5, 0, 0);
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 2 * scale, 0);
    support_add_point(&pslg, scale, sqrt(3) * scale);
    support_add_point(&pslg, 0, -0.01 * scale);
    support_add_segment(&pslg, 0, 1);
    support_add_segment(&pslg, 1, 2);
    support_add_segment(&pslg, 2, 0);
    support_add_segment(&pslg, 0, 3);
    support_add_segment(&pslg, 3, 1);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    tri_pslg_free(&pslg);
    return mesh;
}

static void test_counts_of_a_known_mesh(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles(1);
    struct tri_counts counts = counted(&mesh);
    assert_int_equal(counts.vertices, 4);
    assert_int_equal(counts.triangles, 2);
    assert_int_equal(counts.edges, 5);
    assert_int_equal(counts.exterior, 4);
    assert_int_equal(counts.interior, 1);
    assert_int_equal(counts.subsegments, 5);
    tri_mesh_free(&mesh);
}

/* Refinement leaves no vertex without triangles, except those that had none before. */
static void test_refined_meshes_have_no_new_unused_vertices(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_LATTICE, 500, 1);
    struct tri_options options = tri_defaults();
    struct tri_report report;
    options.refine = true;
    options.quality.max_area = 0.1;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_counts counts = counted(&mesh), again;
    assert_true(report.duplicates > 0 && mesh.n_vertices > 500);
    tri_count_refined(&again, &mesh, report.duplicates);
    assert_memory_equal(&again, &counts, sizeof counts);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Vertices that no triangle uses do not count. The number of edges follows from Euler's formula for a disc. */
static void test_unused_vertices_do_not_count(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_LATTICE, 500, 1);
    struct tri_options options = tri_defaults();
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_counts counts = counted(&mesh);
    assert_true(report.duplicates > 0);
    assert_int_equal(counts.vertices, 500 - report.duplicates);
    assert_int_equal(counts.vertices - counts.edges + counts.triangles, 1);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static bool is_near(double a, double b) { return fabs(a - b) <= 1e-12 * fabs(b); }

static void test_shapes_of_known_triangles(void **state)
{
    (void)state;
    static const double scales[] = {1, 1e-300, 1e150};
    for (int i = 0; i < 3; i++) {
        double scale = scales[i], hypotenuse = sqrt(4.0001);
        struct tri_mesh mesh = two_triangles(scale);
        struct tri_shapes s;
        tri_measure_shapes(&s, &mesh, NULL);
        if (i != 1) { /* an area of 1e-602 underflows */
            assert_true(is_near(s.smallest_area, 0.01 * scale * scale));
            assert_true(is_near(s.largest_area, sqrt(3) * scale * scale));
        }
        assert_true(is_near(s.shortest_edge, 0.01 * scale));
        assert_true(is_near(s.longest_edge, hypotenuse * scale));
        assert_true(is_near(s.shortest_altitude, 0.02 / hypotenuse * scale));
        assert_true(is_near(s.largest_aspect, 4.0001 / 0.02));
        assert_true(is_near(s.smallest_angle, atan(0.005) * 180 / acos(-1)));
        assert_true(is_near(s.largest_angle, 90));
        assert_int_equal(s.aspects[0], 1); /* 2 / sqrt(3) is just above 1.1547 */
        assert_int_equal(s.aspects[11], 1); /* 100 to 300 */
        assert_int_equal(s.angles[0], 1);
        assert_int_equal(s.angles[5] + s.angles[6], 3); /* 60 degrees */
        assert_int_equal(s.angles[8] + s.angles[9], 2); /* 89.7 and 90 */
        tri_mesh_free(&mesh);
    }
}

/* The bins add up to the totals, and the extremes are those that the checker computes in its own way. */
static void assert_as_judged(double max_area, const struct tri_executor *executor)
{
    struct tri_pslg pslg = support_polygon(80, 9);
    struct tri_options options = support_quality(25, max_area);
    struct tri_report report;
    struct tri_check_report judged;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    const struct tri_check_options judge = {.max_bad = INT64_MAX};
    support_judge(&mesh, &pslg, &judge, false, &judged);
    tri_mesh_compact(&mesh);
    struct tri_counts counts = counted(&mesh);
    struct tri_shapes s;
    tri_measure_shapes(&s, &mesh, executor);
    int64_t triangles = 0, angles = 0;
    for (int k = 0; k < TRI_ASPECT_BINS; k++)
        triangles += s.aspects[k];
    for (int k = 0; k < TRI_ANGLE_BINS; k++)
        angles += s.angles[k];
    assert_int_equal(triangles, counts.triangles);
    assert_int_equal(angles, 3 * counts.triangles);
    assert_int_equal(counts.edges, judged.n_edges);
    assert_int_equal(counts.exterior, judged.n_boundary_edges);
    assert_int_equal(counts.vertices, judged.n_used_points);
    assert_true(fabs(s.smallest_angle - judged.smallest_angle) < 1e-9);
    assert_true(fabs(s.largest_angle - judged.largest_angle) < 1e-9);
    assert_true(is_near(s.smallest_area, judged.smallest_area));
    assert_true(is_near(s.largest_area, judged.largest_area));
    assert_true(is_near(s.total_area, judged.total_area));
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_statistics_agree_with_the_checker(void **state)
{
    (void)state;
    assert_as_judged(0.01, NULL);
    assert_as_judged(5e-5, &support_backwards); /* so many that the work is divided into shares */
}

/* Right angles are common and exact. They count as at most 90 degrees. */
static void test_right_angles_count_as_at_most_90_degrees(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 0, 1);
    struct tri_options options = tri_defaults();
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    struct tri_shapes s;
    tri_measure_shapes(&s, &mesh, NULL);
    assert_int_equal(s.angles[8], 2);
    assert_int_equal(s.angles[9], 0);
    assert_int_equal(s.angles[4], 4);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_an_empty_mesh_has_zero_counts(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_LINE, 3, 1);
    for (int32_t i = 0; i < 3; i++)
        pslg.points[2 * i] = pslg.points[2 * i + 1] = i;
    struct tri_options options = tri_defaults();
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    struct tri_counts counts = counted(&mesh);
    struct tri_shapes s;
    tri_measure_shapes(&s, &mesh, NULL);
    assert_int_equal(counts.vertices + counts.triangles + counts.edges + counts.exterior, 0);
    assert_true(s.smallest_area == 0 && s.largest_angle == 0 && s.angles[0] == 0);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts_of_a_known_mesh),
        cmocka_unit_test(test_unused_vertices_do_not_count),
        cmocka_unit_test(test_refined_meshes_have_no_new_unused_vertices),
        cmocka_unit_test(test_shapes_of_known_triangles),
        cmocka_unit_test(test_statistics_agree_with_the_checker),
        cmocka_unit_test(test_right_angles_count_as_at_most_90_degrees),
        cmocka_unit_test(test_an_empty_mesh_has_zero_counts),
    };
    return cmocka_run_group_tests_name("stats", tests, NULL, NULL);
}
