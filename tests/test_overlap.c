/* Overlapping pieces: which elementary pieces are left, which input pieces cover each, and how many there are. */
#include <stdlib.h>
#include <string.h>

#include "support.h"
#include "triangle/cdt/bundle.h"

enum { N_POINTS = 24, MOST = 60 };

static int32_t draw_pieces(struct support_random *random, struct tri_piece *piece, int32_t (*reach)[2])
{
    int32_t n = 1 + support_below(random, MOST - 1);
    for (int32_t k = 0; k < n; k++) {
        int32_t a = support_below(random, N_POINTS - 1), b = a + 1 + support_below(random, N_POINTS - 1 - a);
        bool turned = support_below(random, 2), marked = support_below(random, 2);
        piece[k] = (struct tri_piece){turned ? b : a, turned ? a : b, {k, marked ? k : TRI_NONE, true}};
        reach[k][0] = a;
        reach[k][1] = b;
    }
    return n;
}

/* Finds the pieces that cover each unit of each line, by brute force. */
static void paint_units(const struct tri_piece *piece, int32_t n, struct tri_course *unit, int32_t *times)
{
    for (int32_t u = 0; u < N_POINTS; u++)
        unit[u] = (struct tri_course){TRI_NONE, TRI_NONE, false}, times[u] = 0;
    for (int32_t k = 0; k < n; k++) {
        int32_t a = piece[k].from, b = piece[k].to;
        for (int32_t u = a < b ? a : b; u < (a < b ? b : a); u++) {
            if (unit[u].first == TRI_NONE || piece[k].course.first < unit[u].first)
                unit[u].first = piece[k].course.first;
            if (piece[k].course.marked != TRI_NONE &&
                (unit[u].marked == TRI_NONE || piece[k].course.marked < unit[u].marked))
                unit[u].marked = piece[k].course.marked;
            unit[u].odd ^= piece[k].course.odd;
            times[u]++;
        }
    }
}

static void test_each_elementary_piece_is_listed_once(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 3000; seed++) {
        struct support_random random = {seed};
        struct tri_piece *piece = malloc(MOST * sizeof *piece);
        struct tri_course expected[N_POINTS], found[N_POINTS];
        int32_t given[N_POINTS], times[N_POINTS], stop[N_POINTS], reach[MOST][2];
        assert_non_null(piece);
        for (int32_t i = 0; i < N_POINTS; i++)
            stop[i] = i;
        int32_t n = draw_pieces(&random, piece, reach);
        paint_units(piece, n, expected, given);
        assert_true(tri_share_stops(stop, N_POINTS, reach, &piece, &n));
        paint_units(piece, n, found, times);
        for (int32_t u = 0; u < N_POINTS; u++) {
            assert_int_equal(times[u], given[u] > 0);
            assert_int_equal(found[u].first, expected[u].first);
            assert_int_equal(found[u].marked, expected[u].marked);
            assert_int_equal(found[u].odd, expected[u].odd);
        }
        for (int32_t k = 0; k < n; k++)
            assert_int_equal(abs(piece[k].from - piece[k].to), 1);
        free(piece);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_elementary_piece_is_listed_once),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
