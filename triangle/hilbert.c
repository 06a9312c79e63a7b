/* Hilbert keys, and a radix sort by them.
 *
 * The key walks down the quadtree from the largest cell; a state of four orientations says how the curve runs through
 * the four quadrants (table below). */
#include "triangle/hilbert.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { BITS = 31, DIGIT = 11, BUCKETS = 1 << DIGIT };

struct keyed {
    uint64_t key;
    int32_t index;
};

/* Two levels in one step: [orientation][4 * two bits of x + two bits of y] is 4 * (ranks of the two quadrants on the
 * curve, 2 bits each) + the orientation inside. It follows from one level: in orientations 0 to 3 the quadrants 2 * x
 * bit + y bit have ranks 0132, 0312, 2310, 2130 and hold orientations 1030, 0211, 2123, 3302. */
static const uint8_t two_levels[4][16] = {
    {0, 14, 17, 20, 5, 9, 31, 24, 59, 55, 33, 36, 60, 50, 47, 40},
    {1, 4, 58, 61, 15, 8, 54, 51, 16, 30, 32, 46, 21, 25, 37, 41},
    {42, 45, 48, 62, 38, 35, 53, 57, 26, 29, 11, 7, 22, 19, 12, 2},
    {43, 39, 27, 23, 44, 34, 28, 18, 49, 52, 10, 13, 63, 56, 6, 3}};

uint64_t tri_hilbert(uint32_t x, uint32_t y)
{
    assert(x >> BITS == 0 && y >> BITS == 0);
    uint64_t key = 0;
    unsigned orientation = 1; /* one level more makes their number even: there all cells lie in quadrant 0, of rank 0 and
                                 orientation 0 */
    for (int bit = BITS - 1; bit >= 0; bit -= 2) {
        unsigned step = two_levels[orientation][4 * (x >> bit & 3) + (y >> bit & 3)];
        key = key << 4 | step >> 2;
        orientation = step & 3;
    }
    return key;
}

/* What keys are made of. */
struct keying {
    const struct tri_point *xy;
    int32_t n;
    struct tri_point low;
    double scale;
    struct keyed *out;
};

static void key_share(void *context, size_t share)
{
    const struct keying *k = context;
    struct tri_range range = tri_share(share, k->n);
    for (int32_t i = range.first; i < range.last; i++) {
        uint32_t x = (uint32_t)((k->xy[i].x - k->low.x) * k->scale), y = (uint32_t)((k->xy[i].y - k->low.y) * k->scale);
        k->out[i] = (struct keyed){tri_hilbert(x, y), i};
    }
}

static void key_points(const struct tri_point *xy, int32_t n, const struct tri_executor *executor, struct keyed *out)
{
    struct tri_point low = xy[0], high = xy[0];
    for (int32_t i = 1; i < n; i++) {
        low.x = xy[i].x < low.x ? xy[i].x : low.x;
        low.y = xy[i].y < low.y ? xy[i].y : low.y;
        high.x = xy[i].x > high.x ? xy[i].x : high.x;
        high.y = xy[i].y > high.y ? xy[i].y : high.y;
    }
    double side = high.x - low.x > high.y - low.y ? high.x - low.x : high.y - low.y;
    struct keying keying = {xy, n, low, side > 0 ? (double)((UINT32_C(1) << BITS) - 1) / side : 0, out};
    tri_execute(executor, tri_shares(n), key_share, &keying);
}

/* One stable pass; returns false, with nothing moved, where all keys agree in this digit. */
static bool radix_pass(const struct keyed *from, struct keyed *to, int32_t n, int shift)
{
    int32_t start[BUCKETS] = {0}, sum = 0;
    for (int32_t i = 0; i < n; i++)
        start[from[i].key >> shift & (BUCKETS - 1)]++;
    if (start[from[0].key >> shift & (BUCKETS - 1)] == n)
        return false;
    for (int b = 0; b < BUCKETS; b++) {
        int32_t count = start[b];
        start[b] = sum;
        sum += count;
    }
    for (int32_t i = 0; i < n; i++)
        to[start[from[i].key >> shift & (BUCKETS - 1)]++] = from[i];
    return true;
}

/* A point with its index, to order the points of one cell. */
struct placed {
    struct tri_point q;
    int32_t index;
};

static int compare_placed(const void *left, const void *right)
{
    const struct placed *a = left, *b = right;
    if (a->q.x != b->q.x)
        return a->q.x < b->q.x ? -1 : 1;
    if (a->q.y != b->q.y)
        return a->q.y < b->q.y ? -1 : 1;
    return (a->index > b->index) - (a->index < b->index);
}

static bool order_cell(const struct tri_point *xy, int32_t *order, int32_t n)
{
    struct placed *cell = malloc((size_t)n * sizeof *cell);
    if (!cell)
        return false;
    for (int32_t i = 0; i < n; i++)
        cell[i] = (struct placed){xy[order[i]], order[i]};
    qsort(cell, (size_t)n, sizeof *cell, compare_placed);
    for (int32_t i = 0; i < n; i++)
        order[i] = cell[i].index;
    free(cell);
    return true;
}

static bool emit_order(const struct tri_point *xy, const struct keyed *sorted, int32_t n, int32_t *order)
{
    for (int32_t i = 0; i < n; i++)
        order[i] = sorted[i].index;
    for (int32_t first = 0, end; first < n; first = end) {
        for (end = first + 1; end < n && sorted[end].key == sorted[first].key;)
            end++;
        if (end - first > 1 && !order_cell(xy, order + first, end - first))
            return false;
    }
    return true;
}

enum tri_status tri_hilbert_order(const struct tri_point *xy, int32_t n, int32_t *order,
                                  const struct tri_executor *executor, struct tri_error *error)
{
    if (n == 0)
        return TRI_OK;
    struct keyed *from = malloc((size_t)n * sizeof *from), *to = malloc((size_t)n * sizeof *to);
    bool done = from && to;
    if (done) {
        key_points(xy, n, executor, from);
        for (int shift = 0; shift < 2 * BITS; shift += DIGIT)
            if (radix_pass(from, to, n, shift)) {
                struct keyed *swap = from;
                from = to;
                to = swap;
            }
        done = emit_order(xy, from, n, order);
    }
    free(from);
    free(to);
    return done ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d points", (int)n);
}
