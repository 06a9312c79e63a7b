/* The number of tasks that launchers pass to a program. */
#include "drivers/start.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>

#include <cmocka.h>

/* Sets the launcher's variables in this process. NULL: unset. Returns the number of tasks. */
static int tasks_of(const char *size, const char *rank, int *task)
{
    static const char *const others[] = {"OMPI_COMM_WORLD_SIZE", "SLURM_STEP_NUM_TASKS"};
    for (size_t i = 0; i < sizeof others / sizeof *others; i++)
        unsetenv(others[i]);
    setenv("PMI_SIZE", size, 1);
    setenv("PMI_RANK", rank, 1);
    return tasks_started(task);
}

static void test_the_launcher_sets_the_number_of_tasks(void **state)
{
    int task = -1;
    (void)state;
    assert_int_equal(tasks_of("4", "3", &task), 4);
    assert_int_equal(task, 3);
    assert_int_equal(tasks_of("1", "0", &task), 1);
    assert_int_equal(task, 0);
}

/* A number that exceeds an int is ignored. */
static void test_invalid_variables_are_ignored(void **state)
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
        cmocka_unit_test(test_the_launcher_sets_the_number_of_tasks),
        cmocka_unit_test(test_invalid_variables_are_ignored),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
