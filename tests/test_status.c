/* How failures are reported. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "triangle/base/status.h"

static void test_errors_contain_status_file_line_and_text(void **state)
{
    (void)state;
    struct tri_error error;
    memset(&error, 'x', sizeof error);
    assert_int_equal(tri_fail(&error, TRI_BAD_INPUT, "a.poly", 7, "point %d is %s", 3, "nowhere"), TRI_BAD_INPUT);
    assert_int_equal(error.status, TRI_BAD_INPUT);
    assert_string_equal(error.file, "a.poly");
    assert_int_equal(error.line, 7);
    assert_string_equal(error.text, "point 3 is nowhere");
    assert_int_equal(tri_fail(&error, TRI_NO_MEMORY, NULL, 0, "none"), TRI_NO_MEMORY);
    assert_string_equal(error.file, "");
    assert_int_equal(error.line, 0);
}

static void test_a_null_error_is_allowed(void **state)
{
    (void)state;
    assert_int_equal(tri_fail(NULL, TRI_STOPPED, "a.poly", 1, "%d", 1), TRI_STOPPED);
}

/* A text that is too long is truncated and terminated. */
static void test_long_texts_are_truncated(void **state)
{
    (void)state;
    struct tri_error error;
    char longer[2 * sizeof error.file];
    memset(longer, 'p', sizeof longer);
    longer[sizeof longer - 1] = '\0';
    assert_int_equal(tri_fail(&error, TRI_CANNOT_READ, longer, 1, "%s", longer), TRI_CANNOT_READ);
    assert_int_equal(strlen(error.file), sizeof error.file - 1);
    assert_int_equal(strlen(error.text), sizeof error.text - 1);
    assert_memory_equal(error.text, longer, sizeof error.text - 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_errors_contain_status_file_line_and_text),
        cmocka_unit_test(test_a_null_error_is_allowed),
        cmocka_unit_test(test_long_texts_are_truncated),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
