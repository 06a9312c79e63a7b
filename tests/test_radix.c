/* Compares the radix sort with a simple stable sort, over all sizes that have a code path of their own. */
#include "full.h"
#include "support.h"
#include "triangle/base/radix.h"

struct entry {
    uint64_t key;
    int32_t at;
    uint64_t item;
};

static int by_key_then_place(const void *left, const void *right)
{
    const struct entry *a = left, *b = right;
    if (a->key != b->key)
        return a->key < b->key ? -1 : 1;
    return (a->at > b->at) - (a->at < b->at);
}

static void assert_sorts(uint64_t *items, int32_t n, int low, int high, const struct tri_executor *executor)
{
    struct entry *expected = malloc(((size_t)n + 1) * sizeof *expected);
    uint64_t *scratch = malloc(((size_t)n + 1) * sizeof *scratch);
    assert_non_null(expected);
    assert_non_null(scratch);
    for (int32_t i = 0; i < n; i++)
        expected[i] = (struct entry){items[i] >> low, i, items[i]};
    qsort(expected, (size_t)n, sizeof *expected, by_key_then_place);
    tri_radix_sort(items, scratch, n, low, high, executor);
    for (int32_t i = 0; i < n; i++)
        assert_true(items[i] == expected[i].item);
    free(expected);
    free(scratch);
}

/* Keys with a given number of bits, and the index of each below them. spread: 0 all equal .. 3 uniform, 4: nearly all
   in one bucket. */
static void fill(uint64_t *items, int32_t n, int low, int bits, int spread, struct support_random *random)
{
    uint64_t mask = bits == 64 ? UINT64_MAX : (UINT64_C(1) << bits) - 1;
    for (int32_t i = 0; i < n; i++) {
        uint64_t key = support_bits(random);
        if (spread == 4)
            key = i % 1000 == 0 ? key & mask : key & mask >> (bits / 2);
        else
            key = spread == 0 ? 5 & mask : (key & mask) >> (bits * (3 - spread) / 3);
        items[i] = key << low | ((uint64_t)i & ((UINT64_C(1) << low) - 1));
    }
}

static void test_sorts_stably(void **state)
{
    (void)state;
    static const int32_t sizes[] = {0, 1, 2, 23, 24, 25, 100, 1000, 70000, 300000};
    static const int ranges[][2] = {{0, 64}, {28, 64}, {31, 53}, {0, 1}, {3, 11}, {63, 64}};
    struct support_random random = {1};
    uint64_t *items = malloc(300000 * sizeof *items);
    assert_non_null(items);
    for (size_t s = 0; s < (is_full() ? 10 : 9); s++)
        for (size_t r = 0; r < sizeof ranges / sizeof *ranges; r++)
            for (int spread = 0; spread < 5; spread++) {
                if (sizes[s] > 1000 && r != 1 && spread != (int)r % 5)
                    continue; /* the reference sort is slow for many keys */
                fill(items, sizes[s], ranges[r][0], ranges[r][1] - ranges[r][0], spread, &random);
                assert_sorts(items, sizes[s], ranges[r][0], ranges[r][1], spread % 2 ? &support_backwards : NULL);
            }
    free(items);
}

/* So many keys that even the buckets of the first pass exceed a cache. The index below the key increases, so stably
   sorted items increase as well. */
static void test_sorts_millions(void **state)
{
    (void)state;
    enum { N = 2700000 };
    struct support_random random = {2};
    uint64_t *items = malloc(2 * (size_t)N * sizeof *items), sum = 0;
    assert_non_null(items);
    for (int32_t i = 0; i < N; i++) {
        items[i] = (uint64_t)support_below(&random, 9) << 56 | support_bits(&random) >> 36 << 28 | (uint64_t)i;
        sum += items[i];
    }
    tri_radix_sort(items, items + N, N, 28, 64, &support_backwards);
    for (int32_t i = 0; i < N; i++) {
        assert_true(i == 0 || items[i - 1] < items[i]);
        sum -= items[i];
    }
    assert_true(sum == 0);
    free(items);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_sorts_stably), cmocka_unit_test(test_sorts_millions)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
