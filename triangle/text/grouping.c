/* The values are listed in order, then the items are sorted by counting, so that each group keeps their order. */
#include "triangle/text/grouping.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* The first group whose value is not below. */
static int place_of(const struct tri_grouping *g, double value)
{
    int low = 0, high = g->n;
    while (low < high) {
        int middle = (low + high) / 2;
        if (g->value[middle] < value)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* False: there are too many values, or one is not a number. */
static bool count_value(struct tri_grouping *g, double value)
{
    int k = place_of(g, value);
    if (k == g->n || g->value[k] != value) {
        if (g->n == TRI_MOST_GROUPS || isnan(value))
            return false;
        memmove(&g->value[k + 1], &g->value[k], (size_t)(g->n - k) * sizeof *g->value);
        memmove(&g->first[k + 1], &g->first[k], (size_t)(g->n - k) * sizeof *g->first);
        g->value[k] = value;
        g->first[k] = 0;
        g->n++;
    }
    g->first[k]++;
    return true;
}

static void make_one(struct tri_grouping *g, int64_t n)
{
    g->n = 1;
    g->first[0] = 0;
    g->first[1] = n;
}

void tri_accumulate(int64_t *first, int n)
{
    int64_t before = 0;
    for (int k = 0; k <= n; k++) {
        const int64_t own = k < n ? first[k] : 0;
        first[k] = before;
        before += own;
    }
}

enum tri_status tri_group(struct tri_grouping *g, int64_t n, double (*value)(const struct tri_grid *grid, int64_t i),
                          const struct tri_grid *grid, struct tri_error *error)
{
    int64_t i = 0, next[TRI_MOST_GROUPS];
    g->n = 0;
    g->order = NULL;
    while (i < n && count_value(g, value(grid, i)))
        i++;
    if (i < n || n == 0)
        g->value[0] = 0;
    if (i < n || g->n <= 1) {
        make_one(g, n);
        return TRI_OK;
    }
    tri_accumulate(g->first, g->n);
    g->storage = grid->storage;
    g->order = tri_room(g->storage, n, sizeof *g->order);
    if (!g->order)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no room to group %lld items: %s", (long long)n,
                        strerror(errno));
    memcpy(next, g->first, (size_t)g->n * sizeof *next);
    for (i = 0; i < n; i++)
        g->order[next[place_of(g, value(grid, i))]++] = i;
    return TRI_OK;
}

void tri_grouping_free(struct tri_grouping *g)
{
    tri_room_free(g->storage, g->order);
    g->order = NULL;
}

void *tri_room(const struct tri_storage *storage, int64_t n, size_t bytes)
{
    const size_t all = (size_t)n * bytes;
    return storage ? storage->extra(storage->user, all) : malloc(all + 1);
}

void tri_room_free(const struct tri_storage *storage, void *room)
{
    if (room && storage)
        storage->extra_free(storage->user, room);
    else
        free(room);
}

int32_t tri_group_tag(double value)
{
    return value >= 1 && value <= INT32_MAX && value == floor(value) ? (int32_t)value : 0;
}

double tri_triangle_group(const struct tri_grid *grid, int64_t i)
{
    return grid->n_columns > 0 ? grid->column(grid->user, i, 0) : 0;
}

double tri_segment_group(const struct tri_grid *grid, int64_t i)
{
    struct tri_grid_edge segment;
    if (!grid->has_markers)
        return 0;
    grid->segment(grid->user, i, &segment);
    return segment.marker;
}
