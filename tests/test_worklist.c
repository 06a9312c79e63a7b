/* Compares the worklist of bad triangles with a search over every triangle. */
#include "sched/schedule/worklist.h"

#include "sched/schedule/prerefine.h"
#include "tests/support.h"

static void test_slots_grow(void **state)
{
    (void)state;
    struct par_ids triangles = {0};
    for (int32_t i = 0; i < 1000; i++)
        assert_true(par_ids_add(&triangles, 3 * i));
    assert_int_equal(triangles.n, 1000);
    for (int32_t i = 0; i < 1000; i++)
        assert_int_equal(triangles.item[i], 3 * i);
    free(triangles.item);
}

static void test_a_set_holds_what_is_listed(void **state)
{
    (void)state;
    struct par_ids triangles = {0};
    struct par_triangle_set set;
    assert_true(par_ids_add(&triangles, 63) && par_ids_add(&triangles, 5));
    assert_true(par_triangle_set_of(&set, &triangles, 200));
    for (int32_t i = 0; i < 200; i++)
        assert_int_equal(set.word[i / 64] >> i % 64 & 1, i == 63 || i == 5);
    free(set.word);
    free(triangles.item);
}

/* A square with enough points for several shares, and bounds that about half of its triangles violate. */
static struct tri_mesh half_bad(struct tri_quality *quality)
{
    struct tri_pslg pslg = support_square(1, 50000, 3);
    struct tri_options options = tri_defaults();
    struct tri_report report;
    struct tri_mesh mesh = support_generate(&pslg, &options, &report);
    tri_pslg_free(&pslg);
    *quality = tri_quality_defaults();
    quality->min_angle = 25;
    assert_true(tri_shares(mesh.n_triangles) > 2);
    return mesh;
}

static void assert_holds_all_bad(const struct par_ids *worklist, const struct tri_mesh *mesh,
                                 const struct tri_quality *quality, double radius)
{
    int32_t *all = malloc((size_t)mesh->n_triangles * sizeof *all);
    double largest2 = 0;
    assert_non_null(all);
    int32_t n = tri_find_work(mesh, quality, 0, mesh->n_triangles, all);
    for (int32_t i = 0; i < n; i++) {
        const int32_t *v = mesh->tri[all[i]].v;
        largest2 = fmax(largest2, par_radius2(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]));
    }
    assert_true(n > 0 && n < mesh->n_triangles);
    assert_int_equal(worklist->n, n);
    assert_memory_equal(worklist->item, all, (size_t)n * sizeof *all);
    assert_true(radius == sqrt(largest2));
    free(all);
}

static void test_the_worklist_holds_all_bad_triangles(void **state)
{
    (void)state;
    struct tri_quality quality;
    struct tri_mesh mesh = half_bad(&quality);
    struct par_ids worklist = {0};
    double radius;
    assert_int_equal(par_worklist_fill(&worklist, &mesh, &quality, false, &support_backwards, &radius, NULL), TRI_OK);
    assert_holds_all_bad(&worklist, &mesh, &quality, radius);
    for (int32_t t = 0; t < mesh.n_triangles; t++)
        assert_int_equal(mesh.tri[t].generation, 0);
    free(worklist.item);
    tri_mesh_free(&mesh);
}

/* After some refinement only new triangles are judged. The worklist is the same as if all were judged. */
static void test_only_new_triangles_are_judged_again(void **state)
{
    (void)state;
    struct tri_quality quality;
    struct tri_mesh mesh = half_bad(&quality);
    struct par_ids worklist = {0};
    struct tri_refine_report report;
    double radius;
    assert_int_equal(par_worklist_fill(&worklist, &mesh, &quality, false, NULL, &radius, NULL), TRI_OK);
    int32_t before = worklist.n;
    quality.max_steiner = 3000;
    assert_int_equal(tri_refine(&mesh, &quality, &report, NULL), TRI_OK);
    assert_int_equal(par_worklist_fill(&worklist, &mesh, &quality, true, &support_backwards, &radius, NULL), TRI_OK);
    assert_true(worklist.n != before);
    assert_holds_all_bad(&worklist, &mesh, &quality, radius);
    free(worklist.item);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_slots_grow),
        cmocka_unit_test(test_a_set_holds_what_is_listed),
        cmocka_unit_test(test_the_worklist_holds_all_bad_triangles),
        cmocka_unit_test(test_only_new_triangles_are_judged_again),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
