/* Regions keep their area during flips, and the history of flips stays short. */
#include "support.h"
#include "triangle/cdt/flip.h"
#include "triangle/cdt/reconstruct.h"

/* A sliver on top of a triangle, with regions 1 and 2. Edge 2 of triangle 0 lies between them. */
static struct tri_mesh sliver(void)
{
    struct tri_mesh mesh;
    struct tri_error error = {0};
    struct tri_pslg pslg = support_pslg(4, 0, 0, 0);
    struct tri_elements elements = {.n = 2, .n_nodes = 3, .corners = (int32_t[]){0, 1, 2, 0, 3, 1}};
    support_add_point(&pslg, 0, 0);
    support_add_point(&pslg, 1, 0);
    support_add_point(&pslg, 0.5, 1e-9);
    support_add_point(&pslg, 0.5, -1);
    if (tri_reconstruct(&mesh, &pslg, &elements, &(struct tri_reconstruct_options){0}, &error) != TRI_OK)
        fail_msg("%s", error.text);
    assert_true(mesh.tri[0].n[2] == tri_code(1, 1));
    mesh.tri[0].region = 1;
    mesh.tri[1].region = 2;
    tri_pslg_free(&pslg);
    return mesh;
}

/* After a flip, the history reads only the corners. */
static void set_corners(struct tri_mesh *mesh, tri_triangle_id t, int32_t a, int32_t b, int32_t c)
{
    memcpy(mesh->tri[t].v, (int32_t[]){a, b, c}, sizeof mesh->tri[t].v);
}

static void test_regions_keep_their_area(void **state)
{
    (void)state;
    struct tri_mesh mesh = sliver();
    struct tri_flip_history history;
    assert_true(tri_flip_history_begin(&history, &mesh));
    tri_flip_history_settle(&history, &mesh);
    assert_true(mesh.tri[0].region == 1 && mesh.tri[1].region == 2);
    assert_true(tri_flip_history_add(&history, &mesh, 0, 2));
    set_corners(&mesh, 0, 2, 0, 3);
    set_corners(&mesh, 1, 2, 3, 1);
    assert_true(mesh.tri[0].region == 1 && mesh.tri[1].region == 2);
    tri_flip_history_settle(&history, &mesh);
    assert_true(mesh.tri[0].region == 2 && mesh.tri[1].region == 2);
    mesh.tri[0].region = 1;
    tri_flip_history_settle(&history, &mesh); /* the history has been cleared */
    assert_true(mesh.tri[0].region == 1 && mesh.tri[1].region == 2);
    tri_flip_history_free(&history);
    tri_mesh_free(&mesh);
}

/* After any number of flips, cutting the history loses nothing. */
static void test_history_is_cut(void **state)
{
    enum { MANY = 1200000 };
    (void)state;
    struct tri_mesh mesh = sliver();
    struct tri_flip_history history;
    assert_true(tri_flip_history_begin(&history, &mesh));
    for (int i = 0; i < MANY; i++) /* and back again */
        assert_true(tri_flip_history_add(&history, &mesh, 0, 2));
    assert_true(history.n < MANY && history.capacity < 2 * MANY);
    tri_flip_history_settle(&history, &mesh);
    assert_true(mesh.tri[0].region == 1 && mesh.tri[1].region == 2);
    tri_flip_history_free(&history);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_regions_keep_their_area),
        cmocka_unit_test(test_history_is_cut),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
