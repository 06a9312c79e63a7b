/* Deals items to tiles by a counting sort that runs in parallel. The items are divided into shares in their current
 * order. First each share counts its items by tile; then the counts become the places at which each share writes its
 * next item of each tile. Shares run as tasks, and items of the same tile keep their order. */
#ifndef SCHED_SCHEDULE_DEAL_H
#define SCHED_SCHEDULE_DEAL_H

#include <stdbool.h>

#include "triangle/base/executor.h"

struct par_deal {
    int32_t *at;     /* [shares][n_tiles] counts; after par_deal_add_up: index of the share's next item in the tile */
    int32_t *start;  /* [n_tiles + 1] index of the first item of each tile; set by par_deal_add_up */
    size_t shares;   /* number of shares */
    int32_t n_tiles; /* number of tiles */
    int32_t n;       /* number of items, including those that belong to no tile */
};

/* Prepares a deal of n items to n_tiles tiles, with all counts 0. False: no memory. Call par_deal_free in either
 * case. */
bool par_deal_reserve(struct par_deal *deal, int32_t n, int32_t n_tiles);
void par_deal_free(struct par_deal *deal);

/* Return the range of items of a share, and its row of counts, one for each tile. */
static inline struct tri_range par_deal_share(const struct par_deal *deal, size_t share)
{
    return tri_share_of(share, deal->shares, deal->n);
}

static inline int32_t *par_deal_at(const struct par_deal *deal, size_t share)
{
    return deal->at + share * (size_t)deal->n_tiles;
}

/* Turns the counts at[shares][n_tiles] into places, ordered by tile and then by share. start[n_tiles + 1] receives
 * the index of the first item of each tile. Returns the sum of all counts. */
int32_t par_add_up_counts(int32_t *at, size_t shares, int32_t n_tiles, int32_t *start);

/* Does the same for the counts of a deal. Returns the number of items that belong to a tile. */
int32_t par_deal_add_up(struct par_deal *deal);

/* Calls work once for each tile, on any thread. Each call may use `room` as scratch memory, two items for each item of
 * its tile. The argument room is all of it: two items for each of the deal->n items.
 *
 * Workers process the tiles one by one. Each worker has room for the largest tile, so there are as many workers as fit
 * into room: only one if a single tile holds nearly all items, which then takes about twice the time of that tile at
 * most. If there are more workers than threads, those that start first do all the work, and their room stays in the
 * cache. */
void par_deal_work(const struct par_deal *deal, const struct tri_executor *executor, uint64_t *room,
                   void (*work)(const void *context, size_t tile, uint64_t *room), const void *context);

#endif
