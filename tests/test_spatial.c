/* Points are sorted along the curve, then their order is restored. The internal order leaves no trace in a mesh. */
#include "support.h"
#include "triangle/cdt/delaunay.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/cdt/spatial.h"

/* A PSLG in which every point has attributes and a marker that identify it. */
static struct tri_pslg named_points(enum support_kind kind, int32_t n, uint64_t seed)
{
    struct tri_pslg pslg = support_tangle(kind, n, n / 8, seed);
    pslg.n_attributes = 2;
    pslg.attributes = malloc(2 * (size_t)pslg.n_points * sizeof *pslg.attributes);
    pslg.markers = malloc((size_t)pslg.n_points * sizeof *pslg.markers);
    for (int32_t v = 0; v < pslg.n_points; v++) {
        pslg.attributes[2 * v] = v;
        pslg.attributes[2 * v + 1] = -v;
        pslg.markers[v] = 1000 + v;
    }
    return pslg;
}

static void assert_callers_points(const struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    assert_null(mesh->origin);
    for (int32_t v = 0; v < pslg->n_points; v++) {
        double at[2];
        tri_mesh_place(mesh, v, at);
        assert_true(at[0] == pslg->points[2 * v] && at[1] == pslg->points[2 * v + 1]);
        assert_memory_equal(&mesh->attributes[2 * v], &pslg->attributes[2 * v], 2 * sizeof(double));
        assert_int_equal(mesh->vertex_markers[v], pslg->markers[v]);
    }
    for (int32_t v = 0; mesh->twin && v < pslg->n_points; v++)
        for (int32_t first = 0; first <= v; first++)
            if (pslg->points[2 * first] == pslg->points[2 * v] &&
                pslg->points[2 * first + 1] == pslg->points[2 * v + 1]) {
                assert_int_equal(mesh->twin[v], first);
                break;
            }
}

static void test_sorting_follows_the_curve(void **state)
{
    (void)state;
    struct tri_pslg pslg = named_points(SUPPORT_LATTICE, 500, 1);
    struct tri_mesh mesh;
    int32_t *rank, order[600];
    assert_int_equal(tri_mesh_init(&mesh, NULL), TRI_OK);
    assert_int_equal(tri_mesh_take_points(&mesh, &pslg, NULL, NULL), TRI_OK);
    assert_true(mesh.n_input <= 600);
    uint64_t scratch[1200];
    for (int32_t v = 0; v < mesh.n_input; v++)
        order[v] = v;
    tri_hilbert_order(mesh.xy, order, mesh.n_input, scratch, NULL);
    assert_int_equal(tri_sort_points(&mesh, &rank, NULL, NULL), TRI_OK);
    for (int32_t v = 0; v < mesh.n_input; v++) {
        assert_int_equal(mesh.origin[v], order[v]);
        assert_int_equal(rank[order[v]], v);
        assert_true(mesh.attributes[2 * v] == order[v]);
        assert_int_equal(mesh.vertex_markers[v], 1000 + order[v]);
    }
    free(rank);
    assert_int_equal(tri_restore_points(&mesh, NULL, NULL), TRI_OK);
    assert_callers_points(&mesh, &pslg);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* After restoring, all references to vertices are consistent. */
static void refine_again(struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    struct tri_options finer = support_quality(25, 0.002);
    struct tri_check_options check = {.max_area = 0.002, .delaunay = TRI_CHECK_CONSTRAINED, .max_bad = -1};
    struct tri_refine_report report;
    assert_int_equal(tri_refine(mesh, &finer.quality, &report, NULL), TRI_OK);
    support_judge(mesh, pslg, &check, false, NULL);
}

/* Refinement uses the points in spatial order. */
static enum tri_status refine_sorted(void *user, struct tri_mesh *mesh, const struct tri_quality *options,
                                     struct tri_refine_report *report, struct tri_error *error)
{
    *(bool *)user = mesh->origin != NULL;
    return tri_refine(mesh, options, report, error);
}

/* Refinement by the same call or by the caller gives the same mesh, and refinement may continue. */
static void test_order_is_restored_after_refinement(void **state)
{
    (void)state;
    for (enum support_kind kind = SUPPORT_RANDOM; kind <= SUPPORT_LATTICE; kind++) {
        bool was_sorted = false;
        struct tri_pslg pslg = named_points(kind, 300, 7 + (uint64_t)kind);
        struct tri_options options = support_quality(25, 0.01);
        struct tri_mesh once = support_generate(&pslg, &options, NULL);
        options.refine_call = refine_sorted;
        options.refine_user = &was_sorted;
        options.executor = &support_backwards;
        struct tri_mesh called = support_generate(&pslg, &options, NULL);
        assert_true(was_sorted);
        assert_null(called.origin);
        assert_callers_points(&called, &pslg);
        assert_int_equal(once.n_triangles, called.n_triangles);
        for (int32_t t = 0; t < once.n_triangles; t++)
            assert_memory_equal(once.tri[t].v, called.tri[t].v, sizeof once.tri[t].v);
        if (kind == SUPPORT_RANDOM) /* the lattice has crossings too close together for bounds to be met */
            refine_again(&called, &pslg);
        tri_mesh_free(&once);
        tri_mesh_free(&called);
        tri_pslg_free(&pslg);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sorting_follows_the_curve),
        cmocka_unit_test(test_order_is_restored_after_refinement),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
