/* Further services of the operating system that programs use: limits, the terminal, interrupts. */
#include <math.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>

#include "triangle/base/system.h"

static void test_memory_and_disk_are_measured(void **state)
{
    (void)state;
    assert_true(tri_memory_left() > 0 && tri_memory_total() > 0);
    assert_true(tri_memory_total() == HUGE_VAL || tri_memory_used(NULL) <= tri_memory_total());
    assert_true(tri_memory_peak() >= 0 && tri_memory_of_stacks(2) >= 0);
    assert_true(tri_disk_left(".") > 0 && tri_disk_left("no/such/folder/file") == HUGE_VAL);
}

static void test_the_program_finds_its_own_path(void **state)
{
    (void)state;
    char path[TRI_PATH];
    if (tri_program_path(path))
        assert_non_null(strstr(path, "test_system_process"));
    assert_true(tri_processors() >= 1);
}

static volatile sig_atomic_t asked, alarms;

static void record_interrupt(int number) { asked = number; }
static void note_time(void) { alarms++; }
static void note_crash(void) {}

static void test_interrupts_are_noticed(void **state)
{
    (void)state;
    static const struct tri_interrupts handlers = {record_interrupt, note_time, note_crash};
    const bool has_alarm = tri_interrupts_catch(&handlers);
    assert_int_equal(raise(SIGTERM), 0);
    assert_int_equal(asked, SIGTERM);
    assert_string_equal(tri_interrupt_name(SIGTERM), "SIGTERM");
    assert_null(tri_interrupt_name(255));
    if (!has_alarm)
        return;
    tri_alarm(0.01);
    for (int i = 0; i < 100 && alarms == 0; i++)
        (void)tri_pause(0.1);
    assert_int_equal(alarms, 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_memory_and_disk_are_measured),
        cmocka_unit_test(test_the_program_finds_its_own_path),
        cmocka_unit_test(test_interrupts_are_noticed),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
