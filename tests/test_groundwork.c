/* Facts about the input that refinement computes first (parents at each vertex, acute vertices), compared with naive
 * lists. */
#include "support.h"
#include "triangle/mesh/parents.h"

static void test_turns_before_is_the_order_of_angles(void **state)
{
    (void)state;
    const struct tri_point o = {3, -1};
    struct tri_point ring[100];
    double angle[100];
    int n = 0;
    for (int y = -3; y <= 3; y++)
        for (int x = -3; x <= 3; x++)
            if (x != 0 || y != 0) {
                ring[n] = (struct tri_point){o.x + x, o.y + y};
                angle[n] = atan2(y, x) + (y < 0 ? 6.283185307179586 : 0);
                n++;
            }
    for (int i = 0; i < n; i++)
        for (int k = 0; k < n; k++)
            assert_int_equal(tri_turns_before(o, ring[i], ring[k]), angle[i] < angle[k] - 1e-9);
}

/* A wheel: `spokes` segments from vertex 0 in the middle to a ring. */
static struct tri_mesh wheel(int32_t spokes)
{
    struct tri_pslg pslg = support_pslg(spokes + 1, 2 * spokes, 0, 0);
    support_add_point(&pslg, 0, 0);
    for (int32_t i = 0; i < spokes; i++)
        support_add_point(&pslg, cos(6.283185307179586 * i / spokes), sin(6.283185307179586 * i / spokes));
    for (int32_t i = 0; i < spokes; i++) {
        support_add_segment(&pslg, 0, spokes - i);
        support_add_segment(&pslg, 1 + i, 1 + (i + 1) % spokes);
    }
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    tri_pslg_free(&pslg);
    return mesh;
}

/* Asserts that each parent is listed once at each of its ends and nowhere else, and that the parents of a hub are
 * sorted by direction. */
static void assert_incidence(const struct tri_mesh *mesh)
{
    const struct tri_incidence *at = &mesh->incidence;
    int32_t ends = 0;
    assert_int_equal(at->n_vertices, mesh->n_vertices);
    for (int32_t v = 0; v < at->n_vertices; v++) {
        int32_t first = at->start[v], n = at->start[v + 1] - first, naive = 0;
        for (int32_t p = 0; p < mesh->n_parents; p++)
            naive += mesh->parents[p].v[0] == v || mesh->parents[p].v[1] == v;
        assert_int_equal(n, naive);
        for (int32_t i = first; i < first + n; i++) {
            const int32_t *end = mesh->parents[at->parent[i]].v;
            assert_true(end[0] == v || end[1] == v);
            const int32_t *before = i > first ? mesh->parents[at->parent[i - 1]].v : end;
            if (n > 16 && i > first)
                assert_true(tri_turns_before(mesh->xy[v], mesh->xy[before[before[0] == v]],
                                             mesh->xy[end[end[0] == v]]));
        }
        ends += n;
    }
    assert_int_equal(ends, 2 * mesh->n_parents);
}

static void test_parents_at_each_vertex(void **state)
{
    (void)state;
    static const int32_t spokes[] = {3, 16, 17, 60, 2500}; /* the last one is sorted by merging */
    for (int k = 0; k < 5; k++) {
        struct tri_mesh mesh = wheel(spokes[k]);
        assert_int_equal(mesh.n_parents, 2 * spokes[k]);
        assert_incidence(&mesh);
        tri_mesh_free(&mesh);
    }
}

/* Spokes meet at less than 60 degrees if there are more than six. Corners of the ring have large angles. */
static void test_acute_vertices(void **state)
{
    (void)state;
    for (int32_t spokes = 3; spokes <= 12; spokes++) {
        if (spokes == 6)
            continue; /* 60 degrees within rounding */
        struct tri_mesh mesh = wheel(spokes);
        assert_int_equal(mesh.on[0], spokes > 6 ? TRI_VERTEX_ACUTE : TRI_VERTEX_INPUT);
        for (int32_t v = 1; v <= spokes; v++) /* the angle between spoke and ring is 90 - 180 / spokes degrees */
            assert_int_equal(mesh.on[v], spokes < 6 ? TRI_VERTEX_ACUTE : TRI_VERTEX_INPUT);
        tri_mesh_free(&mesh);
    }
}

/* Returns the distance below which there are no features, in a square with `pairs` segments that each have a vertex at
 * a distance of 64 resolutions. */
static double rounding_beside(int pairs)
{
    struct tri_pslg pslg = support_pslg(4 + 3 * pairs, 4 + pairs, 0, 0);
    for (int k = 0; k < 4; k++)
        support_add_point(&pslg, k == 1 || k == 2, k / 2);
    for (int k = 0; k < 4; k++)
        support_add_segment(&pslg, k, (k + 1) % 4);
    for (int k = 0; k < pairs; k++) {
        const double y = (k + 1) / 16.0;
        const int32_t start = support_add_point(&pslg, 0.25, y), end = support_add_point(&pslg, 0.75, y);
        support_add_segment(&pslg, start, end);
        support_add_point(&pslg, 0.5, y + 0x1p-46);
    }
    struct tri_options options = support_quality(20, 0);
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
    assert_true(mesh.limits.finest2 == 0x1p-94);
    double rounding = sqrt(mesh.limits.shortest2);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
    return rounding;
}

/* 32 resolutions of the largest coordinate, or 256 if more than four vertices have a nearer neighbour than that. */
static void test_distances_below_rounding_are_no_features(void **state)
{
    (void)state;
    assert_true(rounding_beside(0) == 0x1p-47);
    assert_true(rounding_beside(4) == 0x1p-47);
    assert_true(rounding_beside(5) == 0x1p-44);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_turns_before_is_the_order_of_angles),
        cmocka_unit_test(test_parents_at_each_vertex),
        cmocka_unit_test(test_acute_vertices),
        cmocka_unit_test(test_distances_below_rounding_are_no_features),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
