/* The distribution of tiles over ranks.
 *
 * Tiles are the boxes of the first phase. They are numbered column by column, rows upwards, which is also the order in
 * which they are handed out. Each rank owns a contiguous range of about the same number of tiles, because tiles need
 * about equal work. The range covers the end of one column, some whole columns, and the start of another. If there are
 * more ranks than tiles, some ranks own nothing. */
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
    } *boxes;                  /* [n_ranks] the boxes that cover a rank's tiles; unused ones are empty */
};

/* False: no memory. */
bool par_territory_init(struct par_territory *territory, const struct par_partition *partition,
                        const struct par_carrier *carrier);
void par_territory_free(struct par_territory *territory);

/* Returns the number of the tile that contains q. O(log tiles). */
int32_t par_tile_at(const struct par_territory *territory, struct tri_point q);

/* Returns the rank that owns the tile containing q. O(log tiles). */
int par_owner_at(const struct par_territory *territory, struct tri_point q);

/* Does `rank` own the tile containing q? O(1). */
static inline bool par_owns(const struct par_territory *territory, int rank, struct tri_point q)
{
    const struct tri_fence *box = territory->boxes[rank].item;
    return tri_fence_holds(&box[1], q) || tri_fence_holds(&box[0], q) || tri_fence_holds(&box[2], q);
}

static inline bool par_is_own(const struct par_territory *territory, struct tri_point q)
{
    return par_owns(territory, territory->rank, q);
}

/* Sets *first and *last to the lowest and the highest rank that own a part of the box. False: the box is empty.
 * O(columns). */
bool par_owners_in(const struct par_territory *territory, const struct tri_fence *box, int *first, int *last);

/* Does `rank` own a part of the box? */
bool par_has_part(const struct par_territory *territory, const struct tri_fence *box, int rank);

/* Returns the block of a rank's first tile, as column * n_rows + row in the grid of blocks. */
int32_t par_first_block(const struct par_territory *territory, int rank);

#endif
