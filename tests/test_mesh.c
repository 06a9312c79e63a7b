/* Storage of the mesh: growth keeps the content, compaction keeps the links, and validation detects each broken
   link. */
#include "support.h"

static struct tri_mesh two_triangles(void)
{
    struct tri_pslg pslg = support_square(1, 0, 1);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    assert_int_equal(mesh.n_triangles, 2);
    return mesh;
}

static void test_growth_keeps_content_and_alignment(void **state)
{
    (void)state;
    struct tri_mesh mesh;
    assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
    mesh.n_attributes = 2;
    for (int32_t i = 0; i < 5000; i++) {
        assert_int_equal(tri_mesh_reserve_vertices(&mesh, 1, NULL), TRI_OK);
        assert_int_equal(tri_mesh_reserve_triangles(&mesh, 1, NULL), TRI_OK);
        assert_int_equal(tri_mesh_reserve_subs(&mesh, 1, NULL), TRI_OK);
        assert_int_equal((uintptr_t)mesh.tri % 64, 0);
        mesh.xy[i] = (struct tri_point){i, -i};
        mesh.attributes[2 * i + 1] = 3 * i;
        mesh.on[i] = mesh.vertex_markers[i] = i;
        mesh.n_vertices++;
        mesh.tri[i] = (struct tri_triangle){{i, i + 1, i + 2}, {0, 0, 0}, 0, 0};
        mesh.n_triangles++;
        assert_int_equal(tri_mesh_add_sub(&mesh, i, i + 1, i + 2, i + 3), i);
    }
    for (int32_t i = 0; i < 5000; i++) {
        assert_true(mesh.xy[i].x == i && mesh.attributes[2 * i + 1] == 3 * i);
        assert_true(mesh.on[i] == i && mesh.vertex_markers[i] == i);
        assert_int_equal(mesh.tri[i].v[2], i + 2);
        assert_true(mesh.sub[i].v[1] == i + 1 && mesh.sub[i].marker == i + 2 && mesh.sub[i].parent == i);
        assert_true(mesh.parents[i].v[0] == i && mesh.parents[i].segment == i + 3);
    }
    tri_mesh_free(&mesh);
    assert_null(mesh.tri);
    tri_mesh_free(&mesh); /* an empty mesh may be freed */
}

static void test_too_many_vertices_or_triangles_are_refused(void **state)
{
    (void)state;
    struct tri_mesh mesh;
    struct tri_error error;
    assert_int_equal(tri_mesh_init(&mesh, &error), TRI_OK);
    mesh.n_vertices = 10;
    assert_int_equal(tri_mesh_reserve_vertices(&mesh, TRI_MAX_VERTICES, &error), TRI_TOO_LARGE);
    assert_int_equal(error.status, TRI_TOO_LARGE);
    mesh.n_vertices = 0;
    mesh.n_triangles = 10;
    assert_int_equal(tri_mesh_reserve_triangles(&mesh, TRI_MAX_TRIANGLES, NULL), TRI_TOO_LARGE);
    mesh.n_triangles = 0;
    tri_mesh_free(&mesh);
}

static void test_points_are_copied_with_their_data(void **state)
{
    (void)state;
    double points[8] = {0, 1, 2, 3, 4, 5, -6, 7}, attributes[4] = {9, 8, 7, 6};
    int32_t markers[4] = {4, 3, 2, 1};
    struct tri_pslg pslg = {
        .n_points = 4, .points = points, .n_attributes = 1, .attributes = attributes, .markers = markers};
    struct tri_mesh mesh;
    assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
    assert_int_equal(tri_mesh_take_points(&mesh, &pslg, NULL, NULL), TRI_OK);
    assert_true(mesh.n_vertices == 4 && mesh.n_input == 4 && mesh.unit == 1);
    assert_true(mesh.xy[3].x == -6 && mesh.attributes[2] == 7 && mesh.vertex_markers[0] == 4);
    assert_int_equal(mesh.on[2], TRI_VERTEX_INPUT);
    tri_mesh_free(&mesh);
}

