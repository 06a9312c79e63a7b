/* The part that is common to all carriers: agreements, and exchanges that begin with an agreement. */
#include "sched/ranks/carrier.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/base/grow.h"

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

void par_bytes_free(struct par_bytes *bytes, int n)
{
    for (int p = 0; bytes && p < n; p++) {
        free(bytes[p].at);
        bytes[p] = (struct par_bytes){0};
    }
}

/* --- one rank */

static bool gather_own(void *self, const int64_t *mine, int32_t n, int64_t *all)
{
    (void)self;
    memcpy(all, mine, (size_t)n * sizeof *all);
    return true;
}

struct par_carrier par_carrier_alone(int64_t *room)
{
    return (struct par_carrier){.n_ranks = 1, .of_each = room, .gather = gather_own};
}

/* --- agreements */

/* Records that the network has failed on this rank. Not collective: the other ranks may not notice. */
static enum tri_status out_of_touch(struct par_carrier *carrier, struct tri_error *error)
{
    carrier->ended = carrier->lost = true;
    carrier->status = TRI_INTERNAL;
    return tri_fail(error, TRI_INTERNAL, NULL, 0, "the ranks cannot reach each other");
}

enum tri_status par_ranks_no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for what ranks exchange");
}

/* Collective gather that measures the time this rank waits for the last one. */
static bool ask_all(struct par_carrier *carrier, const int64_t *mine, int32_t n, int64_t *all)
{
    double began = tri_seconds();
    bool good = carrier->gather(carrier->self, mine, n, all);
    carrier->seconds_waiting += tri_seconds() - began;
    return good;
}

/* Collective: replaces the error of each rank by that of rank `from`. The text is gathered one word at a time into
 * preallocated memory: an allocation could fail, and a rank that left early would block the others. */
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

/* Collective: gathers the status of each rank and its n <= PAR_FEW numbers. In of_each[n_ranks][PAR_ROOM], the numbers
 * follow the status. A rank that has failed sends no numbers, so `mine` may then be invalid. */
static enum tri_status agree_with(struct par_carrier *carrier, const int64_t *mine, int32_t n, enum tri_status status,
                                  struct tri_error *error)
{
    int64_t told[PAR_ROOM] = {status}, *said = carrier->of_each;
    size_t from = 0, n_ranks = (size_t)carrier->n_ranks;
    assert(carrier->rank >= 0 && carrier->rank < carrier->n_ranks && 0 <= n && n <= PAR_FEW);
    assert(carrier->ended == (carrier->status != TRI_OK));
    if (carrier->ended)
        return carrier->status;
    if (!status && n > 0)
        memcpy(told + 1, mine, (size_t)n * sizeof *mine);
    if (!ask_all(carrier, told, PAR_ROOM, said))
        return out_of_touch(carrier, error);
    while (from < n_ranks && said[from * PAR_ROOM] == TRI_OK)
        from++;
    if (from == n_ranks)
        return TRI_OK;
    carrier->ended = true;
    carrier->status = (enum tri_status)said[from * PAR_ROOM];
    share_error(carrier, (int)from, said, error);
    return carrier->status;
}

enum tri_status par_agree(struct par_carrier *carrier, enum tri_status status, struct tri_error *error)
{
    return agree_with(carrier, NULL, 0, status, error);
}

/* Adds the messages to other ranks in `out` to this rank's traffic. */
static void count(struct par_carrier *carrier, enum par_move move, const struct par_bytes *out)
{
    for (int p = 0; p < carrier->n_ranks; p++)
        if (p != carrier->rank && out[p].n > 0) {
            carrier->traffic[move].bytes += (int64_t)out[p].n;
            carrier->traffic[move].messages++;
        }
}

