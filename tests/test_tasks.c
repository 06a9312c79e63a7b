/* What launchers tell a program. */
#include "drivers/start.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

/* The launcher's variables, of this process: NULL: unset. Returns how many tasks there are. */
static int tasks_of(const char *size, const char *rank, int *task)
{
    static const char *const others[] = {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        unsetenv(others[i]);
    setenv("PMI_SIZE", size, 1);
    setenv("PMI_RANK", rank, 1);
    return tasks_started(task);
}

static void test_tasks_as_the_launcher_says(void **state)
{
    int task = -1;
    (void)state;
    assert_int_equal(tasks_of("4", "3", &task), 4);
    assert_int_equal(task, 3);
    assert_int_equal(tasks_of("1", "0", &task), 1);
    assert_int_equal(task, 0);
}

/* A number that no int holds is no number of tasks. */
static void test_nonsense_is_no_launcher(void **state)
{
    static const char *const sizes[] = {"99999999999", "4294967298", "99999999999999999999999", "-2", "4x", "x", ""};
    int task = -1;
    (void)state;
    for (size_t i = 0; i < sizeof sizes / sizeof *sizes; i++)
        assert_int_equal(tasks_of(sizes[i], "1", &task), 1);
    assert_int_equal(tasks_of("4", "99999999999", &task), 4);
    assert_int_equal(task, 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_tasks_as_the_launcher_says),
        cmocka_unit_test(test_nonsense_is_no_launcher),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
