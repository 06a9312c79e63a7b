/* Diametral circles: conforming meshes of segments that lie close together, and the places where circles are not
 * empty. */
#include "support.h"

#include "triangle/refine/split.h"

static struct tri_mesh conforming(const struct tri_pslg *pslg, double angle, struct tri_report *report)
{
    struct tri_options options = support_quality(angle, 0);
    options.quality.conforming = true;
    return support_generate(pslg, &options, report);
}

/* Asserts, with the checker and with the census, that all circles are empty. */
static void judge_conforming(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_report *report)
{
    struct tri_check_options check = {.delaunay = TRI_CHECK_CONFORMING};
    struct tri_quality options = {.conforming = true};
    int64_t count[TRI_EXCUSES];
    support_judge(mesh, pslg, &check, false, NULL);
    tri_count_encroached(mesh, &options, &report->quality, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        assert_int_equal(count[k], 0);
}

/* n segments from the middle of a square. Each is turned from the previous one by an angle with a tangent between 1e-5
 * and 1. */
static struct tri_pslg needle_figure(int32_t n, uint64_t seed)
{
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(n + 5, n + 4, 0, 0);
    double x = 1, y = 0;
    for (int32_t i = 0; i < 4; i++) {
        support_add_point(&pslg, i == 1 || i == 2 ? 2 : -2, i >= 2 ? 2 : -2);
        support_add_segment(&pslg, i, (i + 1) % 4);
    }
    support_add_point(&pslg, 0, 0);
    for (int32_t i = 0; i < n; i++) {
        double slope = 1, length = 0.1 + support_unit(&random);
        for (int32_t k = support_below(&random, 6); k > 0; k--)
            slope /= 10;
        double turned = x - slope * y;
        y += slope * x;
        x = turned;
        length /= sqrt(x * x + y * y);
        support_add_segment(&pslg, 4, support_add_point(&pslg, length * x, length * y));
    }
    return pslg;
}

static void test_needles_become_conforming(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 40; seed++)
        for (int angle = 0; angle <= 30; angle += 30) {
            struct tri_report report;
            struct tri_pslg pslg = needle_figure(7, seed);
            struct tri_mesh mesh = conforming(&pslg, angle, &report);
            judge_conforming(&mesh, &pslg, &report);
            assert_true(angle > 0 || mesh.n_triangles < 1000);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* n segments side by side across a square. The number of new points depends on their 2 n ends, not on length /
 * width. */
static void test_bundles_become_conforming(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        enum { N = 6 };
        struct support_random random = {seed};
        struct tri_report report;
        struct tri_pslg pslg = support_square(1, 0, 0);
        struct tri_pslg all = support_pslg(4 + 2 * N, 4 + N, 0, 0);
        for (int32_t i = 0; i < 4; i++) {
            support_add_point(&all, pslg.points[2 * i], pslg.points[2 * i + 1]);
            support_add_segment(&all, i, (i + 1) % 4);
        }
        for (int32_t i = 0; i < N; i++) {
            double left = 0.1 + 0.3 * support_unit(&random), right = 0.6 + 0.3 * support_unit(&random);
            double y = 0.5 + 1e-6 * i, rise = 1e-7 * support_unit(&random);
            int32_t a = support_add_point(&all, left, y), b = support_add_point(&all, right, y + rise);
            support_add_segment(&all, a, b);
        }
        struct tri_mesh mesh = conforming(&all, 0, &report);
        judge_conforming(&mesh, &all, &report);
        assert_true(mesh.n_triangles < 2000);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
        tri_pslg_free(&all);
    }
}

/* A spike a few million units in the last place wide. Rounding must not shift its level vertices along the spike. */
static void test_levels_are_level_in_spite_of_rounding(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("regress/endless_q36_small.poly", &pslg));
    for (int angle = 0; angle <= 36; angle += 18) {
        struct tri_report report;
        struct tri_mesh mesh = conforming(&pslg, angle, &report);
        judge_conforming(&mesh, &pslg, &report);
        tri_mesh_free(&mesh);
    }
    tri_pslg_free(&pslg);
}

