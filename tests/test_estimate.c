/* Estimates compared with refinement, and with each other. */
#include "support.h"
#include "triangle/base/grow.h"
#include "triangle/size/estimate.h"
#include "triangle/size/crowd.h"

/* A square of side 1 with n points in it, before refinement. */
static struct tri_mesh coarse_square(int32_t n)
{
    struct tri_pslg pslg = support_square(1, n, 3);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

static int wants_smaller(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    const double *bound = user;
    (void)a, (void)b, (void)c;
    return area > *bound;
}

/* Estimates for area bounds are accurate within a few per cent. */
static void test_areas(void **state)
{
    (void)state;
    for (double area = 1e-2; area > 2e-5; area /= 4) {
        struct tri_mesh mesh = coarse_square(0);
        struct tri_quality quality = support_quality(20, area).quality;
        struct tri_refine_report report;
        double sure, estimate = tri_estimate(&mesh, &quality, NULL, &sure);
        assert_true(sure > mesh.n_triangles && sure <= estimate + mesh.n_triangles);
        assert_int_equal(tri_refine(&mesh, &quality, &report, NULL), TRI_OK);
        assert_true(estimate > 0.8 * mesh.n_triangles && estimate < 1.25 * mesh.n_triangles);
        tri_mesh_free(&mesh);
    }
}

static double sure_work(const struct tri_mesh *mesh, const struct tri_quality *quality)
{
    double sure;
    tri_estimate(mesh, quality, NULL, &sure);
    return sure;
}

/* The sure part of an estimate excludes what satisfied bounds might still require. */
static void test_satisfied_bounds_are_not_in_the_sure_part(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(30);
    struct tri_quality quality = support_quality(20, 0.5).quality;
    assert_true(sure_work(&mesh, &quality) == mesh.n_triangles);
    quality.max_area = 1e-4;
    assert_true(sure_work(&mesh, &quality) > 1e4);
    tri_mesh_free(&mesh);
}

/* A size test equivalent to an area bound gives about the same estimate. */
static void test_size_test_is_probed(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(8);
    struct tri_quality areas = support_quality(20, 1e-4).quality, probed = support_quality(20, 0).quality;
    double bound = 1e-4;
    probed.unsuitable = wants_smaller;
    probed.unsuitable_user = &bound;
    double one = sure_work(&mesh, &areas), other = sure_work(&mesh, &probed);
    assert_true(other > one / 4 && other < one * 4);
    bound = HUGE_VAL; /* requires nothing */
    assert_true(sure_work(&mesh, &probed) == mesh.n_triangles);
    bound = -1; /* rejects every triangle, so it is not a test of size */
    assert_true(sure_work(&mesh, &probed) == mesh.n_triangles);
    tri_mesh_free(&mesh);
}

/* Short at one place, in the middle of an input triangle. */
static double length_about(void *user, const double at[2])
{
    (void)user;
    return 0.004 + 0.1 * hypot(at[0] - 0.52, at[1] - 0.21);
}

static double size_about(const void *user, struct tri_point q)
{
    const double at[2] = {q.x, q.y};
    (void)user;
    return length_about(NULL, at);
}

/* The integral compared with a sum over a million small squares, half of which are in the triangle. */
static void test_integral(void **state)
{
    (void)state;
    enum { N = 1000 };
    const struct tri_point corner[3] = {{0, 0}, {1, 0}, {1, 1}};
    const struct tri_integrand field = {.at = size_about, .large = 1e-3, .few = 0.3, .deepest = 60},
                                over = {.at = size_about, .over = 1e3, .large = 1e-3, .few = 0.3, .deepest = 60};
    double sum = 0, sum_over = 0;
    for (int i = 0; i < N; i++)
        for (int k = 0; k < N; k++) {
            const struct tri_point q = {(i + 0.5) / N, (k + 0.5) / N};
            const double h = size_about(NULL, q), share = k < i ? 1 : k == i ? 0.5 : 0;
            sum += share / (h * h) / N / N;
            sum_over += share * fmax(1 / (h * h) - 1e3, 0) / N / N;
        }
    double found = tri_integral(&field, corner, NULL), found_over = tri_integral(&over, corner, NULL);
    print_message("  integral %.3f of the sum, over a bound %.3f\n", found / sum, found_over / sum_over);
    assert_true(fabs(found / sum - 1) < 0.1 && fabs(found_over / sum_over - 1) < 0.1);
}

/* A size function is integrated, in any unit. */
static void test_size_function(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(0);
    struct tri_quality quality = support_quality(20, 0).quality;
    struct tri_refine_report report;
    quality.edge_length = length_about;
    double estimate = support_estimate(&mesh, &quality);
    quality.area_scale = 9;
    double coarse = support_estimate(&mesh, &quality);
    quality.area_scale = 0;
    assert_int_equal(tri_refine(&mesh, &quality, &report, NULL), TRI_OK);
    print_message("  size function: estimate %.2f of what comes\n", estimate / mesh.n_triangles);
    assert_true(estimate > 0.8 * mesh.n_triangles && estimate < 1.25 * mesh.n_triangles);
    assert_true(fabs(9 * coarse / estimate - 1) < 0.1);
    tri_mesh_free(&mesh);
}

/* The shares of triangles add up to the estimate. A free triangle has share 0. */
static void test_shares(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(30);
    struct tri_quality quality = support_quality(25, 1e-3).quality;
    double sum = 0;
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        double work = tri_work_of(&mesh, &quality, t);
        assert_true(work >= 1);
        sum += work;
    }
    double all = support_estimate(&mesh, &quality);
    assert_true(sum >= all && sum < 1.3 * all); /* each triangle counts as bad here */
    int32_t v = mesh.tri[0].v[0];
    mesh.tri[0].v[0] = TRI_NONE;
    assert_true(tri_work_of(&mesh, &quality, 0) == 0);
    assert_true(support_estimate(&mesh, &quality) < all);
    mesh.tri[0].v[0] = v;
    tri_mesh_free(&mesh);
}

