/* Which of many items can win at a place: those lists are made once, for the cells of a quadtree. */
#ifndef TRIANGLE_SIZE_CANDIDATES_H
#define TRIANGLE_SIZE_CANDIDATES_H

#include "triangle/base/status.h"
#include "triangle/size/quadtree.h"

/* The item with the least key at a place wins there; of several the first. */
struct tri_contest {
    /* The key of an item at a place, and by how much it changes at most for a distance of 1. */
    double (*key)(const void *user, int32_t item, struct tri_point p, double *slope);
    /* By how much may keys be too large in a cell with this side, about a place where this is the winner, and its key?
     * 0: not at all; so it should be in cells that are not small against what is asked for. */
    double (*allowed)(const void *user, int32_t winner, struct tri_point centre, double key, double side);
    const void *user;
};

struct tri_candidates {
    struct tri_quadtree tree; /* the number of a leaf is where its list begins */
    int32_t *list;            /* [n] how many items, and then these, in their order */
    int32_t n, capacity;
};

/* The lists of n >= 1 items for places in a box; for others they are those of the nearest place in it. In about
 * n log n; asks `stop`. TRI_NO_MEMORY, TRI_STOPPED: *candidates is empty. */
enum tri_status tri_candidates_make(struct tri_candidates *candidates, const struct tri_contest *contest, int32_t n,
                                    struct tri_point low, struct tri_point high, const struct tri_stop *stop,
                                    struct tri_error *error);
void tri_candidates_clear(struct tri_candidates *candidates);

/* The items that can win at a place, *n >= 1 of them. */
static inline const int32_t *tri_candidates_at(const struct tri_candidates *candidates, struct tri_point p, int32_t *n)
{
    struct tri_cell cell;
    const int32_t *list = candidates->list + tri_quadtree_find(&candidates->tree, p, &cell);
    *n = list[0];
    return list + 1;
}

#endif
