/* Lists of ids that shares have found, row by row, compared with a naive list; and runs of ids. */
#include "sched/tiles/finds.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

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

/* Ids 0 .. 7, 20 .. 22, 30 .. 39: the second run is too short and is discarded. */
static void test_runs(void **state)
{
    (void)state;
    struct par_ids list = {0};
    struct par_ranges ranges = {0};
    for (int32_t id = 0; id < 40; id++)
        if (id < 8 || (id >= 20 && id < 23) || id >= 30)
            assert_true(par_ids_add(&list, id));
    par_finds_to_runs(&list);
    assert_true(par_finds_add_runs(&list, &ranges));
    assert_int_equal(ranges.n, 2);
    assert_true(ranges.item[0].next == 0 && ranges.item[0].end == 8);
    assert_true(ranges.item[1].next == 30 && ranges.item[1].end == 40);
    free(list.item);
    free(ranges.item);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_rows_equal_naive_lists),
        cmocka_unit_test(test_runs),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
