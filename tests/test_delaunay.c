/* The triangulation of a point set compared with a naive twin: all triangles whose circle contains no other point. */
#include "support.h"
#include "triangle/cdt/delaunay.h"

static struct tri_mesh triangulate(const struct tri_pslg *pslg) { return support_delaunay(pslg, 0, NULL); }

static bool is_first(const struct tri_point *xy, int32_t v)
{
    for (int32_t u = 0; u < v; u++)
        if (xy[u].x == xy[v].x && xy[u].y == xy[v].y)
            return false;
    return true;
}

static bool is_empty_circle(const struct tri_point *xy, const int32_t *id, int32_t n, int32_t a, int32_t b, int32_t c)
{
    for (int32_t i = 0; i < n; i++)
        if (id[i] != a && id[i] != b && id[i] != c && tri_in_circle(xy[a], xy[b], xy[c], xy[id[i]]))
            return false;
    return true;
}

/* O(n^4). Of equal points it uses the one with the lowest index. */
static struct support_set naive_delaunay(const struct tri_point *xy, int32_t n_points)
{
    struct support_set set = {0, calloc((size_t)n_points * 2 + 8, sizeof *set.v)};
    int32_t *id = calloc((size_t)n_points, sizeof *id), n = 0;
    for (int32_t v = 0; v < n_points; v++)
        if (is_first(xy, v))
            id[n++] = v;
    for (int32_t i = 0; i < n; i++)
        for (int32_t j = i + 1; j < n; j++)
            for (int32_t k = j + 1; k < n; k++) {
                double side = tri_orient2d(xy[id[i]], xy[id[j]], xy[id[k]]);
                int32_t a = id[i], b = side > 0 ? id[j] : id[k], c = side > 0 ? id[k] : id[j];
                if (side == 0 || !is_empty_circle(xy, id, n, a, b, c))
                    continue;
                assert_true(set.n < 2 * n_points + 8);
                set.v[set.n][0] = a, set.v[set.n][1] = b, set.v[set.n][2] = c;
                set.n++;
            }
    free(id);
    support_sort(&set);
    return set;
}

static void compare_leaves_with_twin(const struct tri_pslg *pslg, int32_t leaf_size)
{
    struct tri_mesh mesh = support_delaunay(pslg, leaf_size, NULL);
    struct support_set fast = support_triangles(&mesh), naive = naive_delaunay(mesh.xy, mesh.n_vertices);
    assert_int_equal(fast.n, naive.n);
    assert_true(support_same(&fast, &naive));
    support_set_free(&fast);
    support_set_free(&naive);
    tri_mesh_free(&mesh);
}

static void compare_with_twin(const struct tri_pslg *pslg)
{
    compare_leaves_with_twin(pslg, 0);
    compare_leaves_with_twin(pslg, 1);
}

static void test_equals_naive_twin(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (uint64_t seed = 0; seed < 60; seed++) {
            struct tri_pslg pslg = support_points((enum support_kind)kind, 3 + (int32_t)(seed % 25), seed);
            compare_with_twin(&pslg);
            tri_pslg_free(&pslg);
        }
}

static void test_grid_equals_naive_twin(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(49, 0, 0, 0);
    for (int i = 0; i < 49; i++)
        support_add_point(&pslg, i / 7 - 3, i % 7);
    compare_with_twin(&pslg);
    tri_pslg_free(&pslg);
}

