/* What all carriers have in common: agreements, and exchanges that begin with one. */
#include "sched/ranks/carrier.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/clock.h"
#include "triangle/grow.h"

bool par_bytes_reserve(struct par_bytes *bytes, size_t more)
{
    assert(bytes->n <= bytes->capacity);
    if (bytes->n + more <= bytes->capacity)
        return true;
    size_t capacity = bytes->n + more + bytes->capacity / 2;
    if (!tri_resize(&bytes->at, capacity, 1))
        return false;
    bytes->capacity = capacity;
    return true;
}

bool par_bytes_add(struct par_bytes *bytes, const void *item, size_t n)
{
    if (!par_bytes_reserve(bytes, n))
        return false;
    if (n > 0)
        memcpy(bytes->at + bytes->n, item, n);
    bytes->n += n;
    return true;
}

/* --- one rank */

static bool gather_own(void *self, const int64_t *mine, int32_t n, int64_t *all)
{
    (void)self;
    memcpy(all, mine, (size_t)n * sizeof *all);
    return true;
}

static bool deal_own(void *self, const int64_t *to, int64_t *from) { return gather_own(self, to, 1, from); }

static bool transfer_nothing(void *self, const struct par_bytes *out, const struct par_bytes *in)
{
    (void)self, (void)out, (void)in;
    return true;
}

static bool spread_to_none(void *self, void *bytes, size_t n)
{
    (void)self, (void)bytes, (void)n;
    return true;
}

struct par_carrier par_carrier_alone(int64_t *room)
{
    return (struct par_carrier){.n_ranks = 1, .of_each = room, .gather = gather_own, .deal = deal_own,
                                .transfer = transfer_nothing, .spread = spread_to_none};
}

/* --- agreements */

static enum tri_status out_of_touch(struct par_carrier *carrier, struct tri_error *error)
{
    carrier->ended = carrier->lost = true;
    carrier->status = TRI_INTERNAL;
    return tri_fail(error, TRI_INTERNAL, NULL, 0, "the ranks cannot reach each other");
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for what ranks exchange");
}

/* Whoever comes first waits here for the last. */
static bool ask_all(struct par_carrier *carrier, const int64_t *mine, int32_t n, int64_t *all)
{
    double began = tri_seconds();
    bool good = carrier->gather(carrier->self, mine, n, all);
    carrier->seconds_waiting += tri_seconds() - began;
    return good;
}

/* The lowest rank's that has an error, or -1. `all` has room for a number of each rank. */
static int first_to_fail(struct par_carrier *carrier, enum tri_status status, int64_t *all)
{
    int64_t mine = status;
    if (!ask_all(carrier, &mine, 1, all))
        return -2;
    for (int p = 0; p < carrier->n_ranks; p++)
        if (all[p] != TRI_OK)
            return p;
    return -1;
}

/* Everybody's error becomes that of one rank. Word by word: no memory may be left, and whoever stayed away would be
 * waited for. */
static void share_error(struct par_carrier *carrier, int from, int64_t *all, struct tri_error *error)
{
    enum { WORDS = sizeof(struct tri_error) / sizeof(int64_t) + 1 };
    int64_t word[WORDS] = {0};
    struct tri_error own = {0};
    error = error ? error : &own;
    memcpy(word, error, sizeof *error);
    for (int k = 0; k < WORDS; k++) {
        if (!ask_all(carrier, &word[k], 1, all))
            return;
        word[k] = all[from];
    }
    memcpy(error, word, sizeof *error);
}

enum tri_status par_agree(struct par_carrier *carrier, enum tri_status status, struct tri_error *error)
{
    assert(carrier->rank >= 0 && carrier->rank < carrier->n_ranks);
    assert(carrier->ended == (carrier->status != TRI_OK));
    if (carrier->ended)
        return carrier->status;
    int from = first_to_fail(carrier, status, carrier->of_each);
    enum tri_status agreed = from >= 0 ? (enum tri_status)carrier->of_each[from] : TRI_OK;
    if (agreed) {
        share_error(carrier, from, carrier->of_each, error);
        carrier->ended = true;
        carrier->status = agreed;
    }
    return from == -2 ? out_of_touch(carrier, error) : agreed;
}

static void free_all(struct par_bytes *bytes, int n)
{
    for (int p = 0; p < n; p++) {
        free(bytes[p].at);
        bytes[p] = (struct par_bytes){0};
    }
}

