#include "sched/schedule/deal.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>

/* Limits the number of shares so that the table of counts is not larger than the items that are dealt. */
bool par_deal_reserve(struct par_deal *deal, int32_t n, int32_t n_tiles)
{
    size_t most = (size_t)n / ((size_t)n_tiles + 1) + 1, shares = tri_shares(n);
    *deal = (struct par_deal){.n = n, .n_tiles = n_tiles, .shares = shares < most ? shares : most};
    deal->at = calloc(deal->shares * (size_t)n_tiles, sizeof *deal->at);
    deal->start = malloc(((size_t)n_tiles + 1) * sizeof *deal->start);
    return deal->at && deal->start;
}

void par_deal_free(struct par_deal *deal)
{
    free(deal->at);
    free(deal->start);
    *deal = (struct par_deal){0};
}

int32_t par_add_up_counts(int32_t *at, size_t shares, int32_t n_tiles, int32_t *start)
{
    int32_t sum = 0;
    for (int32_t tile = 0; tile < n_tiles; tile++) {
        start[tile] = sum;
        for (size_t share = 0; share < shares; share++) {
            /* Replace the count by the place of the share's first item of this tile. */
            int32_t *here = &at[share * (size_t)n_tiles + (size_t)tile], count = *here;
            *here = sum;
            sum += count;
        }
    }
    start[n_tiles] = sum;
    return sum;
}

int32_t par_deal_add_up(struct par_deal *deal)
{
    int32_t sum = par_add_up_counts(deal->at, deal->shares, deal->n_tiles, deal->start);
    assert(sum <= deal->n);
    return sum;
}

/* The workers that process tiles. */
struct hands {
    void (*work)(const void *context, size_t tile, uint64_t *room); /* called for each tile */
    const void *context; /* passed to work */
    size_t n_tiles;      /* number of tiles */
    uint64_t *room;      /* [workers][each] scratch memory */
    size_t each;         /* items of scratch memory for one worker: two for each item of the largest tile */
    atomic_size_t next;  /* next tile that no worker has begun */
};

/* A worker: fetches the next tile and processes it, until no tile is left. */
static void process_tiles(void *context, size_t hand)
{
    struct hands *h = context;
    for (size_t tile; (tile = atomic_fetch_add(&h->next, 1)) < h->n_tiles;)
        h->work(h->context, tile, h->room + hand * h->each);
}

/* Returns the number of items of the largest tile, at least 1. */
static int32_t largest_tile(const struct par_deal *deal)
{
    int32_t largest = 1;
    for (int32_t tile = 0; tile < deal->n_tiles; tile++) {
        int32_t count = deal->start[tile + 1] - deal->start[tile];
        largest = count > largest ? count : largest;
    }
    return largest;
}

void par_deal_work(const struct par_deal *deal, const struct tri_executor *executor, uint64_t *room,
                   void (*work)(const void *context, size_t tile, uint64_t *room), const void *context)
{
    const size_t n_tiles = (size_t)deal->n_tiles, largest = (size_t)largest_tile(deal);
    /* The scratch memory suffices for this many workers. */
    const size_t most = (size_t)deal->n / largest;
    struct hands hands = {work, context, n_tiles, room, 2 * largest, 0};
    tri_execute(executor, most < n_tiles ? most : n_tiles, process_tiles, &hands);
}
