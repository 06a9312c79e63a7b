/* Points sorted along the curve: neighbours in the order are near each other in the plane. */
#include "support.h"
#include "triangle/geometry/hilbert.h"

/* Orders all n points along the curve. */
static void order_all(const struct tri_point *xy, int32_t n, int32_t *order)
{
    uint64_t *scratch = malloc((2 * (size_t)n + 1) * sizeof *scratch);
    assert_non_null(scratch);
    for (int32_t i = 0; i < n; i++)
        order[i] = i;
    tri_hilbert_order(xy, order, n, scratch, NULL);
    free(scratch);
}

static void assert_permutation(const int32_t *order, int32_t n)
{
    bool *seen = calloc((size_t)n, sizeof *seen);
    for (int32_t i = 0; i < n; i++) {
        assert_in_range(order[i], 0, n - 1);
        assert_false(seen[order[i]]);
        seen[order[i]] = true;
    }
    free(seen);
}

/* A grid of 2^bits x 2^bits points, one in each cell of that level of the curve. The curve goes from each cell to an
 * adjacent one. */
static void assert_path(int bits)
{
    const int32_t side = 1 << bits, n = side * side;
    struct tri_point *xy = malloc((size_t)n * sizeof *xy);
    int32_t *order = malloc((size_t)n * sizeof *order);
    for (int32_t i = 0; i < n; i++)
        xy[(i * 1031) % n] = (struct tri_point){i / side, i % side};
    order_all(xy, n, order);
    assert_permutation(order, n);
    for (int32_t i = 1; i < n; i++) {
        struct tri_point p = xy[order[i - 1]], q = xy[order[i]];
        assert_true(fabs(p.x - q.x) + fabs(p.y - q.y) == 1);
    }
    free(order);
    free(xy);
}

static void test_order_of_a_grid_is_a_path(void **state)
{
    (void)state;
    for (int bits = 1; bits <= 8; bits++)
        assert_path(bits);
}

static void test_equal_points_are_neighbours_in_increasing_index(void **state)
{
    (void)state;
    for (uint64_t seed = 0; seed < 20; seed++) {
        struct tri_pslg pslg = support_points(SUPPORT_LATTICE, 500, seed);
        int32_t order[500];
        const struct tri_point *xy = (const struct tri_point *)pslg.points;
        order_all(xy, 500, order);
        assert_permutation(order, 500);
        int places = 0;
        for (int i = 0; i < 500; i++) {
            bool same = i && xy[order[i]].x == xy[order[i - 1]].x && xy[order[i]].y == xy[order[i - 1]].y;
            places += !same;
            assert_true(!same || order[i] > order[i - 1]);
        }
        assert_true(places <= 36);
        tri_pslg_free(&pslg);
    }
}

/* Different points in one cell, because the box is 2^60 times larger. Equal points must still be neighbours in the
 * order. */
static void test_dense_cells_are_sorted(void **state)
{
    (void)state;
    struct tri_point xy[64];
    int32_t order[64];
    for (int i = 0; i < 63; i++)
        xy[i] = (struct tri_point){ldexp(i * 5 % 7, -60), ldexp(i % 3, -60)};
    xy[63] = (struct tri_point){1, 1};
    order_all(xy, 64, order);
    assert_permutation(order, 64);
    int places = 0;
    for (int i = 0; i < 64; i++)
        places += i == 0 || xy[order[i]].x != xy[order[i - 1]].x || xy[order[i]].y != xy[order[i - 1]].y;
    assert_int_equal(places, 22);
}

/* The order depends on the points, not on their ids: any permutation of the ids gives the same order. Squares within
 * squares, each a million times smaller, fill a cell with smaller cells. Every third point has a near neighbour,
 * usually in its cell. */