/* The result depends only on the set of points, not on their order or numbers. */
static void test_is_unique_under_permutation(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++) {
        int32_t n = 1500;
        struct tri_pslg pslg = support_points((enum support_kind)kind, n, 7);
        struct support_random random = {(uint64_t)kind};
        struct tri_mesh mesh = triangulate(&pslg);
        struct support_places first = support_places(&mesh);
        tri_mesh_free(&mesh);
        for (int32_t i = n - 1; i > 0; i--) {
            int32_t k = support_below(&random, i + 1);
            for (int c = 0; c < 2; c++) {
                double swap = pslg.points[2 * i + c];
                pslg.points[2 * i + c] = pslg.points[2 * k + c];
                pslg.points[2 * k + c] = swap;
            }
        }
        mesh = triangulate(&pslg);
        struct support_places second = support_places(&mesh);
        assert_true(support_same_places(&first, &second));
        support_places_free(&first);
        support_places_free(&second);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_duplicates_have_the_lowest_twin(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_LATTICE, 300, 5);
    struct tri_mesh mesh = triangulate(&pslg);
    assert_non_null(mesh.twin);
    for (int32_t v = 0; v < 300; v++) {
        int32_t u = 0;
        while (mesh.xy[u].x != mesh.xy[v].x || mesh.xy[u].y != mesh.xy[v].y)
            u++;
        assert_int_equal(mesh.twin[v], u);
    }
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        for (int k = 0; k < 3; k++)
            assert_int_equal(mesh.twin[mesh.tri[t].v[k]], mesh.tri[t].v[k]);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_no_duplicates_no_twins(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_RANDOM, 50, 5);
    struct tri_mesh mesh = triangulate(&pslg);
    assert_null(mesh.twin);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* -0 and 0 are the same coordinate. */
static void test_signed_zeros_are_one_point(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(5, 0, 0, 0);
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 1, 0);
    support_add_point(&pslg, -0.0, 0);
    support_add_point(&pslg, 0, 1);
    support_add_point(&pslg, 0, -0.0);
    struct tri_mesh mesh = triangulate(&pslg);
    assert_int_equal(mesh.n_triangles, 1);
    assert_int_equal(mesh.twin[2], 0);
    assert_int_equal(mesh.twin[4], 0);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_collinear_points_give_nothing(void **state)
{
    (void)state;
    for (int32_t n = 3; n < 40; n++) {
        struct tri_pslg pslg = support_pslg(n, 0, 0, 0);
        for (int32_t i = 0; i < n; i++)
            support_add_point(&pslg, 3 * (i * 7 % n), 5 * (i * 7 % n));
        struct tri_mesh mesh = triangulate(&pslg);
        assert_int_equal(mesh.n_triangles, 0);
        assert_int_equal(mesh.n_subs, 0);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

/* All points but one are collinear. The other may be anywhere in the order. */
static void test_one_point_beside_a_line(void **state)
{
    (void)state;
    for (int32_t place = 0; place < 12; place++) {
        struct tri_pslg pslg = support_pslg(12, 0, 0, 0);
        for (int32_t i = 0; i < 12; i++)
            support_add_point(&pslg, i, i == place ? i + 0x1p-40 : i);
        compare_with_twin(&pslg);
        tri_pslg_free(&pslg);
    }
}

/* Blocks influence only the speed: leaves of all sizes and blocks in reverse order make the same mesh. */
static void test_leaf_size_does_not_matter(void **state)
{
    (void)state;
    static const int32_t sizes[] = {30, 300, 3000};
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (size_t s = 0; s < sizeof sizes / sizeof *sizes; s++) {
            struct tri_pslg pslg = support_points((enum support_kind)kind, sizes[s], 3);
            struct tri_mesh whole = support_delaunay(&pslg, sizes[s], NULL);
            for (int32_t leaf_size = 1; leaf_size <= sizes[s]; leaf_size *= 5) {
                struct tri_mesh mesh = support_delaunay(&pslg, leaf_size, &support_backwards);
                support_assert_same_bytes(&whole, &mesh);
                tri_mesh_free(&mesh);
            }
            tri_mesh_free(&whole);
            tri_pslg_free(&pslg);
        }
}

/* The hub of a fan is a corner of all triangles, so only one block has work, and the hull has no further triangles. */
static void test_fan_equals_naive_twin(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(40, 0, 0, 0);
    support_add_point(&pslg, 20, -1000);
    for (int i = 1; i < 40; i++)
        support_add_point(&pslg, i, i * (40 - i) / 16.0);
    compare_with_twin(&pslg);
    tri_pslg_free(&pslg);
}

/* Large sets, checked by counts (Euler's formula), the exact local Delaunay property, and a convex hull around all
 * points. */
static void test_large_sets_pass_the_judge(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++) {
        struct tri_pslg pslg = support_points((enum support_kind)kind, 20000, 11);
        struct tri_mesh mesh = triangulate(&pslg);
        struct tri_check_options options = {.max_bad = -1, .convex = !mesh.twin};
        support_assert_cdt(&mesh, false);
        tri_mark_vertices(&mesh);
        tri_mark_boundary(&mesh);
        support_judge(&mesh, &pslg, &options, false, NULL);
        for (int32_t s = 0; s < mesh.n_subs; s++)
            assert_true(mesh.sub[s].side[0] != TRI_NONE && mesh.sub[s].side[1] == TRI_NONE);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
}

static void test_all_point_files(void **state)
{
    (void)state;
    char **names = support_names("nasty");
    int tried = 0;
    for (char **name = names; *name; name++) {
        struct tri_pslg pslg;
        if (!strstr(*name, ".node") || !support_read(*name, &pslg))
            continue;
        struct tri_mesh mesh = triangulate(&pslg);
        struct tri_check_options options = {.max_bad = -1, .convex = mesh.n_triangles > 0 && !mesh.twin};
        support_assert_cdt(&mesh, false);
        tri_mark_vertices(&mesh);
        tri_mark_boundary(&mesh);
        support_judge(&mesh, &pslg, &options, false, NULL);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
        tried++;
    }
    assert_true(tried >= 6);
    support_free_names(names);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_equals_naive_twin),
        cmocka_unit_test(test_grid_equals_naive_twin),
        cmocka_unit_test(test_is_unique_under_permutation),
        cmocka_unit_test(test_duplicates_have_the_lowest_twin),
        cmocka_unit_test(test_no_duplicates_no_twins),
        cmocka_unit_test(test_signed_zeros_are_one_point),
        cmocka_unit_test(test_collinear_points_give_nothing),
        cmocka_unit_test(test_one_point_beside_a_line),
        cmocka_unit_test(test_leaf_size_does_not_matter),
        cmocka_unit_test(test_fan_equals_naive_twin),
        cmocka_unit_test(test_large_sets_pass_the_judge),
        cmocka_unit_test(test_all_point_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