/* Returns the number of circles that are not empty, for any reason. */
static int64_t circles_left(const struct tri_mesh *mesh, const struct tri_report *report)
{
    struct tri_quality options = {.conforming = true};
    int64_t count[TRI_EXCUSES], left = 0;
    tri_count_encroached(mesh, &options, &report->quality, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        left += count[k];
    return left;
}

/* The lines of a fan meet at a point with one coordinate far smaller than the other. Some suitable places differ only
 * in the small coordinate, and must be found. */
static void test_finer_coordinates_resolve_more(void **state)
{
    (void)state;
    static const struct {
        const char *file;
        int angle;
        int64_t most; /* the results when only places next to the rounded one are tried: */
    } cases[] = {{"regress/endless_q36_fan.poly", 0, 60}, /* 98 */
                 {"regress/endless_q36_fan.poly", 20, 90}}; /* 178 */
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_pslg pslg;
        struct tri_report report;
        assert_true(support_read(cases[i].file, &pslg));
        struct tri_mesh mesh = conforming(&pslg, cases[i].angle, &report);
        assert_in_range(circles_left(&mesh, &report), 0, cases[i].most);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* A high and narrow wall on the boundary. Rounding puts split points off the wall by units of its height. They must
 * return to its line instead of moving inwards until no place for a split is left. */
static void test_boundaries_come_back_to_their_lines(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    struct tri_report report;
    assert_true(support_read("regress/chord_within.poly", &pslg));
    struct tri_mesh mesh = conforming(&pslg, 30, &report);
    judge_conforming(&mesh, &pslg, &report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* The loop leaves no subsegment that can be split encroached, and no split makes a part shorter than half the shortest
 * edge. */
static void test_no_splittable_subsegment_stays_encroached(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 60; seed++) {
        struct tri_report report;
        struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 10, (int32_t)(seed % 12), seed);
        struct tri_options options = support_quality(0, 0);
        struct tri_mesh mesh = support_generate(&pslg, &options, &report);
        for (int32_t s = 0; s < mesh.n_subs; s++) {
            struct tri_disk_split split;
            const tri_vertex_id *v = mesh.sub[s].v;
            double length = sqrt(tri_distance2(mesh.xy[v[0]], mesh.xy[v[1]]));
            if (tri_is_encroached(&mesh, &mesh.sub[s], &split))
                assert_true(fmin(split.fraction, 1 - split.fraction) * length >= 0.5 * sqrt(mesh.limits.shortest2));
        }
        options.quality.conforming = true;
        assert_int_equal(tri_refine(&mesh, &options.quality, &report.quality, NULL), TRI_OK);
        for (int32_t s = 0; s < mesh.n_subs; s++) {
            struct tri_disk_split split;
            assert_false(tri_is_encroached(&mesh, &mesh.sub[s], &split));
        }
        judge_conforming(&mesh, &pslg, &report);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Circles that are not empty because of -YY are counted under that reason. */
static void test_protected_circles_are_counted(void **state)
{
    (void)state;
    int64_t count[TRI_EXCUSES];
    struct tri_report report;
    struct tri_pslg pslg = needle_figure(7, 1);
    struct tri_options options = support_quality(0, 0);
    options.quality.conforming = true;
    options.quality.protect = 2;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    tri_count_encroached(&mesh, &options.quality, &report.quality, count);
    assert_true(count[TRI_EXCUSE_PROTECTED] > 0);
    assert_int_equal(report.quality.inserted_on_segments, 0);
    options.quality.protect = 0;
    tri_count_encroached(&mesh, &options.quality, &report.quality, count);
    assert_true(count[TRI_EXCUSE_PRECISION] > 0 && count[TRI_EXCUSE_PROTECTED] == 0); /* no option forbids it now */
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Returns true if the circle of s cannot be emptied of the apex on this side, because coordinates do not resolve it or
 * rounding has left no place. */
static bool is_beyond_coordinates(const struct tri_mesh *mesh, const struct tri_subsegment *s, int side)
{
    struct tri_disk_split split;
    return !tri_is_resolved_from(mesh, s, tri_apex(mesh, s->side[side])) ||
           tri_is_encroached_from(mesh, s, s->side[side], &split);
}

/* Slanted lines across a square, each drawn two or three times at distances from 10^-14 to 10^-11, and lines that cross
 * them. */
static struct tri_pslg doubled_hatching(uint64_t seed)
{
    enum { LINES = 8 };
    struct support_random random = {seed};
    struct tri_pslg pslg = support_pslg(4 + 12 * LINES, 4 + 6 * LINES, 0, 0);
    const double slope = support_unit(&random), gap = ldexp(1, -37 - support_below(&random, 10));
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k == 1 || k == 2 ? 1 : -1, k >= 2 ? 1 : -1);
    for (int k = 0; k < 4; k++)
        support_add_segment(&pslg, k, (k + 1) % 4);
    for (int i = 0; i < 2 * LINES; i++) {
        const int times = 1 + support_below(&random, 3);
        for (int k = 0; k < times; k++) {
            double off = -0.9 + 1.8 * (i / 2) / LINES + (k > 0 ? gap * (2 * support_unit(&random) - 1) : 0);
            double from = -1.2 * support_unit(&random), to = 1.2 * support_unit(&random), s = slope;
            int32_t a = i % 2 ? support_add_point(&pslg, from - off * s, from * s + off)
                              : support_add_point(&pslg, off + from * s, off * s - from);
            int32_t b = i % 2 ? support_add_point(&pslg, to - off * s, to * s + off)
                              : support_add_point(&pslg, off + to * s, off * s - to);
            support_add_segment(&pslg, a, b);
        }
    }
    return pslg;
}

/* Adds the remaining circles to total, by reason. The result does not depend on which side of a subsegment is called
 * left. */
static void count_by_place(const struct tri_pslg *pslg, int64_t total[TRI_EXCUSES])
{
    int64_t count[TRI_EXCUSES], turned[TRI_EXCUSES], beyond = 0;
    struct tri_report report;
    struct tri_mesh mesh = conforming(pslg, 20, &report);
    struct tri_quality options = {.conforming = true};
    tri_count_encroached(&mesh, &options, &report.quality, count);
    for (tri_sub_id i = 0; i < mesh.n_subs; i++) {
        struct tri_subsegment *s = &mesh.sub[i];
        int n = 0, n_beyond = 0;
        for (int side = 0; side < 2; side++)
            if (s->side[side] != TRI_NONE && tri_is_in_diametral_disk(&mesh, s, s->side[side])) {
                n++;
                n_beyond += is_beyond_coordinates(&mesh, s, side);
            }
        beyond += n > 0 && n == n_beyond;
        *s = (struct tri_subsegment){{s->v[1], s->v[0]}, {s->side[1], s->side[0]}, s->marker, s->parent};
    }
    tri_count_encroached(&mesh, &options, &report.quality, turned);
    assert_memory_equal(turned, count, sizeof count);
    assert_int_equal(count[TRI_EXCUSE_PRECISION], beyond);
    for (int k = 0; k < TRI_EXCUSES; k++)
        total[k] += count[k];
    tri_mesh_free(&mesh);
}

/* In bundles of lines and between lines drawn twice, remaining circles are at small angles and between segments if they
 * would need too many parts. Those elsewhere are not resolved by the coordinates. */
static void test_circles_with_too_many_parts_are_counted_by_place(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    int64_t total[TRI_EXCUSES] = {0};
    assert_true(support_read("regress/bundle_levels.poly", &pslg));
    count_by_place(&pslg, total);
    tri_pslg_free(&pslg);
    for (uint64_t seed = 0; seed < 6; seed++) {
        pslg = doubled_hatching(seed);
        count_by_place(&pslg, total);
        tri_pslg_free(&pslg);
    }
    assert_true(total[TRI_EXCUSE_PRECISION] > 0);
    assert_true(total[TRI_EXCUSE_INPUT_ANGLE] > 0 && total[TRI_EXCUSE_NARROW_GAP] > 0);
}

/* Segments a few units in the last place apart: the reason for circles that are not empty is the coordinates, not the
 * cost of filling the space. */
static void test_unresolved_circles_are_counted_as_such(void **state)
{
    (void)state;
    int64_t count[TRI_EXCUSES];
    struct tri_pslg pslg;
    struct tri_report report;
    assert_true(support_read("regress/ulps_apart.poly", &pslg));
    struct tri_mesh mesh = conforming(&pslg, 0, &report);
    struct tri_quality options = {.conforming = true};
    tri_count_encroached(&mesh, &options, &report.quality, count);
    assert_true(count[TRI_EXCUSE_PRECISION] > 0);
    assert_int_equal(count[TRI_EXCUSE_PRECISION], circles_left(&mesh, &report));
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Asserts that circles multiply the number of triangles at most by `most`. Refinement stops if it does not end. */
static void judge_growth(const struct tri_pslg *pslg, double angle, int64_t most)
{
    struct tri_report report;
    struct tri_options options = support_quality(angle, 0);
    struct tri_mesh plain = support_generate(pslg, &options, NULL);
    options.quality.conforming = true;
    options.quality.max_steiner = most * plain.n_triangles;
    struct tri_mesh mesh = support_generate(pslg, &options, &report);
    assert_false(report.quality.hit_limit);
    assert_in_range(mesh.n_triangles, 0, most * plain.n_triangles);
    tri_mesh_free(&mesh);
    tri_mesh_free(&plain);
}

/* Spaces between lines drawn twice are not filled, and their circles do not need 10^12 pieces. */
static void test_circles_across_doubled_lines_end(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("regress/doubled_lines.poly", &pslg));
    judge_growth(&pslg, 0, 4);
    judge_growth(&pslg, 20, 4);
    tri_pslg_free(&pslg);
    for (uint64_t seed = 0; seed < 52; seed++) {
        pslg = doubled_hatching(seed);
        judge_growth(&pslg, 0, 4);
        judge_growth(&pslg, 20, 4);
        tri_pslg_free(&pslg);
    }
}

/* Above 36 degrees, refinement for circles may not end, so the mesh equals that for 36 degrees. */
static void test_a_larger_bound_is_treated_as_36(void **state)
{
    (void)state;
    struct tri_pslg pslg;
    assert_true(support_read("letter.poly", &pslg));
    struct tri_mesh usual = conforming(&pslg, 36, NULL), above = conforming(&pslg, 38, NULL);
    support_assert_same_bytes(&usual, &above);
    tri_mesh_free(&above);
    tri_mesh_free(&usual);
    tri_pslg_free(&pslg);
}

/* A vertex on the circle is not inside it. */
static void test_a_vertex_on_the_circle_is_not_inside(void **state)
{
    (void)state;
    static const struct {
        double y;
        bool inside;
    } cases[] = {{0.99, true}, {1, false}, {1.01, false}, {0.01, true}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct tri_point xy[] = {{-1, 0}, {1, 0}, {0, cases[i].y}};
        struct tri_triangle t = {.v = {0, 1, 2}};
        struct tri_mesh mesh = {.xy = xy, .tri = &t, .n_vertices = 3, .n_triangles = 1};
        struct tri_subsegment sub = {.v = {0, 1}, .side = {tri_code(0, 2), TRI_NONE}};
        assert_int_equal(tri_is_in_diametral_disk(&mesh, &sub, tri_code(0, 2)), cases[i].inside);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_a_vertex_on_the_circle_is_not_inside),
        cmocka_unit_test(test_needles_become_conforming),
        cmocka_unit_test(test_bundles_become_conforming),
        cmocka_unit_test(test_levels_are_level_in_spite_of_rounding),
        cmocka_unit_test(test_finer_coordinates_resolve_more),
        cmocka_unit_test(test_boundaries_come_back_to_their_lines),
        cmocka_unit_test(test_no_splittable_subsegment_stays_encroached),
        cmocka_unit_test(test_protected_circles_are_counted),
        cmocka_unit_test(test_circles_with_too_many_parts_are_counted_by_place),
        cmocka_unit_test(test_unresolved_circles_are_counted_as_such),
        cmocka_unit_test(test_circles_across_doubled_lines_end),
        cmocka_unit_test(test_a_larger_bound_is_treated_as_36),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