static void test_initial_order_does_not_matter(void **state)
{
    (void)state;
    enum { N = 3000 };
    struct support_random random = {3};
    struct tri_point *xy = malloc(N * sizeof *xy);
    int32_t order[N], first[N];
    uint64_t *scratch = malloc(2 * N * sizeof *scratch);
    for (int i = 0; i < N; i++) {
        double size = ldexp(1, -20 * (i % 5));
        xy[i] = (struct tri_point){size * support_unit(&random), size * support_unit(&random)};
        if (i % 3 == 0 && i >= 5)
            xy[i] = (struct tri_point){xy[i - 5].x * (1 + 0x1p-30), xy[i - 5].y};
    }
    order_all(xy, N, first);
    assert_permutation(first, N);
    for (int trial = 0; trial < 10; trial++) {
        for (int i = 0; i < N; i++)
            order[i] = i;
        for (int i = N - 1; i > 0; i--) {
            int k = support_below(&random, i + 1), swap = order[i];
            order[i] = order[k];
            order[k] = swap;
        }
        tri_hilbert_order(xy, order, N, scratch, NULL);
        assert_memory_equal(order, first, sizeof order);
    }
    double length = 0; /* points of the innermost rings have a curve of their own as well */
    int inner = 0;
    struct tri_point last = {0, 0};
    for (int i = 0; i < N; i++)
        if (first[i] % 5 == 4) {
            length += fabs(xy[first[i]].x - last.x) + fabs(xy[first[i]].y - last.y);
            last = xy[first[i]];
            inner++;
        }
    assert_true(length < 3 * ldexp(sqrt(inner), -80));
    free(scratch);
    free(xy);
}

static double length_of(const struct tri_point *xy, const int32_t *order, int32_t n)
{
    double length = 0;
    for (int32_t i = 1; i < n; i++)
        length += hypot(xy[order[i]].x - xy[order[i - 1]].x, xy[order[i]].y - xy[order[i - 1]].y);
    return length;
}

/* The coarse order does not depend on the order of the ids, and its curve is nearly as short although it has fewer
 * cells. Dense corners have a curve of their own. */
static void test_coarse_order(void **state)
{
    (void)state;
    enum { N = 20000 };
    struct support_random random = {7};
    struct tri_point *xy = malloc(N * sizeof *xy);
    int32_t *fine = malloc(N * sizeof *fine), *coarse = malloc(N * sizeof *coarse), *again = malloc(N * sizeof *again);
    uint64_t *scratch = malloc(2 * N * sizeof *scratch);
    for (int n = 1; n <= N; n = 3 * n + 1)
        for (int dense = 0; dense < 2; dense++) {
            for (int i = 0; i < n; i++) {
                double size = dense ? ldexp(1, -10 * (i % 3)) : 1;
                xy[i] = (struct tri_point){size * support_unit(&random), size * support_unit(&random)};
                coarse[i] = n - 1 - i;
                again[i] = i;
            }
            order_all(xy, n, fine);
            tri_hilbert_order_coarse(xy, coarse, n, scratch);
            tri_hilbert_order_coarse(xy, again, n, scratch);
            assert_permutation(coarse, n);
            assert_memory_equal(coarse, again, (size_t)n * sizeof *coarse);
            assert_true(length_of(xy, coarse, n) <= 1.25 * length_of(xy, fine, n) + 1);
        }
    free(xy);
    free(fine);
    free(coarse);
    free(again);
    free(scratch);
}

static void test_degenerate_boxes(void **state)
{
    (void)state;
    struct tri_point xy[5] = {{1, 2}, {1, 2}, {1, 2}, {1, 2}, {1, 2}};
    int32_t order[5];
    order_all(xy, 0, order);
    order_all(xy, 1, order);
    assert_int_equal(order[0], 0);
    order_all(xy, 5, order);
    for (int i = 0; i < 5; i++)
        assert_int_equal(order[i], i);
    for (int i = 0; i < 5; i++)
        xy[i] = (struct tri_point){i % 2 ? 0x1p200 : -0x1p200, i * 0x1p-216};
    order_all(xy, 5, order);
    assert_permutation(order, 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_order_of_a_grid_is_a_path),
        cmocka_unit_test(test_equal_points_are_neighbours_in_increasing_index),
        cmocka_unit_test(test_dense_cells_are_sorted),
        cmocka_unit_test(test_initial_order_does_not_matter),
        cmocka_unit_test(test_coarse_order),
        cmocka_unit_test(test_degenerate_boxes),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