/* Collective: an agreement that also sets *any if any rank has data for another. */
static enum tri_status look_for_any(struct par_carrier *carrier, const struct par_bytes *out, bool *any,
                                    enum tri_status status, struct tri_error *error)
{
    int64_t mine = 0;
    for (int p = 0; p < carrier->n_ranks; p++)
        mine += p != carrier->rank && out[p].n > 0;
    status = agree_with(carrier, &mine, 1, status, error);
    *any = false;
    for (size_t p = 0; !status && p < (size_t)carrier->n_ranks; p++)
        *any = *any || carrier->of_each[p * PAR_ROOM + 1] > 0;
    return status;
}

/* Collective: exchanges the sizes of messages and allocates the receive buffers, then agrees. Sizes are exchanged
 * before any data, so that a rank without memory can report it before others send. */
static enum tri_status exchange_sizes(struct par_carrier *carrier, const struct par_bytes *out, struct par_bytes *in,
                                      struct tri_error *error)
{
    size_t n = (size_t)carrier->n_ranks;
    int64_t *from = carrier->of_each, *to = from + n;
    enum tri_status status = TRI_OK;
    _Static_assert(PAR_ROOM >= 2, "there is room for two lists");
    for (size_t p = 0; p < n; p++)
        to[p] = (int64_t)out[p].n;
    double began = tri_seconds();
    if (!carrier->deal(carrier->self, to, from))
        return out_of_touch(carrier, error);
    carrier->seconds_waiting += tri_seconds() - began;
    for (size_t p = 0; !status && p < n; p++)
        if (p != (size_t)carrier->rank && !par_bytes_reserve(&in[p], (size_t)from[p]))
            status = par_ranks_no_memory(error);
        else if (p != (size_t)carrier->rank)
            in[p].n = (size_t)from[p];
    return par_agree(carrier, status, error);
}

/* After a network failure: forgets buffers without freeing them, because the network may still access them. */
static void abandon(struct par_bytes *bytes, int n)
{
    for (int p = 0; p < n; p++)
        bytes[p] = (struct par_bytes){0};
}

enum tri_status par_swap(struct par_carrier *carrier, enum par_move move, struct par_bytes *out, struct par_bytes *in,
                         enum tri_status status, struct tri_error *error)
{
    bool any;
    status = look_for_any(carrier, out, &any, status, error);
    if (!status && any)
        status = exchange_sizes(carrier, out, in, error);
    double began = tri_seconds();
    if (!status && any && !carrier->transfer(carrier->self, out, in)) {
        status = out_of_touch(carrier, error);
        abandon(out, carrier->n_ranks);
        abandon(in, carrier->n_ranks);
    }
    carrier->seconds_moving += tri_seconds() - began;
    count(carrier, move, out);
    in[carrier->rank] = out[carrier->rank];
    out[carrier->rank] = (struct par_bytes){0};
    par_bytes_free(out, carrier->n_ranks);
    return status;
}

enum tri_status par_spread(struct par_carrier *carrier, enum par_move move, void *bytes, size_t n,
                           enum tri_status status, struct tri_error *error)
{
    status = par_agree(carrier, status, error);
    double began = tri_seconds();
    if (!status && carrier->n_ranks > 1 && !carrier->spread(carrier->self, bytes, n))
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
    const bool few = n <= PAR_FEW;
    const int64_t *said = carrier->of_each;
    status = agree_with(carrier, mine, few ? n : 0, status, error);
    for (size_t p = 0; !status && few && p < (size_t)carrier->n_ranks; p++) /* forwards: of_each may be `all` */
        memmove(all + p * (size_t)n, said + p * PAR_ROOM + 1, (size_t)n * sizeof *all);
    if (!status && !few && !ask_all(carrier, mine, n, all))
        status = out_of_touch(carrier, error);
    return status;
}

enum tri_status par_sum(struct par_carrier *carrier, const int64_t *value, int32_t n, int64_t *sum,
                        enum tri_status status, struct tri_error *error)
{
    size_t width = (size_t)n;
    int64_t *all = malloc((size_t)carrier->n_ranks * width * sizeof *all + 1);
    status = par_gather(carrier, value, n, all, status ? status : all ? TRI_OK : par_ranks_no_memory(error), error);
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