/* A power of two scales all coordinates into the range that the exact predicates support. */
/* Without points the array may be NULL. */
static void test_no_points_with_attributes(void **state)
{
    (void)state;
    struct tri_pslg pslg = {.n_attributes = 2};
    struct tri_mesh mesh;
    assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
    assert_int_equal(tri_mesh_take_points(&mesh, &pslg, NULL, NULL), TRI_OK);
    assert_int_equal(mesh.n_vertices, 0);
    tri_mesh_free(&mesh);
}

static void test_units_bring_coordinates_into_range(void **state)
{
    (void)state;
    static const double sizes[] = {1, 1e-30, 1e-31, 1e-100, 1e-300, 4e-308, 1e59, 1e60, 1e150, 1e300, 1.7e308};
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++) {
        double points[6] = {sizes[i], 0, 0, sizes[i] / 4, -sizes[i] / 2, 0};
        struct tri_pslg pslg = {.n_points = 3, .points = points};
        struct tri_mesh mesh;
        int exponent;
        assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
        assert_int_equal(tri_mesh_take_points(&mesh, &pslg, NULL, NULL), TRI_OK);
        assert_true(frexp(mesh.unit, &exponent) == 0.5);
        for (int32_t v = 0; v < 3; v++) {
            double at[2];
            assert_true(tri_is_exact_coordinate(mesh.xy[v].x) && tri_is_exact_coordinate(mesh.xy[v].y));
            tri_mesh_place(&mesh, v, at);
            assert_true(at[0] == points[2 * v] && at[1] == points[2 * v + 1]);
        }
        tri_mesh_free(&mesh);
    }
}

static void test_compaction_keeps_a_valid_mesh(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 200, 3);
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    struct support_set before = support_triangles(&mesh);
    int32_t n = mesh.n_triangles;
    struct support_random random = {4};
    /* Spreads the triangles over twice as many entries, adjusts the links, then compacts the mesh again. */
    assert_int_equal(tri_mesh_reserve_triangles(&mesh, n, NULL), TRI_OK);
    mesh.n_triangles = 2 * n;
    for (int32_t t = n; t < 2 * n; t++)
        mesh.tri[t].v[0] = TRI_NONE;
    for (int32_t t = 0; t < n; t++) {
        int32_t to = n + t;
        if (support_below(&random, 2))
            continue;
        mesh.tri[to] = mesh.tri[t];
        mesh.tri[t].v[0] = TRI_NONE;
        for (int e = 0; e < 3; e++)
            tri_relink(&mesh, mesh.tri[to].n[e], mesh.tri[to].v[tri_next[e]], tri_code(to, e));
    }
    assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
    tri_mesh_compact(&mesh);
    assert_int_equal(mesh.n_triangles, n);
    assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
    struct support_set after = support_triangles(&mesh);
    assert_true(support_same(&before, &after));
    support_set_free(&before);
    support_set_free(&after);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_compaction_of_nothing(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles();
    mesh.tri[0].v[0] = mesh.tri[1].v[0] = TRI_NONE;
    tri_mesh_compact(&mesh);
    assert_int_equal(mesh.n_triangles, 0);
    tri_mesh_compact(&mesh);
    assert_int_equal(mesh.n_triangles, 0);
    tri_mesh_free(&mesh);
}

static void assert_broken(const struct tri_mesh *mesh)
{
    struct tri_error error = {0};
    assert_int_equal(tri_mesh_validate(mesh, &error), TRI_INTERNAL);
    assert_int_equal(error.status, TRI_INTERNAL);
    assert_true(error.text[0] != 0);
}

