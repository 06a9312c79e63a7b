/* Size bounds at places where the usual point cannot be used: beside slivers, at protected segments, at small
 * angles. */
#include "support.h"

#include "triangle/refine/place.h"

static struct tri_pslg load(const char *name)
{
    struct tri_pslg pslg;
    if (!support_read(name, &pslg))
        fail_msg("cannot read %s", name);
    return pslg;
}

static void test_areas_are_kept_beside_slivers(void **state)
{
    (void)state;
    static const char *const names[] = {"regress/ulps_apart.poly", "nasty/dense_parallel.poly"};
    static const double angles[] = {0, 20, 33};
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 9; k++) {
            struct tri_pslg pslg = load(names[i]);
            struct tri_options options = support_quality(angles[k % 3], i ? 1e-4 : 2e-4);
            options.quality.protect = k / 3;
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            struct tri_check_options check = {.max_area = options.quality.max_area, .max_bad = mesh.n_triangles};
            support_judge(&mesh, &pslg, &check, false, NULL);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

/* Rejects large triangles near the origin. */
static int is_too_wide(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    double x = (a[0] + b[0] + c[0]) / 3, y = (a[1] + b[1] + c[1]) / 3;
    ++*(int *)user;
    return area > 1e-6 + 1e-3 * (x * x + y * y);
}

/* Between needles all angles are small. The size test must be called there as well. */
static void test_a_size_test_is_kept_at_small_angles(void **state)
{
    (void)state;
    for (int angle = 0; angle <= 30; angle += 15) {
        int asked = 0;
        struct tri_pslg pslg = load("regress/needles.poly");
        struct tri_options options = support_quality(angle, 0);
        options.quality.unsuitable = is_too_wide;
        options.quality.unsuitable_user = &asked;
        struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
        assert_true(asked > 0);
        for (int32_t t = 0; t < mesh.n_triangles; t++) {
            double at[3][2];
            for (int k = 0; k < 3; k++)
                tri_mesh_place(&mesh, mesh.tri[t].v[k], at[k]);
            double area = 0.5 * mesh.unit * mesh.unit * tri_shape_of(mesh.xy, mesh.tri[t].v).area2;
            assert_false(is_too_wide(&asked, at[0], at[1], at[2], area));
        }
        struct tri_check_options check = {.max_bad = mesh.n_triangles};
        support_judge(&mesh, &pslg, &check, false, NULL);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* Rejects edges above this length, even if they are protected. */
static int is_too_long(void *user, const double a[2], const double b[2], const double c[2], double area)
{
    const double *p[] = {a, b, c, a}, most = *(const double *)user;
    (void)area;
    for (int k = 0; k < 3; k++)
        if (hypot(p[k + 1][0] - p[k][0], p[k + 1][1] - p[k][1]) > most)
            return 1;
    return 0;
}

/* A triangle rejected only because of a protected long side must not get centroids down to the resolution (16,755
 * triangles). Rejected triangles cover almost no area. */
static void test_protected_walls_get_few_centroids(void **state)
{
    (void)state;
    struct tri_pslg pslg = load("letter.poly");
    double most = 0.5, all = 0, refused = 0;
    struct tri_options options = support_quality(20, 0);
    options.quality.protect = 1;
    options.quality.unsuitable = is_too_long;
    options.quality.unsuitable_user = &most;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    for (int32_t t = 0; t < mesh.n_triangles; t++) {
        double at[3][2];
        for (int k = 0; k < 3; k++)
            tri_mesh_place(&mesh, mesh.tri[t].v[k], at[k]);
        double area = tri_shape_of(mesh.xy, mesh.tri[t].v).area2;
        all += area;
        refused += is_too_long(&most, at[0], at[1], at[2], area) ? area : 0;
    }
    assert_true(mesh.n_triangles < 8000);
    assert_true(refused > 0 && refused < 0.002 * all);
    struct tri_check_options check = {.max_bad = mesh.n_triangles};
    support_judge(&mesh, &pslg, &check, false, NULL);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* The theorem: the distance of a centroid from any edge is at least a third of the smallest height, even in a flat
 * triangle. */
static void test_centroids_are_inside(void **state)
{
    (void)state;
    struct support_random random = {7};
    for (int i = 0; i < 2000; i++) {
        double flat = ldexp(1, -(int)support_below(&random, 60));
        struct tri_point xy[] = {{support_unit(&random), 0},
                                 {2 + support_unit(&random), flat * support_unit(&random)},
                                 {support_unit(&random), flat * (1 + support_unit(&random))}};
        struct tri_triangle t = {.v = {0, 1, 2}};
        struct tri_mesh mesh = {.xy = xy, .tri = &t, .n_vertices = 3, .n_triangles = 1, .limits.finest2 = 0x1p-88};
        struct tri_shape shape = tri_shape_of(xy, t.v);
        struct tri_point p;
        if (shape.area2 <= 0)
            continue;
        double longest = sqrt(fmax(shape.l[0], fmax(shape.l[1], shape.l[2])));
        bool resolved = shape.area2 / longest > 3.1 * 0x1p-44;
        assert_true(!resolved || tri_centroid(&mesh, 0, &shape, &p));
        for (int e = 0; resolved && e < 3; e++) {
            struct tri_point a = xy[tri_next[e]], b = xy[tri_prev[e]];
            double distance = tri_orient2d(a, b, p) / sqrt(shape.l[e]);
            assert_true(distance > shape.area2 / longest * 0.33);
        }
    }
}

/* Selects only subsegments among the two longer edges, and only unprotected ones. */
static void test_long_walls(void **state)
{
    (void)state;
    struct tri_point xy[] = {{0, 0}, {4, 0}, {0.5, 1}};
    struct tri_subsegment sub[] = {{.v = {0, 1}, .side = {2, TRI_NONE}}, {.v = {2, 0}, .side = {1, 5}}};
    struct tri_triangle t = {.v = {0, 1, 2}, .n = {4, 8, 12}};
    struct tri_mesh mesh = {.xy = xy, .tri = &t, .sub = sub, .n_vertices = 3, .n_triangles = 1, .n_subs = 2};
    struct tri_quality options = tri_quality_defaults();
    struct tri_shape shape = tri_shape_of(xy, t.v);
    assert_int_equal(tri_long_wall(&mesh, &options, 0, &shape), TRI_NONE);
    t.n[1] = ~1; /* on the short edge */
    assert_int_equal(tri_long_wall(&mesh, &options, 0, &shape), TRI_NONE);
    t.n[2] = ~0;
    assert_int_equal(tri_long_wall(&mesh, &options, 0, &shape), 0);
    options.protect = 1;
    assert_int_equal(tri_long_wall(&mesh, &options, 0, &shape), TRI_NONE);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_areas_are_kept_beside_slivers),
        cmocka_unit_test(test_a_size_test_is_kept_at_small_angles),
        cmocka_unit_test(test_protected_walls_get_few_centroids),
        cmocka_unit_test(test_centroids_are_inside),
        cmocka_unit_test(test_long_walls),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
