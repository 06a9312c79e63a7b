/* Lists of ids that shares have found, row by row, compared with a naive list; and ranges of free ids. */
#include "sched/tiles/finds.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "sched/tunables.h"

enum { IDS = 5000, ROWS = 7, EMPTY_ROW = 4 };

/* The row of an id: ids are found in runs of a row, and one in eleven is not found (-1). No share finds any id of
 * EMPTY_ROW. */
static int32_t row_of(int32_t id)
{
    int32_t row = id / 13 * 5 % ROWS;
    return id % 11 == 3 || row == EMPTY_ROW ? -1 : row;
}

static int32_t note_of(int32_t id) { return 3 * id + 1; }

static void find_all(struct par_finds *finds)
{
    assert_true(par_finds_begin(finds, ROWS));
    for (size_t share = 0; share < PAR_FIND_SHARES; share++) {
        struct par_finder finder = par_finder_of(finds, share);
        const struct tri_range range = par_finds_share(share, IDS);
        for (int32_t id = range.first; id < range.last; id++)
            if (row_of(id) >= 0)
                par_find_noted(&finder, id, row_of(id), note_of(id));
        assert_true(par_finder_end(&finder));
    }
}

/* Stores the ids of a row in increasing order and returns their number. */
static int32_t list_row(int32_t row, int32_t list[IDS])
{
    int32_t n = 0;
    for (int32_t id = 0; id < IDS; id++)
        if (row_of(id) == row)
            list[n++] = id;
    return n;
}

static void test_rows_equal_naive_lists(void **state)
{
    (void)state;
    struct par_finds finds;
    find_all(&finds);
    assert_true(par_finds_deal(&finds, NULL));
    for (int32_t row = 0, at = 0; row < ROWS; row++) {
        int32_t list[IDS], n = list_row(row, list);
        assert_int_equal(finds.start[row], at);
        assert_int_equal(finds.start[row + 1], at + n);
        assert_memory_equal(finds.item + at, list, (size_t)n * sizeof *list);
        for (int32_t i = 0; i < n; i++)
            assert_int_equal(finds.note[at + i], note_of(list[i]));
        at += n;
    }
    par_finds_free(&finds);
}

static bool is_free(int32_t id) { return row_of(id) < 0 || (id >= 1000 && id < 1400); }
static bool is_removed(int32_t id) { return id % 500 < 100 || id % 7 == 2; }

/* Each id that a search met as free, or that was removed afterwards, is in exactly one range. Long ranges are last. */
static void test_gaps_have_all_free_ids(void **state)
{
    (void)state;
    static int32_t times[IDS];
    struct par_finds finds;
    struct par_ranges ranges = {0};
    memset(times, 0, sizeof times);
    assert_true(par_finds_begin(&finds, ROWS));
    for (size_t share = 0; share < PAR_FIND_SHARES; share++) {
        struct par_finder finder = par_finder_of(&finds, share);
        struct par_ids removed = {0};
        const struct tri_range range = par_finds_share(share, IDS);
        for (int32_t id = range.first; id < range.last; id++)
            if (is_free(id))
                par_find_gap(&finder, id);
            else if (is_removed(id))
                assert_true(par_ids_add(&removed, id));
        assert_true(par_finder_end(&finder) && par_finds_add_gaps(&finds, share, &removed));
        free(removed.item);
    }
    assert_true(par_finds_give(&finds, &ranges));
    for (int32_t i = 0, longest = 0; i < ranges.n; i++) {
        const int32_t length = ranges.item[i].end - ranges.item[i].next;
        assert_true(length > 0 && (length >= PAR_LEAST_RANGE || longest < PAR_LEAST_RANGE));
        longest = length > longest ? length : longest;
        for (int32_t id = ranges.item[i].next; id < ranges.item[i].end; id++)
            times[id]++;
    }
    for (int32_t id = 0; id < IDS; id++)
        assert_int_equal(times[id], is_free(id) || is_removed(id));
    free(ranges.item);
    par_finds_free(&finds);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_equal_naive_lists),
        cmocka_unit_test(test_gaps_have_all_free_ids),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