/* Replaces each link, side and corner in turn by every other value that a defect could leave there. */
static void test_each_broken_link_is_detected(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles();
    assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
    for (int32_t t = 0; t < 2; t++)
        for (int e = 0; e < 3; e++)
            for (int32_t wrong = -6; wrong < 14; wrong++) {
                int32_t right = mesh.tri[t].n[e];
                if (wrong == right)
                    continue;
                mesh.tri[t].n[e] = wrong;
                assert_broken(&mesh);
                mesh.tri[t].n[e] = right;
            }
    for (int32_t t = 0; t < 2; t++)
        for (int k = 0; k < 3; k++)
            for (int32_t wrong = k ? -1 : 0; wrong < 6; wrong++) { /* corner 0 below 0 marks a free triangle */
                int32_t right = mesh.tri[t].v[k];
                if (wrong == right)
                    continue;
                mesh.tri[t].v[k] = wrong;
                assert_broken(&mesh);
                mesh.tri[t].v[k] = right;
            }
    assert_int_equal(tri_mesh_validate(&mesh, NULL), TRI_OK);
    tri_mesh_free(&mesh);
}

static void test_each_broken_subsegment_is_detected(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles();
    for (int32_t s = 0; s < mesh.n_subs; s++)
        for (int k = 0; k < 2; k++) {
            struct tri_subsegment right = mesh.sub[s];
            for (int32_t wrong = -1; wrong < 14; wrong++) {
                mesh.sub[s].side[k] = wrong;
                if (wrong != right.side[k])
                    assert_broken(&mesh);
                mesh.sub[s] = right;
            }
            for (int32_t wrong = 0; wrong < 5; wrong++) {
                mesh.sub[s].v[k] = wrong;
                if (wrong != right.v[k])
                    assert_broken(&mesh);
                mesh.sub[s] = right;
            }
        }
    mesh.n_subs--;
    assert_broken(&mesh);
    tri_mesh_free(&mesh);
}

/* A triangle is freed while its neighbours still point to it. */
static void test_link_to_a_free_triangle_is_detected(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles();
    for (int k = 0; k < 3; k++)
        mesh.tri[1].v[k] = TRI_NONE;
    assert_broken(&mesh);
    tri_mesh_free(&mesh);
}

/* A copy of a triangle has the right corners behind each link, but its neighbours do not point to it. */
static void test_copy_of_a_triangle_is_detected(void **state)
{
    (void)state;
    struct tri_mesh mesh = two_triangles();
    assert_int_equal(tri_mesh_reserve_triangles(&mesh, 1, NULL), TRI_OK);
    mesh.tri[mesh.n_triangles] = mesh.tri[1];
    mesh.n_triangles++;
    assert_broken(&mesh);
    for (int e = 0; e < 3; e++) /* also if only the link to the other triangle is left */
        if (mesh.tri[2].n[e] < 0) {
            assert_int_equal(tri_mesh_reserve_subs(&mesh, 1, NULL), TRI_OK);
            int32_t from = mesh.tri[2].v[tri_next[e]], to = mesh.tri[2].v[tri_prev[e]];
            int32_t s = tri_mesh_add_sub(&mesh, from, to, 0, TRI_NONE);
            mesh.sub[s].side[0] = tri_code(2, e);
            mesh.tri[2].n[e] = ~s;
        }
    assert_broken(&mesh);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_growth_keeps_content_and_alignment),
        cmocka_unit_test(test_too_many_vertices_or_triangles_are_refused),
        cmocka_unit_test(test_points_are_copied_with_their_data),
        cmocka_unit_test(test_no_points_with_attributes),
        cmocka_unit_test(test_units_bring_coordinates_into_range),
        cmocka_unit_test(test_compaction_keeps_a_valid_mesh),
        cmocka_unit_test(test_compaction_of_nothing),
        cmocka_unit_test(test_each_broken_link_is_detected),
        cmocka_unit_test(test_each_broken_subsegment_is_detected),
        cmocka_unit_test(test_link_to_a_free_triangle_is_detected),
        cmocka_unit_test(test_copy_of_a_triangle_is_detected),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
