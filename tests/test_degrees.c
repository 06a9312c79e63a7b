/* The cosine compared with the C library's in long double, and properties that must hold exactly. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "triangle/geometry/shape.h"

static void test_accuracy(void **state)
{
    (void)state;
    for (double degrees = 0; degrees <= 180; degrees += 0.0625)
        assert_true(fabs(tri_cos_degrees(degrees) - (double)cosl((long double)degrees * 0.017453292519943295769237L)) <=
                    1e-15);
}

static void test_ends_and_symmetry(void **state)
{
    (void)state;
    assert_true(tri_cos_degrees(0) == 1);
    assert_true(tri_cos_degrees(180) == -1);
    for (double degrees = 0; degrees < 90; degrees += 0.125)
        assert_true(tri_cos_degrees(180 - degrees) == -tri_cos_degrees(degrees));
}

static void test_larger_angles_have_smaller_cosines(void **state)
{
    (void)state;
    for (double degrees = 0; degrees < 180; degrees += 0.0625)
        assert_true(tri_cos_degrees(degrees + 0.0625) < tri_cos_degrees(degrees));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_accuracy),
        cmocka_unit_test(test_ends_and_symmetry),
        cmocka_unit_test(test_larger_angles_have_smaller_cosines),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
