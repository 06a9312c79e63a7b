/* Items grouped by a value, for formats that list what belongs together in one block. */
#ifndef TRIANGLE_TEXT_GROUPING_H
#define TRIANGLE_TEXT_GROUPING_H

#include "triangle/mesh/grid.h"

enum { TRI_MOST_GROUPS = 1024 };

struct tri_grouping {
    int n;                                /* groups, by ascending value */
    double value[TRI_MOST_GROUPS];
    int64_t first[TRI_MOST_GROUPS + 1];   /* where each begins in `order` */
    int64_t *order;                       /* the items; NULL: as they are, in one group */
    const struct tri_storage *storage;    /* of the grid: `order` is an extra of it; NULL: it is malloc'ed */
};

/* Groups n items; more than TRI_MOST_GROUPS values, or none that is a number, make one group of value 0. TRI_NO_MEMORY.
 * To be freed in any case. O(n log groups). */
enum tri_status tri_group(struct tri_grouping *grouping, int64_t n,
                          double (*value)(const struct tri_grid *grid, int64_t i), const struct tri_grid *grid,
                          struct tri_error *error);
void tri_grouping_free(struct tri_grouping *grouping);

/* From numbers of items in n groups, first[n + 1], to the place of the first in each. */
void tri_accumulate(int64_t *first, int n);

/* Room for n items among the extras of a storage; NULL: malloc'ed. NULL and errno: there is none. */
void *tri_room(const struct tri_storage *storage, int64_t n, size_t bytes);
void tri_room_free(const struct tri_storage *storage, void *room);

/* The value as a number by which other programs know a group: 1 .. 2^31 - 1; 0 where it is no such number. */
int32_t tri_group_tag(double value);

/* Of triangle and segment i: the first attribute, and the marker; 0 where there is none. */
double tri_triangle_group(const struct tri_grid *grid, int64_t i);
double tri_segment_group(const struct tri_grid *grid, int64_t i);

static inline int64_t tri_grouped(const struct tri_grouping *grouping, int64_t place)
{
    return grouping->order ? grouping->order[place] : place;
}

#endif
