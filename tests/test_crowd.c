/* The estimated number of triangles that angles require, compared with refinement. */
#include "support.h"
#include "triangle/size/estimate.h"

/* Bounds on angles alone: in a long gap between walls, where sizes cannot grow; at a small feature of a large square;
 * and along coasts. */
static void test_angles(void **state)
{
    (void)state;
    static const char *const files[] = {"regress/long_gap.poly", "letter.poly", "koch_lake.poly", "gear.poly",
                                        "coast/norway_sea.poly"};
    for (size_t k = 0; k < sizeof files / sizeof *files; k++)
        for (double angle = 20; angle < 35; angle += 10) {
            struct tri_pslg pslg;
            struct tri_options options = support_quality(angle, 0);
            struct tri_refine_report report;
            assert_true(support_read(files[k], &pslg));
            options.refine = false;
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            double sure, estimate = tri_estimate(&mesh, &options.quality, NULL, &sure);
            assert_int_equal(tri_refine(&mesh, &options.quality, &report, NULL), TRI_OK);
            print_message("  %s, %g degrees: %.2f\n", files[k], angle, estimate / mesh.n_triangles);
            assert_true(estimate > 0.65 * mesh.n_triangles && estimate < 1.5 * mesh.n_triangles);
            tri_mesh_free(&mesh);
            tri_pslg_free(&pslg);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_angles)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
