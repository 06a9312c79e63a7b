/* Checks that a PSLG is validated before it is used. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

#include "triangle/mesh/pslg.h"

static double corners[] = {0, 0, 1, 0, 0, 1}, hole[] = {0.1, 0.1}, region[] = {0.2, 0.2, 1, -1};

static struct tri_pslg sound(void)
{
    return (struct tri_pslg){
        .n_points = 3, .points = corners, .n_holes = 1, .holes = hole, .n_regions = 1, .regions = region};
}

static void test_sound_input_passes(void **state)
{
    (void)state;
    struct tri_pslg pslg = sound();
    assert_int_equal(tri_pslg_check(&pslg, NULL), TRI_OK);
}

static void test_counts_must_make_sense(void **state)
{
    (void)state;
    struct tri_error error;
    struct tri_pslg few = sound(), negative = sound(), lost = sound(), many = sound();
    few.n_points = 2;
    negative.n_segments = -1;
    lost.holes = NULL;
    many.n_regions = (1 << 28) + 1;
    assert_int_equal(tri_pslg_check(&few, &error), TRI_BAD_INPUT);
    assert_int_equal(tri_pslg_check(&negative, &error), TRI_BAD_INPUT);
    assert_int_equal(tri_pslg_check(&lost, &error), TRI_BAD_INPUT);
    assert_int_equal(tri_pslg_check(&many, &error), TRI_TOO_LARGE);
    assert_int_equal(error.status, TRI_TOO_LARGE);
}

static void test_coordinates_must_be_finite(void **state)
{
    (void)state;
    double *const each[] = {&corners[3], &hole[1], &region[0]};
    for (size_t i = 0; i < sizeof each / sizeof *each; i++) {
        double kept = *each[i];
        struct tri_pslg pslg = sound();
        *each[i] = i % 2 ? NAN : INFINITY;
        assert_int_equal(tri_pslg_check(&pslg, NULL), TRI_BAD_INPUT);
        *each[i] = kept;
        assert_int_equal(tri_pslg_check(&pslg, NULL), TRI_OK);
    }
}

static void test_free_leaves_nothing(void **state)
{
    (void)state;
    struct tri_pslg pslg = {.n_points = 3, .points = malloc(6 * sizeof(double))};
    tri_pslg_free(&pslg);
    assert_null(pslg.points);
    assert_int_equal(pslg.n_points, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_sound_input_passes),
        cmocka_unit_test(test_counts_must_make_sense),
        cmocka_unit_test(test_coordinates_must_be_finite),
        cmocka_unit_test(test_free_leaves_nothing),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
