/* Subsegments on one straight line get one parent. Chains end at turns, forks and changes of the marker. */
#include "support.h"
#include "triangle/cdt/reconstruct.h"

/* Returns the mesh of the PSLG. Some of its subsegments run in one direction, some in the other. */
static struct tri_mesh mesh_of(struct tri_pslg *pslg)
{
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(pslg, &options, NULL);
    tri_pslg_free(pslg);
    assert_int_equal(mesh.n_parents, mesh.n_subs);
    for (int32_t s = 0; s < mesh.n_subs; s += 3) {
        const struct tri_subsegment was = mesh.sub[s];
        mesh.sub[s] = (struct tri_subsegment){{was.v[1], was.v[0]}, {was.side[1], was.side[0]}, was.marker, was.parent};
        mesh.parents[was.parent].v[0] = was.v[1];
        mesh.parents[was.parent].v[1] = was.v[0];
    }
    return mesh;
}

/* A polygon whose k-th side is cut into parts[k] pieces. Corners are small integers, so all points are exact. */
static struct tri_pslg polygon(int n, const double corner[][2], const int32_t *parts)
{
    struct tri_pslg pslg = support_pslg(200, 200, 0, 0);
    for (int k = 0; k < n; k++)
        for (int32_t i = 0; i < parts[k]; i++) {
            const double *a = corner[k], *b = corner[(k + 1) % n];
            support_add_point(&pslg, a[0] + (b[0] - a[0]) * i / parts[k], a[1] + (b[1] - a[1]) * i / parts[k]);
        }
    for (int32_t v = 0; v < pslg.n_points; v++)
        support_add_segment(&pslg, v, (v + 1) % pslg.n_points);
    return pslg;
}

/* Asserts that each parent is a chain of its subsegments in one direction, and that its inner vertices lie on it. */
static void assert_chains(const struct tri_mesh *mesh)
{
    int32_t inner = 0;
    assert_int_equal(tri_mesh_validate(mesh, NULL), TRI_OK);
    for (int32_t p = 0; p < mesh->n_parents; p++) {
        int32_t at = mesh->parents[p].v[0], n = 0;
        while (at != mesh->parents[p].v[1]) {
            int32_t next = TRI_NONE;
            for (int32_t s = 0; s < mesh->n_subs; s++)
                if (mesh->sub[s].parent == p && mesh->sub[s].v[0] == at)
                    next = mesh->sub[s].v[1];
            assert_true(next != TRI_NONE && n++ < mesh->n_subs);
            if (at != mesh->parents[p].v[0])
                assert_int_equal(mesh->on[at], p);
            at = next;
        }
        int32_t of = 0;
        for (int32_t s = 0; s < mesh->n_subs; s++)
            of += mesh->sub[s].parent == p;
        assert_int_equal(of, n);
        inner += n - 1;
    }
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        inner -= mesh->on[v] >= 0;
    assert_int_equal(inner, 0);
}

static const double square[4][2] = {{0, 0}, {8, 0}, {8, 8}, {0, 8}};

static void test_sides_of_a_square(void **state)
{
    (void)state;
    const int32_t parts[4] = {1, 8, 32, 2};
    struct tri_pslg pslg = polygon(4, square, parts);
    struct tri_mesh mesh = mesh_of(&pslg);
    assert_int_equal(mesh.n_parents, 43);
    assert_int_equal(tri_unite_chains(&mesh, NULL), TRI_OK);
    assert_int_equal(mesh.n_parents, 4);
    assert_chains(&mesh);
    tri_mesh_free(&mesh);
}

static void test_a_new_marker_ends_a_chain(void **state)
{
    (void)state;
    const int32_t parts[4] = {8, 1, 1, 1};
    struct tri_pslg pslg = polygon(4, square, parts);
    pslg.segment_markers = calloc((size_t)pslg.n_segments, sizeof *pslg.segment_markers);
    assert_non_null(pslg.segment_markers);
    for (int32_t s = 0; s < pslg.n_segments; s++)
        pslg.segment_markers[s] = s < 3 ? 5 : 6;
    struct tri_mesh mesh = mesh_of(&pslg);
    assert_int_equal(tri_unite_chains(&mesh, NULL), TRI_OK);
    assert_int_equal(mesh.n_parents, 5);
    assert_chains(&mesh);
    tri_mesh_free(&mesh);
}

