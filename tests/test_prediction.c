/* List scheduling of measured blocks, and the shares that follow. */
#include "drivers/prediction.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static bool is_near(double a, double b) { return fabs(a - b) < 1e-12; }

static struct par_block_report block_of(int schedule, int round, int phase, int number, double seconds)
{
    return (struct par_block_report){
        .schedule = schedule, .round = round, .phase = phase, .block = number, .seconds = seconds};
}

static struct par_block_report block(int round, int phase, int number, double seconds)
{
    return block_of(1, round, phase, number, seconds);
}

/* 3 3 2 2 2 on two threads: largest first ends at 7, one above the best. */
static void test_largest_first(void **state)
{
    (void)state;
    const struct par_block_report blocks[] = {block(0, 0, 0, 2), block(0, 0, 2, 3), block(0, 0, 4, 2),
                                              block(0, 0, 6, 3), block(0, 0, 8, 2)};
    assert_true(is_near(prediction_refine(blocks, 5, 0, 1), 12));
    assert_true(is_near(prediction_refine(blocks, 5, 0, 2), 7));
    assert_true(is_near(prediction_refine(blocks, 5, 0, 3), 5));
    assert_true(is_near(prediction_refine(blocks, 5, 0, 4), 4));
    assert_true(is_near(prediction_refine(blocks, 5, 0, 256), 3));
}

/* A phase waits for the one before, also where the next schedule begins with the same round and phase. */
static void test_phases_follow_each_other(void **state)
{
    (void)state;
    const struct par_block_report blocks[] = {block_of(0, 0, 0, 0, 1), block_of(0, 0, 0, 1, 1), block(0, 0, 2, 4),
                                              block(0, 0, 5, 1), block(0, 1, 6, 2), block(1, 0, 7, 8),
                                              block(1, 0, 9, 8)};
    assert_true(is_near(prediction_refine(blocks, 7, 0, 1), 25));
    assert_true(is_near(prediction_refine(blocks, 7, 0, 2), 1 + 4 + 2 + 8));
    assert_true(is_near(prediction_refine(blocks, 7, 1, 2), 8));
    assert_true(is_near(prediction_refine(blocks, 7, 2, 2), 0));
    assert_true(is_near(prediction_refine(NULL, 0, 0, 64), 0));
}

static void test_shares(void **state)
{
    (void)state;
    struct par_report report = {.levels = 1, .seconds_total = 10, .seconds_prerefine = 1, .seconds_refine = 8.5};
    assert_true(is_near(prediction_sequential(&report), 1.5));
    assert_true(is_near(prediction_overhead(&report), 5));
    assert_true(is_near(prediction_numbering(&report), 0));
    report.seconds_number = 2; /* comes after what the shares are shares of, and is shared out itself */
    report.seconds_find = 0.25;
    report.seconds_total += 2;
    report.threads = 2;
    assert_true(is_near(prediction_sequential(&report), 1.25));
    assert_true(is_near(prediction_overhead(&report), 5));
    assert_true(is_near(prediction_numbering(&report), 20));
    assert_true(is_near(prediction_shared(&report, report.seconds_number, 1), 4));
    assert_true(is_near(prediction_shared(&report, report.seconds_number, 8), 0.5));
    assert_true(is_near(prediction_shared(&report, report.seconds_number, 256), 4.0 / TRI_MOST_SHARES));
    report.levels = 0; /* one sequential call has no schedule */
    assert_true(is_near(prediction_overhead(&report), 0));
    assert_true(is_near(prediction_numbering(&report), 0));
    report = (struct par_report){0};
    assert_true(is_near(prediction_sequential(&report), 0));
    assert_true(is_near(prediction_overhead(&report), 0));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_largest_first),
        cmocka_unit_test(test_phases_follow_each_other),
        cmocka_unit_test(test_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
