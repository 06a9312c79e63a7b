/* Things dealt to tiles, by a counting sort in shares: how many of each tile there are in each share of where things
 * are now, then where the next one goes. So shares are tasks, and things of one tile keep their order. */
#ifndef SCHED_SCHEDULE_DEAL_H
#define SCHED_SCHEDULE_DEAL_H

#include <stdbool.h>

#include "triangle/base/executor.h"

struct par_deal {
    int32_t *at;         /* [shares][n_tiles] */
    int32_t *start;      /* [n_tiles + 1] where the things of each tile begin, once they have been added up */
    size_t shares;
    int32_t n_tiles;
    int32_t n;           /* things, those among them that no tile gets */
};

/* Counts are 0. False: no memory; par_deal_free is to be called in any case. */
bool par_deal_reserve(struct par_deal *deal, int32_t n, int32_t n_tiles);
void par_deal_free(struct par_deal *deal);

/* The things of a share, and its counts, one for each tile. */
static inline struct tri_range par_deal_share(const struct par_deal *deal, size_t share)
{
    return tri_share_of(share, deal->shares, deal->n);
}

static inline int32_t *par_deal_at(const struct par_deal *deal, size_t share)
{
    return deal->at + share * (size_t)deal->n_tiles;
}

/* at[shares][n_tiles], counts, become places: tile by tile, in each share by share; start[n_tiles + 1], where each tile
 * begins. Returns the sum. */
int32_t par_add_up_counts(int32_t *at, size_t shares, int32_t n_tiles, int32_t *start);

/* The same with the counts of a deal: how many things tiles get. */
int32_t par_deal_add_up(struct par_deal *deal);

/* Calls work once for each tile, on any threads; room serves one call at a time, and holds two items for each of the
 * tile's things. `room` altogether: two items for each of deal->n things.
 *
 * Tiles are taken one by one by as many hands as there is room for, each for the largest tile: where one tile holds
 * nearly all, by a single one, which takes about twice the time of that tile at most. Where there are more hands than
 * threads, those that come first do all the work, and their room stays in the cache. */
void par_deal_work(const struct par_deal *deal, const struct tri_executor *executor, uint64_t *room,
                   void (*work)(const void *context, size_t tile, uint64_t *room), const void *context);

#endif
