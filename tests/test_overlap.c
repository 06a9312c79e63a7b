/* Pieces that overlap on one line: which elementary pieces are left, whose they are, and how many. */
#include <stdlib.h>
#include <string.h>

#include "support.h"
#include "triangle/overlap.h"

enum { N_LINES = 4, ON_LINE = 24, N_POINTS = N_LINES * ON_LINE, MOST = 60 };

static bool is_no_edge(void *context, const struct tri_piece *piece)
{
    (void)context;
    (void)piece;
    return false;
}

/* Points of lines far from each other in random directions, multiples of which are exact. */
static void lay_points(struct support_random *random, struct tri_point *xy)
{
    for (int line = 0; line < N_LINES; line++) {
        double x = support_below(random, 1000), y = support_below(random, 1000) + 4000 * line;
        double dx = support_below(random, 7) - 3, dy = support_below(random, 3) - 1;
        dx = dx == 0 && dy == 0 ? 1 : dx;
        for (int i = 0; i < ON_LINE; i++)
            xy[line * ON_LINE + i] = (struct tri_point){0.125 * (x + i * dx), 0.125 * (y + i * dy)};
    }
}

static int32_t draw_pieces(struct support_random *random, struct tri_piece *piece)
{
    int32_t n = 1 + support_below(random, MOST - 1);
    for (int32_t k = 0; k < n; k++) {
        int32_t line = ON_LINE * support_below(random, N_LINES), a = support_below(random, ON_LINE);
        int32_t length = 1 + support_below(random, support_below(random, 3) ? 3 : ON_LINE - 1);
        piece[k] = (struct tri_piece){line + a, line + (a + length) % ON_LINE,
                                      {k, support_below(random, 2) ? k : TRI_NONE, true}};
    }
    return n;
}

/* Who runs along each unit of each line, by looking at all. */
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

static void test_each_elementary_piece_once(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 3000; seed++) {
        struct support_random random = {seed};
        struct tri_point xy[N_POINTS];
        struct tri_mesh mesh = {.xy = xy, .n_vertices = N_POINTS};
        struct tri_piece *piece = malloc(MOST * sizeof *piece);
        struct tri_course expected[N_POINTS], found[N_POINTS];
        int32_t given[N_POINTS], times[N_POINTS];
        assert_non_null(piece);
        lay_points(&random, xy);
        int32_t n = draw_pieces(&random, piece), n_given = n;
        paint_units(piece, n, expected, given);
        assert_true(tri_share_overlaps(&mesh, &piece, &n, is_no_edge, NULL));
        paint_units(piece, n, found, times);
        for (int32_t u = 0; u < N_POINTS; u++) {
            assert_int_equal(times[u], given[u] > 0);
            assert_int_equal(found[u].first, expected[u].first);
            assert_int_equal(found[u].marked, expected[u].marked);
            assert_int_equal(found[u].odd, expected[u].odd);
        }
        assert_true(n < 2 * n_given);
        for (int32_t k = 1; k < n; k++)
            assert_true(piece[k - 1].course.first <= piece[k].course.first);
        free(piece);
    }
}

/* A path through the points of a line in random order: its pieces reach over a third of the line each, and what is
 * left of them is one piece between neighbours. */
static void test_long_overlaps_are_short_work(void **state)
{
    (void)state;
    enum { N = 20000 };
    struct support_random random = {7};
    struct tri_point *xy = malloc(N * sizeof *xy);
    struct tri_piece *piece = malloc(N * sizeof *piece);
    assert_true(xy && piece);
    for (int32_t i = 0; i < N; i++)
        xy[i] = (struct tri_point){3.0 * i, 0.25 * i};
    for (int32_t i = N - 1; i > 0; i--) {
        int32_t j = support_below(&random, i + 1);
        struct tri_point kept = xy[i];
        xy[i] = xy[j];
        xy[j] = kept;
    }
    for (int32_t k = 0; k < N - 1; k++)
        piece[k] = (struct tri_piece){k, k + 1, {k, TRI_NONE, true}};
    int32_t n = N - 1;
    struct tri_mesh mesh = {.xy = xy, .n_vertices = N};
    assert_true(tri_share_overlaps(&mesh, &piece, &n, is_no_edge, NULL));
    assert_int_equal(n, N - 1);
    for (int32_t k = 0; k < n; k++)
        assert_true(xy[piece[k].to].x - xy[piece[k].from].x == 3);
    free(xy);
    free(piece);
}

/* Parallel lines an ulp apart, and directions an ulp apart, are not the same line. */
static void test_an_ulp_apart_is_apart(void **state)
{
    (void)state;
    struct tri_point xy[] = {{0, 1}, {3, 1}, {1, 1 + 0x1p-52}, {4, 1 + 0x1p-52}, {2, 1}, {5, 1 - 0x1p-53}};
    struct tri_piece *piece = malloc(3 * sizeof *piece);
    int32_t n = 3;
    assert_non_null(piece);
    for (int32_t k = 0; k < n; k++)
        piece[k] = (struct tri_piece){2 * k, 2 * k + 1, {k, TRI_NONE, true}};
    struct tri_mesh mesh = {.xy = xy, .n_vertices = 6};
    assert_true(tri_share_overlaps(&mesh, &piece, &n, is_no_edge, NULL));
    assert_int_equal(n, 3);
    for (int32_t k = 0; k < n; k++)
        assert_true(piece[k].from == 2 * k && piece[k].to == 2 * k + 1);
    free(piece);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_elementary_piece_once),
        cmocka_unit_test(test_long_overlaps_are_short_work),
        cmocka_unit_test(test_an_ulp_apart_is_apart),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