static void count(struct par_carrier *carrier, enum par_move move, const struct par_bytes *out)
{
    for (int p = 0; p < carrier->n_ranks; p++)
        if (p != carrier->rank && out[p].n > 0) {
            carrier->traffic[move].bytes += (int64_t)out[p].n;
            carrier->traffic[move].messages++;
        }
}

/* Sizes are known before anything is sent, so that who has no memory for it can say so. */
static enum tri_status prepare(struct par_carrier *carrier, const struct par_bytes *out, struct par_bytes *in,
                               struct tri_error *error)
{
    size_t n = (size_t)carrier->n_ranks;
    int64_t *size = calloc(2 * n, sizeof *size);
    enum tri_status status = par_agree(carrier, size ? TRI_OK : no_memory(error), error);
    for (size_t p = 0; !status && p < n; p++)
        size[p] = (int64_t)out[p].n;
    if (!status && !carrier->deal(carrier->self, size, size + n))
        status = out_of_touch(carrier, error);
    for (size_t p = 0; !status && p < n; p++)
        if (p != (size_t)carrier->rank && !par_bytes_reserve(&in[p], (size_t)size[n + p]))
            status = no_memory(error);
        else if (p != (size_t)carrier->rank)
            in[p].n = (size_t)size[n + p];
    free(size);
    return par_agree(carrier, status, error);
}

/* What a network that has failed may still read or write is never freed. */
static void abandon(struct par_bytes *bytes, int n)
{
    for (int p = 0; p < n; p++)
        bytes[p] = (struct par_bytes){0};
}

enum tri_status par_swap(struct par_carrier *carrier, enum par_move move, struct par_bytes *out, struct par_bytes *in,
                         enum tri_status status, struct tri_error *error)
{
    status = par_agree(carrier, status, error);
    status = status ? status : prepare(carrier, out, in, error);
    double began = tri_seconds();
    if (!status && !carrier->transfer(carrier->self, out, in)) {
        status = out_of_touch(carrier, error);
        abandon(out, carrier->n_ranks);
        abandon(in, carrier->n_ranks);
    }
    carrier->seconds_moving += tri_seconds() - began;
    count(carrier, move, out);
    in[carrier->rank] = out[carrier->rank];
    out[carrier->rank] = (struct par_bytes){0};
    free_all(out, carrier->n_ranks);
    return status;
}

enum tri_status par_spread(struct par_carrier *carrier, enum par_move move, void *bytes, size_t n,
                           enum tri_status status, struct tri_error *error)
{
    status = par_agree(carrier, status, error);
    double began = tri_seconds();
    if (!status && !carrier->spread(carrier->self, bytes, n))
        status = out_of_touch(carrier, error);
    carrier->seconds_moving += tri_seconds() - began;
    if (!status && carrier->rank == 0 && n > 0) {
        carrier->traffic[move].bytes += (int64_t)n * (carrier->n_ranks - 1);
        carrier->traffic[move].messages += carrier->n_ranks - 1;
    }
    return status;
}

enum tri_status par_gather(struct par_carrier *carrier, const int64_t *mine, int32_t n, int64_t *all,
                           enum tri_status status, struct tri_error *error)
{
    status = par_agree(carrier, status, error);
    if (!status && !ask_all(carrier, mine, n, all))
        status = out_of_touch(carrier, error);
    return status;
}

enum tri_status par_sum(struct par_carrier *carrier, const int64_t *value, int32_t n, int64_t *sum,
                        enum tri_status status, struct tri_error *error)
{
    size_t width = (size_t)n;
    int64_t *all = malloc((size_t)carrier->n_ranks * width * sizeof *all + 1);
    status = par_gather(carrier, value, n, all, status ? status : all ? TRI_OK : no_memory(error), error);
    for (size_t i = 0; i < width; i++) {
        sum[i] = 0;
        for (size_t p = 0; !status && p < (size_t)carrier->n_ranks; p++)
            sum[i] += all[p * width + i];
    }
    free(all);
    return status;
}

enum tri_status par_expect_same(struct par_carrier *carrier, uint64_t number, const char *words, enum tri_status status,
                                struct tri_error *error)
{
    const int64_t mine = (int64_t)number;
    status = par_gather(carrier, &mine, 1, carrier->of_each, status, error);
    for (int p = 1; !status && p < carrier->n_ranks; p++)
        if (carrier->of_each[p] != carrier->of_each[0])
            status = tri_fail(error, TRI_BAD_INPUT, NULL, 0, "%s", words);
    return status;
}
