/* Counts over a whole mesh, compared with naive counts. */
#include "tests/support.h"
#include "triangle/size/quality.h"
#include "triangle/base/grow.h"

static struct tri_mesh refined_letter(const struct tri_options *options, struct tri_report *report)
{
    struct tri_pslg pslg;
    assert_true(support_read("letter.poly", &pslg));
    struct tri_mesh mesh = support_generate(&pslg, options, report);
    tri_pslg_free(&pslg);
    return mesh;
}

/* A search among every third triangle, in reverse order and in place, finds those bad triangles of the mesh that are
 * among them. */
static void assert_finds_among(const struct tri_mesh *mesh)
{
    const struct tri_options some = support_quality(20, 0);
    int32_t all[1000], list[1000], wanted[1000], n = 0, n_wanted = 0;
    const int32_t n_all = tri_find_work(mesh, &some.quality, 0, mesh->n_triangles, all);
    for (int32_t t = mesh->n_triangles - 1; t >= 0; t -= 3)
        list[n++] = t;
    for (int32_t i = n_all; i-- > 0;)
        if ((mesh->n_triangles - 1 - all[i]) % 3 == 0)
            wanted[n_wanted++] = all[i];
    assert_true(n_wanted > 0 && n_wanted < n);
    assert_int_equal(tri_find_work_among(mesh, &some.quality, list, n, list), n_wanted);
    assert_memory_equal(list, wanted, (size_t)n_wanted * sizeof *wanted);
}

/* Bad triangles are found independently of each other: any division into ranges finds the same, as the criterion
 * defines them. */
static void test_bad_triangles_are_found(void **state)
{
    (void)state;
    struct tri_options none = tri_defaults(), asked = support_quality(30, 0.01);
    struct tri_report report;
    none.use_segments = true;
    struct tri_mesh mesh = refined_letter(&none, &report);
    int32_t whole[1000], pieces[1000], n = 0, naive = 0;
    assert_true(mesh.n_triangles <= 1000);
    int32_t found = tri_find_work(&mesh, &asked.quality, 0, mesh.n_triangles, whole);
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        n += tri_find_work(&mesh, &asked.quality, t, t + 1, pieces + n);
    assert_int_equal(found, n);
    assert_memory_equal(whole, pieces, (size_t)n * sizeof *whole);
    struct tri_criterion c = tri_criterion_for(&mesh, &asked.quality);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        struct tri_shape shape = tri_shape_of(mesh.xy, mesh.tri[t].v);
        naive += tri_judge(&c, &mesh.tri[t], &shape) != TRI_GOOD;
    }
    assert_int_equal(found, naive);
    assert_true(found > 0);
    assert_finds_among(&mesh);
    tri_mesh_free(&mesh);
}

/* A mesh that satisfies its bounds has count 0. With stricter bounds, each bad triangle is counted once. */
static void test_count_bad(void **state)
{
    (void)state;
    struct tri_options options = support_quality(25, 0.02);
    struct tri_report report;
    struct tri_mesh mesh = refined_letter(&options, &report);
    int64_t count[TRI_EXCUSES], backwards[TRI_EXCUSES], sum = 0;
    tri_count_bad(&mesh, &options.quality, &report.quality, NULL, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        assert_int_equal(count[k], 0);
    options.quality.max_area = 0.005;
    int32_t *found = malloc((size_t)mesh.n_triangles * sizeof *found);
    assert_non_null(found);
    int32_t n = tri_find_work(&mesh, &options.quality, 0, mesh.n_triangles, found);
    tri_count_bad(&mesh, &options.quality, &report.quality, NULL, count);
    tri_count_bad(&mesh, &options.quality, &report.quality, &support_backwards, backwards);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    assert_true(n > 0);
    assert_int_equal(sum, n);
    assert_memory_equal(count, backwards, sizeof count);
    free(found);
    tri_mesh_free(&mesh);
}

/* The reasons are those in the report of the run. */
static void test_reasons_match_the_report(void **state)
{
    (void)state;
    struct tri_options options = support_quality(30, 0.005);
    struct tri_report report;
    int64_t count[TRI_EXCUSES];
    options.quality.max_steiner = 5;
    struct tri_mesh mesh = refined_letter(&options, &report);
    assert_true(report.quality.hit_limit);
    tri_count_bad(&mesh, &options.quality, &report.quality, NULL, count);
    assert_true(count[TRI_EXCUSE_LIMIT] > 0);
    tri_mesh_free(&mesh);
    options = support_quality(30, 0);
    options.quality.protect = 2;
    mesh = refined_letter(&options, &report);
    tri_count_bad(&mesh, &options.quality, &report.quality, NULL, count);
    assert_true(count[TRI_EXCUSE_PROTECTED] > 0);
    assert_int_equal(count[TRI_EXCUSE_DEFERRED], 0);
    tri_mesh_free(&mesh);
}

static int64_t encroached(const struct tri_mesh *mesh, const struct tri_options *options,
                          const struct tri_report *report)
{
    int64_t count[TRI_EXCUSES], n = 0;
    tri_count_encroached(mesh, &options->quality, &report->quality, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        n += count[k];
    return n;
}

/* A bad triangle without a reason of its own gets the most likely reason from the report of the run. */
static void test_settle_counts(void **state)
{
    (void)state;
    const int64_t found[TRI_EXCUSES + 1] = {1, 2, 3, 4, 5, 6, 70};
    const struct {
        struct tri_refine_report report;
        enum tri_excuse gets;
    } cases[] = {
        {{0}, TRI_EXCUSE_PRECISION},
        {{.given_up = {[TRI_EXCUSE_PROTECTED] = 8, [TRI_EXCUSE_PRECISION] = 8}}, TRI_EXCUSE_PRECISION},
        {{.given_up = {[TRI_EXCUSE_PROTECTED] = 9, [TRI_EXCUSE_PRECISION] = 8}}, TRI_EXCUSE_PROTECTED},
        {{.gated = 1, .given_up = {[TRI_EXCUSE_PROTECTED] = 9}}, TRI_EXCUSE_DEFERRED},
        {{.fenced = 1}, TRI_EXCUSE_DEFERRED},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        int64_t count[TRI_EXCUSES];
        tri_settle_counts(&cases[i].report, found, count);
        for (int k = 0; k < TRI_EXCUSES; k++)
            assert_int_equal(count[k], found[k] + (k == (int)cases[i].gets ? found[TRI_EXCUSES] : 0));
    }
}

static void test_encroached(void **state)
{
    (void)state;
    struct tri_options options = tri_defaults();
    struct tri_report report;
    options.use_segments = true;
    struct tri_mesh mesh = refined_letter(&options, &report);
    assert_true(encroached(&mesh, &options, &report) > 0);
    tri_mesh_free(&mesh);
    options = support_quality(20, 0);
    options.quality.conforming = true;
    mesh = refined_letter(&options, &report);
    assert_int_equal(encroached(&mesh, &options, &report), 0);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bad_triangles_are_found), cmocka_unit_test(test_count_bad),
        cmocka_unit_test(test_reasons_match_the_report), cmocka_unit_test(test_encroached),
        cmocka_unit_test(test_settle_counts),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
