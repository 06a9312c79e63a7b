/* What the system tells of the machine's work. */
#include "drivers/tasks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

/* Among those that run is this thread itself. */
static void test_busy_where_half_of_the_processors_have_other_work(void **state)
{
    (void)state;
    assert_false(tasks_is_busy("0.00 0.01 0.05 1/213 4711\n", 1));
    assert_true(tasks_is_busy("0.00 0.01 0.05 2/213 4711\n", 1));
    assert_false(tasks_is_busy("0.00 0.01 0.05 1/213 4711\n", 2));
    assert_true(tasks_is_busy("0.00 0.01 0.05 2/213 4711\n", 2));
    assert_false(tasks_is_busy("63.12 64.01 60.05 32/2130 4711\n", 64));
    assert_true(tasks_is_busy("63.12 64.01 60.05 33/2130 4711\n", 64));
}

static void test_nothing_known(void **state)
{
    (void)state;
    assert_false(tasks_is_busy("", 2));
    assert_false(tasks_is_busy("9.00 9.01", 2));
    assert_false(tasks_is_busy("9.00 9.01 9.05 many/213", 2));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_busy_where_half_of_the_processors_have_other_work),
        cmocka_unit_test(test_nothing_known),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
