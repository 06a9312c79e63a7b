/* Passes by the highest digits, in parallel, group the items into buckets that fit the cache. Each bucket is then
 * sorted from the lowest digit to the highest. Items move between two arrays, of which one must hold the result. */
#include "triangle/base/radix.h"

#include <assert.h>
#include <stdbool.h>
#include <string.h>

enum {
    DIGIT = 10,           /* maximum number of bits in a pass that sorts a bucket */
    WIDE_DIGIT = 8,       /* bits in a pass that makes buckets */
    BUCKETS = 1 << WIDE_DIGIT,
    SHARES = 16,          /* number of shares in such a pass; small, since their counts are on the stack */
    FEW = 16,             /* up to this many items for each pass saved are sorted by insertion */
    MANY = 1 << 18,       /* more items than this do not fit the cache, and are worth several tasks */
    LARGE_SHARE = 8       /* a bucket with more than 1 / LARGE_SHARE of the items is also sorted by several tasks */
};

/* Items from[0 .. n), and the array that the next pass writes to. */
struct run {
    uint64_t *from, *to; /* items, and the array for the next pass */
    int32_t n;
    int low, high; /* the bits to sort by, low .. high - 1; all items agree in higher bits */
    bool in_result;     /* from is the array for the result */
};

static void insertion_sort(const struct run *run)
{
    for (int32_t i = 1; i < run->n; i++) {
        uint64_t item = run->from[i];
        int32_t at = i;
        for (; at > 0 && run->from[at - 1] >> run->low > item >> run->low; at--)
            run->from[at] = run->from[at - 1];
        run->from[at] = item;
    }
}

static void stable_pass(struct run *run, int shift, int digit)
{
    int32_t at[1 << DIGIT], sum = 0;
    uint64_t mask = (UINT64_C(1) << digit) - 1, *other = run->to;
    memset(at, 0, (mask + 1) * sizeof *at);
    for (int32_t i = 0; i < run->n; i++)
        at[run->from[i] >> shift & mask]++;
    for (uint64_t b = 0; b <= mask; b++) {
        int32_t count = at[b];
        at[b] = sum;
        sum += count;
    }
    for (int32_t i = 0; i < run->n; i++)
        other[at[run->from[i] >> shift & mask]++] = run->from[i];
    run->to = run->from;
    run->from = other;
    run->in_result = !run->in_result;
}

/* Sorts items that fit the cache. */
static void sort_run(struct run run)
{
    int bits = run.high - run.low, passes = (bits + DIGIT - 1) / DIGIT;
    const bool is_short = run.n <= FEW * passes;
    if (is_short)
        insertion_sort(&run);
    for (int pass = 0; !is_short && pass < passes; pass++) {
        int first = bits * pass / passes, end = bits * (pass + 1) / passes;
        stable_pass(&run, run.low + first, end - first);
    }
    if (!run.in_result)
        memcpy(run.to, run.from, (size_t)run.n * sizeof *run.from);
}

/* A pass over many items, divided into shares. */
struct wide_pass {
    const struct run *run;
    int shift;                   /* number of bits below the digit */
    uint64_t mask;               /* bits of the digit after shifting */
    int32_t at[SHARES][BUCKETS]; /* where the next item of each share and bucket goes */
};

static void count_share(void *context, size_t share)
{
    struct wide_pass *pass = context;
    struct tri_range range = tri_share_of(share, SHARES, pass->run->n);
    for (int32_t i = range.first; i < range.last; i++)
        pass->at[share][pass->run->from[i] >> pass->shift & pass->mask]++;
}

static void move_share(void *context, size_t share)
{
    struct wide_pass *pass = context;
    struct tri_range range = tri_share_of(share, SHARES, pass->run->n);
    for (int32_t i = range.first; i < range.last; i++) {
        uint64_t item = pass->run->from[i];
        pass->run->to[pass->at[share][item >> pass->shift & pass->mask]++] = item;
    }
}

/* Moves the items of the run into buckets; end[b] is the end of bucket b. This is a separate function because its frame
 * is large and the sort is recursive. */
static void fill_buckets(const struct run *run, int shift, int32_t end[BUCKETS], const struct tri_executor *executor)
{
    struct wide_pass pass = {.run = run, .shift = shift, .mask = (UINT64_C(1) << (run->high - shift)) - 1};
    int32_t sum = 0;
    tri_execute(executor, SHARES, count_share, &pass);
    for (int b = 0; b < BUCKETS; b++) {
        for (size_t share = 0; share < SHARES; share++) {
            int32_t count = pass.at[share][b];
            pass.at[share][b] = sum;
            sum += count;
        }
        end[b] = sum;
    }
    assert(sum == run->n);
    tri_execute(executor, SHARES, move_share, &pass);
}

/* A run whose items have been moved into buckets. */
struct bucketed {
    const struct run *run;
    int shift;            /* number of bits below the digit, by which buckets are not sorted yet */
    int32_t end[BUCKETS]; /* where each bucket ends */
};

static struct run bucket_run(const struct bucketed *b, size_t bucket)
{
    int32_t first = bucket ? b->end[bucket - 1] : 0;
    return (struct run){b->run->to + first, b->run->from + first, b->end[bucket] - first,
                        b->run->low, b->shift, !b->run->in_result};
}

static bool is_large(const struct bucketed *b, const struct run *bucket)
{
    return bucket->n > MANY && bucket->n > b->run->n / LARGE_SHARE;
}

static void sort_recursively(struct run run, const struct tri_executor *executor);

static void sort_bucket(void *context, size_t bucket)
{
    struct run run = bucket_run(context, bucket);
    if (!is_large(context, &run))
        sort_recursively(run, NULL);
}

/* Sorts small buckets in parallel, then the large buckets one after another, each with all threads. */
static void sort_recursively(struct run run, const struct tri_executor *executor)
{
    if (run.n <= MANY || run.high == run.low) {
        sort_run(run);
        return;
    }
    int bits = run.high - run.low;
    struct bucketed b = {.run = &run, .shift = run.high - (bits < WIDE_DIGIT ? bits : WIDE_DIGIT)};
    fill_buckets(&run, b.shift, b.end, executor);
    tri_execute(executor, BUCKETS, sort_bucket, &b);
    for (size_t bucket = 0; bucket < BUCKETS; bucket++) {
        struct run part = bucket_run(&b, bucket);
        if (is_large(&b, &part))
            sort_recursively(part, executor);
    }
}

void tri_radix_sort(uint64_t *items, uint64_t *scratch, int32_t n, int low, int high,
                    const struct tri_executor *executor)
{
    assert(0 <= low && low < high && high <= 64);
    sort_recursively((struct run){items, scratch, n, low, high, true}, executor);
}