struct samples {
    double work, most; /* sum and maximum over the samples */
    int32_t n, room;   /* number of samples, and how many are accepted */
    bool inside;       /* all samples are in the unit square */
};

static bool record_sample(void *user, struct tri_point q, double work)
{
    struct samples *s = user;
    if (s->n == s->room)
        return false;
    s->n++;
    s->work += work;
    s->most = fmax(s->most, work);
    s->inside = s->inside && q.x > 0 && q.x < 1 && q.y > 0 && q.y < 1;
    return true;
}

/* The samples add up to the whole work, except for a rest that is too small for a sample. A smaller grain makes more
 * samples. Sampling ends when the callback rejects a sample. */
static void test_samples(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(30);
    struct tri_quality quality = support_quality(25, 1e-4).quality;
    double all = support_estimate(&mesh, &quality);
    int32_t before = 0;
    for (double grain = 2000; grain > 10; grain /= 5) {
        struct samples s = {.room = INT32_MAX, .inside = true};
        assert_true(tri_sample_work(&mesh, &quality, grain, NULL, record_sample, &s));
        assert_true(s.inside && s.n > before);
        assert_true(s.work <= all * (1 + 1e-9) && s.work > all - 2 * grain);
        assert_true(s.most < 2 * grain);
        before = s.n;
    }
    struct samples few = {.room = 3, .inside = true};
    assert_false(tri_sample_work(&mesh, &quality, 10, NULL, record_sample, &few));
    assert_int_equal(few.n, 3);
    tri_mesh_free(&mesh);
}

/* The result is the same to the last bit, regardless of which thread does which share. */
static void test_threads_do_not_change_estimates(void **state)
{
    (void)state;
    struct tri_mesh mesh = coarse_square(40000);
    struct tri_quality quality = support_quality(25, 1e-5).quality;
    double sure[2], all[2];
    struct samples s[2];
    assert_true(tri_shares(mesh.n_triangles) > 2);
    for (int k = 0; k < 2; k++) {
        const struct tri_executor *executor = k ? &support_backwards : NULL;
        s[k] = (struct samples){.room = INT32_MAX, .inside = true};
        all[k] = tri_estimate(&mesh, &quality, executor, &sure[k]);
        assert_true(tri_sample_work(&mesh, &quality, 10, executor, record_sample, &s[k]));
    }
    assert_true(all[0] == all[1] && sure[0] == sure[1]);
    assert_true(s[0].work == s[1].work && s[0].most == s[1].most && s[0].n == s[1].n);
    tri_mesh_free(&mesh);
}

/* Bounds that require more triangles than a mesh can hold are rejected before any work, unless new points are
 * limited. */
static void test_impossible_bounds_are_refused(void **state)
{
    (void)state;
    struct tri_options none = tri_defaults();
    struct tri_report report;
    struct tri_error error;
    struct tri_pslg square = support_square(1, 0, 1);
    struct tri_mesh mesh = support_generate(&square, &none, &report);
    struct tri_quality quality = tri_quality_defaults();
    quality.max_area = 1.01 / 0.75 / TRI_MAX_TRIANGLES; /* a mesh fills at most 0.75 of its area bound */
    assert_int_equal(tri_refine_check(&mesh, &quality, NULL, &error), TRI_OK);
    quality.max_area = 0.99 / 0.75 / TRI_MAX_TRIANGLES;
    assert_int_equal(tri_refine_check(&mesh, &quality, NULL, &error), TRI_TOO_LARGE);
    quality.max_steiner = 10;
    assert_int_equal(tri_refine_check(&mesh, &quality, NULL, &error), TRI_OK);
    tri_mesh_free(&mesh);
    tri_pslg_free(&square);
}

/* One of two triangles of area 1/2 satisfies its bound. */
static void test_satisfied_bounds_need_no_triangles(void **state)
{
    (void)state;
    struct tri_options none = tri_defaults();
    struct tri_report report;
    struct tri_pslg square = support_square(1, 0, 1);
    struct tri_mesh mesh = support_generate(&square, &none, &report);
    struct tri_quality quality = tri_quality_defaults();
    assert_int_equal(mesh.n_triangles, 2);
    quality.max_area = 0.5;
    assert_true(tri_size_demand(&mesh, &quality, NULL) == 0);
    quality.max_area = 0;
    quality.region_areas = true;
    assert_true(tri_resize(&mesh.regions, 3, sizeof *mesh.regions));
    mesh.n_regions = 3;
    mesh.regions[1] = (struct tri_region){.max_area = 0.6};
    mesh.regions[2] = (struct tri_region){.max_area = 0.005};
    for (int32_t t = 0; t < 2; t++)
        mesh.tri[t].region = t + 1;
    assert_true(fabs(tri_size_demand(&mesh, &quality, NULL) - 100 / 0.75) < 1e-9);
    tri_mesh_free(&mesh);
    tri_pslg_free(&square);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_areas),
        cmocka_unit_test(test_satisfied_bounds_are_not_in_the_sure_part),
        cmocka_unit_test(test_size_test_is_probed),
        cmocka_unit_test(test_integral),
        cmocka_unit_test(test_size_function),
        cmocka_unit_test(test_shares),
        cmocka_unit_test(test_samples),
        cmocka_unit_test(test_threads_do_not_change_estimates),
        cmocka_unit_test(test_impossible_bounds_are_refused),
        cmocka_unit_test(test_satisfied_bounds_need_no_triangles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
