/* Flips turn any triangulation into the Delaunay triangulation, with one triangle stored for each vertex. */
#include "support.h"
#include "triangle/cdt/delaunay.h"
#include "triangle/cdt/flip.h"
#include "triangle/cdt/reconstruct.h"

/* All triangles of n points in convex position on an arc, with the first point as common corner. */
static struct tri_mesh fan(int32_t n, double height)
{
    struct tri_mesh mesh;
    struct tri_error error = {0};
    struct tri_pslg pslg = support_pslg(n, 0, 0, 0);
    struct tri_elements elements = {.n = n - 2, .n_nodes = 3};
    elements.corners = malloc((size_t)n * 3 * sizeof *elements.corners);
    for (int32_t i = 0; i < n; i++) {
        double x = (double)(i * i) / (n * n) + i;
        support_add_point(&pslg, x, -height * x * (n - x));
    }
    for (int32_t t = 0; t < n - 2; t++)
        memcpy(&elements.corners[3 * t], (int32_t[]){0, t + 1, t + 2}, 3 * sizeof(int32_t));
    if (tri_reconstruct(&mesh, &pslg, &elements, &(struct tri_reconstruct_options){0}, &error) != TRI_OK)
        fail_msg("%s", error.text);
    tri_elements_free(&elements);
    tri_pslg_free(&pslg);
    return mesh;
}

static void assert_naively_delaunay(const struct tri_mesh *mesh)
{
    struct tri_error error = {0};
    if (tri_mesh_validate(mesh, &error) != TRI_OK)
        fail_msg("%s", error.text);
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (int32_t v = 0; v < mesh->n_vertices; v++) {
            const int32_t *c = mesh->tri[t].v;
            if (v != c[0] && v != c[1] && v != c[2])
                assert_true(tri_incircle(mesh->xy[c[0]], mesh->xy[c[1]], mesh->xy[c[2]], mesh->xy[v]) <= 0);
        }
}

static void test_fans_become_delaunay(void **state)
{
    (void)state;
    struct tri_error error = {0};
    for (int32_t n = 3; n < 40; n++) {
        struct tri_mesh mesh = fan(n, 0.01 * n);
        assert_int_equal(tri_flip_to_delaunay(&mesh, NULL, &error), TRI_OK);
        assert_int_equal(mesh.n_triangles, n - 2);
        assert_naively_delaunay(&mesh);
        tri_mesh_free(&mesh);
    }
}

/* The triangle stored for each vertex is still one of its triangles after flips. */
static void test_corners_are_kept(void **state)
{
    (void)state;
    struct tri_mesh mesh = fan(30, 0.3);
    struct tri_flips flips = {.mesh = &mesh, .corner = calloc(30, sizeof *flips.corner)};
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        for (int k = 0; k < 3; k++)
            flips.corner[mesh.tri[t].v[k]] = t;
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        assert_true(tri_flip_touch(&flips, t) && tri_flip_legalise(&flips));
    for (int32_t v = 0; v < 30; v++) {
        const int32_t *c = mesh.tri[flips.corner[v]].v;
        assert_true(c[0] == v || c[1] == v || c[2] == v);
    }
    assert_naively_delaunay(&mesh);
    free(flips.corner);
    tri_flips_free(&flips);
    tri_mesh_free(&mesh);
}

/* Four points on a circle, so both diagonals are Delaunay. A mesh that is read keeps its diagonal. A touched edge gets
 * the diagonal that ties by coordinates select. */
static void test_ties_keep_the_diagonal_that_was_read(void **state)
{
    (void)state;
    int changed = 0;
    for (int turn = 0; turn < 2; turn++) {
        struct tri_mesh mesh;
        struct tri_error error = {0};
        struct tri_pslg pslg = support_pslg(4, 0, 0, 0);
        int32_t corners[2][6] = {{0, 1, 2, 0, 2, 3}, {1, 2, 3, 1, 3, 0}};
        struct tri_elements elements = {.n = 2, .n_nodes = 3, .corners = corners[turn]};
        for (int i = 0; i < 4; i++)
            support_add_point(&pslg, i == 1 || i == 2, i > 1);
        struct tri_reconstruct_options as_it_is = {0};
        assert_int_equal(tri_reconstruct(&mesh, &pslg, &elements, &as_it_is, &error), TRI_OK);
        assert_int_equal(tri_flip_to_delaunay(&mesh, NULL, &error), TRI_OK);
        assert_memory_equal(mesh.tri[0].v, corners[turn], sizeof mesh.tri[0].v);
        struct tri_flips flips = {.mesh = &mesh};
        assert_true(tri_flip_touch(&flips, 0) && tri_flip_legalise(&flips));
        changed += memcmp(mesh.tri[0].v, corners[turn], sizeof mesh.tri[0].v) != 0;
        tri_flips_free(&flips);
        tri_mesh_free(&mesh);
        tri_pslg_free(&pslg);
    }
    assert_int_equal(changed, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_fans_become_delaunay),
        cmocka_unit_test(test_corners_are_kept),
        cmocka_unit_test(test_ties_keep_the_diagonal_that_was_read),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
