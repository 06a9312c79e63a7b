/* Compares the triangulation of points on several threads byte for byte with that on one thread, with many small
   blocks. */
#include "support.h"

#include "sched/schedule/threads.h"

static void compare_threads(const struct tri_pslg *pslg, int32_t leaf_size)
{
    static const int threads[] = {1, 2, 3, 8};
    struct tri_mesh whole = support_delaunay(pslg, pslg->n_points + 1, NULL);
    for (size_t i = 0; i < sizeof threads / sizeof *threads; i++) {
        struct par_team team = {.threads = threads[i]};
        const struct tri_executor executor = par_executor(&team);
        struct tri_mesh mesh = support_delaunay(pslg, leaf_size, &executor);
        par_team_end(&team);
        support_assert_same_bytes(&whole, &mesh);
        tri_mesh_free(&mesh);
    }
    tri_mesh_free(&whole);
}

static void test_same_bytes_on_all_threads(void **state)
{
    (void)state;
    for (int kind = 0; kind < SUPPORT_KINDS; kind++)
        for (int32_t leaf_size = 8; leaf_size <= 512; leaf_size *= 8) {
            struct tri_pslg pslg = support_points((enum support_kind)kind, 6000, 17);
            compare_threads(&pslg, leaf_size);
            tri_pslg_free(&pslg);
        }
}

static void test_grid_on_all_threads(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_pslg(10000, 0, 0, 0);
    for (int i = 0; i < 10000; i++)
        support_add_point(&pslg, i * 37 % 100, i / 100);
    compare_threads(&pslg, 64);
    tri_pslg_free(&pslg);
}

/* Leaves of the default size. */
static void test_many_points(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_points(SUPPORT_RANDOM, 70000, 5);
    compare_threads(&pslg, 0);
    tri_pslg_free(&pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bytes_on_all_threads),
        cmocka_unit_test(test_grid_on_all_threads),
        cmocka_unit_test(test_many_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