/* A chain ends at a vertex with a third subsegment, even if it would continue straight. */
static void test_forks_end_a_chain(void **state)
{
    (void)state;
    const int32_t parts[4] = {8, 8, 1, 1};
    struct tri_pslg pslg = polygon(4, square, parts);
    support_add_segment(&pslg, 4, 12); /* from the middle of one side to the middle of the next */
    struct tri_mesh mesh = mesh_of(&pslg);
    assert_int_equal(tri_unite_chains(&mesh, NULL), TRI_OK);
    assert_int_equal(mesh.n_parents, 7);
    assert_chains(&mesh);
    tri_mesh_free(&mesh);
}

/* Every joint is straight within rounding error, but together they form a closed curve: each of two thousand joints
 * deviates by two units in the last place. Any three consecutive joints are within the tolerance. */
static void test_curves_stay_in_pieces(void **state)
{
    (void)state;
    enum { N = 64 };
    for (int bent = 0; bent < 2; bent++) {
        struct tri_pslg pslg = support_pslg(N + 2, N + 2, 0, 0);
        for (int i = 0; i < N; i++)
            support_add_point(&pslg, 1 + i / (double)N, bent ? -0x1p-50 * i * (N - 1 - i) : 0);
        support_add_point(&pslg, 2, 1);
        support_add_point(&pslg, 1, 1);
        for (int32_t v = 0; v < N + 2; v++)
            support_add_segment(&pslg, v, (v + 1) % (N + 2));
        struct tri_mesh mesh = mesh_of(&pslg);
        assert_int_equal(tri_unite_chains(&mesh, NULL), TRI_OK);
        assert_in_range(mesh.n_parents, bent ? N / 4 : 4, bent ? 3 * N / 5 : 4);
        assert_chains(&mesh);
        tri_mesh_free(&mesh);
    }
}

/* Three sides that bend so little that pieces near the corners look straight. The sides are recovered, also if the
 * chain is closed. */
static void test_corners_without_angle(void **state)
{
    (void)state;
    enum { N = 40, SIDES = 3 };
    struct tri_pslg pslg = support_pslg(SIDES * (N + 1) + 3, SIDES * (N + 1) + 3, 0, 0);
    double at[N + 1]; /* along a side, with the finest pieces at its ends */
    for (int i = 0; i <= N; i++)
        at[i] = i <= N / 2 ? ldexp(0.5, i - N / 2) : 1 - ldexp(0.5, N / 2 - i);
    at[0] = 0, at[N] = 1;
    static const double corner[SIDES + 1][2] = {{0, 0}, {1, -0x1p-33}, {2, -0x1p-33}, {3, 0}};
    for (int k = 0; k <= SIDES; k++)
        support_add_point(&pslg, corner[k][0], corner[k][1]);
    support_add_point(&pslg, 3, 1);
    support_add_point(&pslg, 0, 1);
    int32_t last = 0;
    for (int k = 0; k < SIDES; k++) {
        for (int i = 1; i < N; i++) {
            support_add_point(&pslg, corner[k][0] + at[i],
                              corner[k][1] + at[i] * (corner[k + 1][1] - corner[k][1]));
            support_add_segment(&pslg, last, pslg.n_points - 1);
            last = pslg.n_points - 1;
        }
        support_add_segment(&pslg, last, k + 1);
        last = k + 1;
    }
    support_add_segment(&pslg, 3, 4);
    support_add_segment(&pslg, 4, 5);
    support_add_segment(&pslg, 5, 0);
    struct tri_mesh mesh = mesh_of(&pslg);
    assert_int_equal(tri_unite_chains(&mesh, NULL), TRI_OK);
    assert_int_equal(mesh.n_parents, SIDES + 3);
    for (int k = 0; k <= SIDES; k++)
        assert_true(mesh.on[k] < 0);
    assert_chains(&mesh);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sides_of_a_square),
        cmocka_unit_test(test_a_new_marker_ends_a_chain),
        cmocka_unit_test(test_forks_end_a_chain),
        cmocka_unit_test(test_curves_stay_in_pieces),
        cmocka_unit_test(test_corners_without_angle),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
