/* List scheduling of measured blocks, the shares that follow, and the same on ranks. */
#include "drivers/mesh/prediction.h"
#include "drivers/mesh/replay.h"

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
    report.seconds_shared[0] = 0.0625;
    report.seconds_shared[3] = 0.1875;
    report.seconds_total += 2;
    report.threads = 2;
    assert_true(is_near(prediction_sequential(&report), 1.25));
    assert_true(is_near(prediction_overhead(&report), 5));
    assert_true(is_near(prediction_numbering(&report), 20));
    assert_true(is_near(prediction_number(&report, 1), 4));
    assert_true(is_near(prediction_number(&report, 8), 0.5));
    assert_true(is_near(prediction_number(&report, 256), 4.0 / TRI_MOST_SHARES));
    assert_true(is_near(prediction_shared(&report, 1), 0.0625 + 0.375));
    assert_true(is_near(prediction_shared(&report, 4), 0.0625 + 0.09375));
    assert_true(is_near(prediction_shared(&report, 64), 0.0625 + 0.375 / 8));
    report.levels = 0; /* one sequential call has no schedule */
    assert_true(is_near(prediction_overhead(&report), 0));
    assert_true(is_near(prediction_numbering(&report), 0));
    report = (struct par_report){0};
    assert_true(is_near(prediction_sequential(&report), 0));
    assert_true(is_near(prediction_overhead(&report), 0));
}

/* --- on ranks */

enum { SIDE = 5, SWAPS = 3 }; /* the first: of a mesh of 2 x 2 tiles, in blocks */

/* Seconds: 1 in tiles, 1/4 in blocks over two of them, half of that at rims, 1/16 in the middle. */
static struct par_report four_tiles(struct par_block_report blocks[SIDE * SIDE])
{
    for (int c = 0; c < SIDE; c++)
        for (int r = 0; r < SIDE; r++) {
            double seconds = (c % 2 == 1 ? 1 : c == 2 ? 0.25 : 0.125) * (r % 2 == 1 ? 1 : r == 2 ? 0.25 : 0.125);
            blocks[c * SIDE + r] = block_of(0, 0, 2 * (c % 2 == 0) + (r % 2 == 0), c * SIDE + r, seconds);
        }
    return (struct par_report){.columns = SIDE, .rows = SIDE, .threads = 1, .blocks = blocks,
                               .n_blocks = SIDE * SIDE, .seconds_prerefine = 0.5, .seconds_number = 2};
}

static struct replay replayed(const struct par_report *report, int n_ranks, int times)
{
    struct replay_how how = {.n_ranks = n_ranks, .threads = 1, .times = times, .bandwidth = 1e9,
                             .pair = {{1000, 0.5, SWAPS}, {100, 0.25, 2 * SWAPS}}};
    struct replay replay;
    assert_true(replay_on_ranks(report, &how, &replay));
    assert_true(is_near(replay.total, replay.alone + replay.refine + replay.merge + replay.communicate +
                                          replay.hand_out));
    return replay;
}

static void test_one_rank_does_all(void **state)
{
    (void)state;
    struct par_block_report blocks[SIDE * SIDE];
    const struct par_report report = four_tiles(blocks);
    struct replay r = replayed(&report, 1, 1);
    assert_true(is_near(r.refine, 6.25) && is_near(r.alone, 0.5) && is_near(r.hand_out, 2));
    assert_true(r.merge == 0 && r.bytes == 0 && r.messages == 0);
    r = replayed(&report, 1, 3); /* where copies meet, what was at two rims is one block */
    assert_true(is_near(r.refine, 9 * 6.25) && is_near(r.alone, 9 * 0.5) && is_near(r.hand_out, 9 * 2));
}

/* Each has a column. Between them lie five blocks, which one of them lends and the other refines. */
static void test_two_ranks_meet_along_a_column(void **state)
{
    (void)state;
    struct par_block_report blocks[SIDE * SIDE];
    const struct par_report report = four_tiles(blocks);
    struct replay r = replayed(&report, 2, 1);
    double refine = 2.5 + 2.5 * (0.125 + 0.25); /* a column, and those left and right of it */
    assert_true(is_near(r.refine, refine));
    assert_true(is_near(r.bytes, 5 * 1000) && is_near(r.most_bytes, 5 * 500));
    assert_true(is_near(r.messages, 2 * SWAPS)); /* in two phases */
    assert_true(is_near(r.merge, 5 * 0.25) && is_near(r.hand_out, 1));
    assert_true(is_near(r.processor, 0.5 + refine + 5 * 0.25 + 1));
}

/* Each has a tile: three lend to the first for the block in the middle. */
static void test_four_ranks_meet_at_a_corner(void **state)
{
    (void)state;
    struct par_block_report blocks[SIDE * SIDE];
    const struct par_report report = four_tiles(blocks);
    struct replay four = replayed(&report, 4, 1), many = replayed(&report, 100, 1);
    assert_true(is_near(four.refine, 1 + 0.375 + 0.375 + 0.375 * 0.375));
    assert_true(is_near(four.bytes, (2 + 2 + 7) * 1000));
    assert_true(is_near(four.messages, (2 + 2 + 5) * SWAPS));
    assert_true(is_near(many.refine, four.refine) && is_near(many.bytes, four.bytes)); /* some have nothing */
    struct par_report none = report;
    struct replay_how how = replay_usual(2, 1, 1, 1e5);
    none.columns = none.rows = 0;
    assert_false(replay_on_ranks(&none, &how, &four));
}

/* Twice the same, the second time with messages of a tenth and half the packing; a coarse mesh before, and a round
 * behind. */
static void test_a_second_schedule_is_shared(void **state)
{
    (void)state;
    enum { N = SIDE * SIDE };
    struct par_block_report blocks[2 * N + 2] = {block_of(0, 0, 0, 6, 100)};
    struct par_report report = four_tiles(blocks + 1);
    const struct replay one = replayed(&report, 2, 1);
    for (int i = 1; i <= N; i++) {
        blocks[i].schedule = 1;
        blocks[N + i] = blocks[i];
        blocks[N + i].schedule = 2;
    }
    blocks[2 * N + 1] = block_of(2, 1, 0, 6, 4);
    report.blocks = blocks;
    report.n_blocks = 2 * N + 2;
    report.schedule = 1;
    const struct replay two = replayed(&report, 2, 1);
    assert_true(is_near(two.alone, one.alone + 4) && is_near(two.hand_out, one.hand_out));
    assert_true(is_near(two.refine, 2 * one.refine) && is_near(two.merge, 1.5 * one.merge));
    assert_true(is_near(two.bytes, 1.1 * one.bytes) && is_near(two.messages, 3 * one.messages));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_largest_first),
        cmocka_unit_test(test_phases_follow_each_other),
        cmocka_unit_test(test_one_rank_does_all),
        cmocka_unit_test(test_two_ranks_meet_along_a_column),
        cmocka_unit_test(test_four_ranks_meet_at_a_corner),
        cmocka_unit_test(test_a_second_schedule_is_shared),
        cmocka_unit_test(test_shares),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
