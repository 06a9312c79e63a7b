/* The feature sizes of vertices, which make refinement end. tests/corpus/ lists the resulting numbers of triangles. */
#include "support.h"

#include "triangle/mesh/parents.h"
#include "triangle/size/feature_size.h"

static double distance(struct tri_point a, struct tri_point b) { return hypot(b.x - a.x, b.y - a.y); }

static void test_features_of_an_input(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(8, 0, 1);
    support_add_point(&pslg, 4, 1);
    struct tri_options options = {.use_segments = true};
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    static const double want[] = {4, 4, 8, 8, 1}; /* the last one: its height above the lower side */
    for (int v = 0; v < 5; v++)
        assert_true(v < 2 ? mesh.feature[v] > 4 && mesh.feature[v] < 4.2 : mesh.feature[v] == want[v]);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* A vertex less than an ulp from the hull, and two vertices an ulp apart. */
static void test_unresolved_distances_are_no_features(void **state)
{
    (void)state;
    static const double at[][2] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}, {4, 0x1p-52}, {4, 3}, {4, 3 + 0x1p-51}};
    struct tri_pslg pslg = support_pslg(7, 0, 0, 0);
    for (int i = 0; i < 7; i++)
        support_add_point(&pslg, at[i][0], at[i][1]);
    struct tri_options options = {.use_segments = true, .keep_hull = true};
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    for (int v = 0; v < 7; v++)
        assert_true(mesh.feature[v] >= 3 && mesh.feature[v] <= 8);
    for (tri_parent_id p = 0; p < mesh.n_parents; p++) {
        const tri_vertex_id *end = mesh.parents[p].v;
        assert_true(tri_touches(&mesh, p, end[0]) && tri_touches(&mesh, p, end[1]) && !tri_touches(&mesh, p, 5));
        assert_true(tri_touches(&mesh, p, 4) == (mesh.xy[end[0]].y + mesh.xy[end[1]].y == 0));
    }
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

static void test_sizes_are_inherited_and_grow(void **state)
{
    (void)state;
    struct tri_point xy[] = {{0, 0}, {6, 0}};
    double feature[] = {2, 1};
    struct tri_mesh mesh = {.xy = xy, .feature = feature, .n_vertices = 2};
    assert_true(tri_feature_inside(&mesh, 0, 1, (struct tri_point){3, 4}, false) == 1 + 0.5 * 5);
    assert_true(tri_feature_inside(&mesh, 0, 1, (struct tri_point){3, 4}, true) == 3.5);
    assert_true(tri_feature_inside(&mesh, 0, 1, (struct tri_point){0.5, 0}, true) == 0.5);
    assert_true(tri_has_run_away(&mesh, 0, 1, 0.166 * 0.166));
    assert_false(tri_has_run_away(&mesh, 0, 1, 0.167 * 0.167));
}

/* Asserts that no inner vertex has a smaller size than F of the theorem with all vertices on segments as sources, and
 * that each edge has at least a certain share of the sizes at its ends. */
static void check_sizes(const struct tri_mesh *mesh)
{
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        double least = HUGE_VAL;
        for (int32_t w = 0; w < mesh->n_vertices; w++)
            if (mesh->on[w] != TRI_VERTEX_FREE)
                least = fmin(least, mesh->feature[w] + 0.5 * distance(mesh->xy[v], mesh->xy[w]));
        assert_true(mesh->feature[v] >= 0.999 * least);
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++) {
            int32_t a = mesh->tri[t].v[k], b = mesh->tri[t].v[tri_next[k]];
            double size = fmin(mesh->feature[a], mesh->feature[b]);
            assert_true(distance(mesh->xy[a], mesh->xy[b]) > size / (4 * 32));
        }
}

static void test_sizes_match_the_theorem(void **state)
{
    (void)state;
    static const double angles[] = {20, 33, 34, 36, 45, 60};
    for (int i = 0; i < 6; i++)
        for (uint64_t seed = 1; seed <= 5; seed++) {
            struct tri_pslg pslg = support_square(1, 40, seed);
            struct tri_options options = support_quality(angles[i], 0);
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            check_sizes(&mesh);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_features_of_an_input),
        cmocka_unit_test(test_unresolved_distances_are_no_features),
        cmocka_unit_test(test_sizes_are_inherited_and_grow),
        cmocka_unit_test(test_sizes_match_the_theorem),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
