/* Who owns which tiles.
 *
 * Tiles, the boxes of the first phase, are counted column by column, rows upwards: the order in which they are handed
 * out. Every rank owns as many as every other, one behind the other; they are of about equal work. So what a rank owns
 * is a part of a column, some whole ones, and a part of another. Some ranks own nothing where there are more ranks than
 * tiles. */
#ifndef SCHED_RANKS_TERRITORY_H
#define SCHED_RANKS_TERRITORY_H

#include "sched/ranks/carrier.h"
#include "sched/schedule/partition.h"

struct par_territory {
    const struct par_partition *partition; /* of the first round */
    int rank, n_ranks;
    int32_t n_columns, n_rows; /* of tiles: number column * n_rows + row is block (2 column + 1, 2 row + 1) */
    int32_t *start;            /* [n_ranks + 1] rank p owns tiles start[p] .. start[p + 1] - 1 */
    struct par_boxes {
        struct tri_fence item[3];
    } *boxes;                  /* [n_ranks] what each owns */
};

/* False: no memory. */
bool par_territory_init(struct par_territory *territory, const struct par_partition *partition,
                        const struct par_carrier *carrier);
void par_territory_free(struct par_territory *territory);

/* The tile that holds a place. O(log tiles). */
int32_t par_tile_at(const struct par_territory *territory, struct tri_point q);

/* Who owns a place? O(log tiles). */
int par_owner_at(const struct par_territory *territory, struct tri_point q);

/* Is it this one? */
static inline bool par_owns(const struct par_territory *territory, int rank, struct tri_point q)
{
    const struct tri_fence *box = territory->boxes[rank].item;
    return tri_fence_holds(&box[1], q) || tri_fence_holds(&box[0], q) || tri_fence_holds(&box[2], q);
}

static inline bool par_is_own(const struct par_territory *territory, struct tri_point q)
{
    return par_owns(territory, territory->rank, q);
}

/* The first and the last rank that own a part of a box. False: nobody does, it is empty. O(columns). */
bool par_owners_in(const struct par_territory *territory, const struct tri_fence *box, int *first, int *last);

/* Does this rank own a part of the box? */
bool par_has_part(const struct par_territory *territory, const struct tri_fence *box, int rank);

/* The first block of a rank's tiles, as column * n_rows + row of blocks. */
int32_t par_first_block(const struct par_territory *territory, int rank);

#endif
