/* Finds tiles by points and boxes, and the ranks that own tiles. No function is collective. */
#include "sched/ranks/territory.h"

#include <assert.h>
#include <stdlib.h>

static struct tri_fence box_of_tile(const struct par_territory *t, int32_t column, int32_t row)
{
    return par_fence(t->partition, 2 * column + 1, 2 * row + 1);
}

/* Computes the three boxes of a rank: its tiles in its first column, in the columns between, and in its last column.
 * Boxes without tiles are empty. */
static void find_boxes(struct par_territory *t, int rank)
{
    int32_t n = t->n_rows, start = t->start[rank], end = t->start[rank + 1], first = start / n, last = (end - 1) / n;
    struct tri_fence *box = t->boxes[rank].item;
    assert(0 <= start && start <= end);
    box[0] = box[1] = box[2] = (struct tri_fence){HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL};
    for (int32_t column = first; start < end && column <= last; column++) {
        int32_t bottom = column == first ? start % n : 0, top = column == last ? (end - 1) % n : n - 1;
        const struct tri_fence low = box_of_tile(t, column, bottom), high = box_of_tile(t, column, top);
        struct tri_fence *b = column == first ? &box[0] : column == last ? &box[2] : &box[1];
        *b = (struct tri_fence){low.x_min < b->x_min ? low.x_min : b->x_min, low.y_min, high.x_max, high.y_max};
    }
}

bool par_territory_init(struct par_territory *t, const struct par_partition *partition,
                        const struct par_carrier *carrier)
{
    int n = carrier->n_ranks;
    *t = (struct par_territory){.partition = partition, .rank = carrier->rank, .n_ranks = n,
                                .n_columns = par_tile_columns(partition), .n_rows = par_tile_rows(partition)};
    int64_t tiles = (int64_t)t->n_columns * t->n_rows;
    t->start = malloc(((size_t)n + 1) * sizeof *t->start);
    t->boxes = malloc((size_t)n * sizeof *t->boxes);
    if (!t->start || !t->boxes)
        return false;
    for (int p = 0; p <= n; p++)
        t->start[p] = carrier->share ? (int32_t)(carrier->share[p] * (double)tiles) : (int32_t)(p * tiles / n);
    assert(t->start[0] == 0 && t->start[n] == tiles);
    for (int p = 0; p < n; p++)
        find_boxes(t, p);
    return true;
}

void par_territory_free(struct par_territory *t)
{
    free(t->start);
    free(t->boxes);
    t->start = NULL;
    t->boxes = NULL;
}

static int owner_of_tile(const struct par_territory *t, int32_t tile)
{
    int rank = par_holder_of(t->start, t->n_ranks, tile);
    assert(t->start[rank] <= tile && tile < t->start[rank + 1]);
    return rank;
}

int32_t par_tile_at(const struct par_territory *t, struct tri_point q)
{
    return par_tile_of_block(t->partition, par_block_at(t->partition, 0, q));
}

int par_owner_at(const struct par_territory *t, struct tri_point q)
{
    return owner_of_tile(t, par_tile_at(t, q));
}

/* Finds the tiles of a column that the box overlaps: *first to *end - 1. False: there are none. */
static bool tiles_in(const struct par_territory *t, const struct tri_fence *box, int32_t column, int32_t *first,
                     int32_t *end)
{
    const struct tri_fence tile = box_of_tile(t, column, 0);
    int32_t row = 0;
    if (!(box->x_min < box->x_max && box->y_min < box->y_max && tile.x_min < tile.x_max && tile.x_max > box->x_min &&
          tile.x_min < box->x_max))
        return false;
    while (row < t->n_rows && !(box_of_tile(t, column, row).y_max > box->y_min))
        row++;
    *first = column * t->n_rows + row;
    while (row < t->n_rows && box_of_tile(t, column, row).y_min < box->y_max)
        row++;
    *end = column * t->n_rows + row;
    return *first < *end;
}

bool par_owners_in(const struct par_territory *t, const struct tri_fence *box, int *first, int *last)
{
    *first = *last = -1;
    for (int32_t c = 0; c < t->n_columns; c++) {
        int32_t tile, end;
        if (!tiles_in(t, box, c, &tile, &end))
            continue;
        *first = *first >= 0 ? *first : owner_of_tile(t, tile);
        *last = owner_of_tile(t, end - 1);
    }
    assert(*first <= *last && *last < t->n_ranks); /* owners ascend with tiles */
    return *first >= 0;
}

bool par_has_part(const struct par_territory *t, const struct tri_fence *box, int rank)
{
    const int32_t *own = &t->start[rank];
    int32_t tile, end;
    for (int32_t c = own[0] / t->n_rows; own[0] < own[1] && c <= (own[1] - 1) / t->n_rows; c++)
        if (tiles_in(t, box, c, &tile, &end) && tile < own[1] && end > own[0])
            return true;
    return false;
}

int32_t par_first_block(const struct par_territory *t, int rank)
{
    int32_t column = t->start[rank] / t->n_rows, row = t->start[rank] % t->n_rows;
    return (2 * column + 1) * t->partition->n_rows + 2 * row + 1;
}
