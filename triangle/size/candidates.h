/* Which of many items can win at a place: those lists are made once, for the cells of a quadtree. */
#ifndef TRIANGLE_SIZE_CANDIDATES_H
#define TRIANGLE_SIZE_CANDIDATES_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quadtree.h"

/* What is known of an item about a place p: q from there, its key is at least value + gradient * q, as of a convex
 * function, and at most value + slope * |q|, and value + gradient * q + bend * |q|^2. */
struct tri_key {
    double value, slope, bend; /* bend may be infinite */
    struct tri_point gradient;
};

/* Of a key that is `length` more than `growth` times the distance from a convex set, whose nearest place is `away`. */
static inline struct tri_key tri_key_of_distance(double length, double growth, struct tri_point away)
{
    const double d = sqrt(away.x * away.x + away.y * away.y), steep = d > 0 ? growth / d : 0;
    return (struct tri_key){length + growth * d, growth, d > 0 ? steep / 2 : HUGE_VAL,
                            {-steep * away.x, -steep * away.y}};
}

/* The item with the least key at a place wins there; of several the first. */
struct tri_contest {
    struct tri_key (*key)(const void *user, int32_t item, struct tri_point p);
    /* By how much may keys be too large in a cell with this side, in which this is the least one? 0: not at all; so it
     * should be in cells that are not small against what is asked for. */
    double (*allowed)(const void *user, int32_t winner, double key, double side);
    const void *user;
};

struct tri_candidates {
    struct tri_quadtree tree; /* the number of a leaf is where its list begins */
    int32_t *list;            /* [n] how many items, and then these, in their order */
    int32_t n, capacity;
};

/* What all sources are made for. */
struct tri_size_frame {
    const struct tri_mesh *mesh;
    struct tri_point low, high; /* the box of its vertices */
    double gradation;           /* above 0, or infinite */
    const struct tri_executor *executor;
};

/* The lists of n >= 1 items for places in the frame's box; for others they are those of the nearest place in it. In
 * about n log n; contest is asked by several threads. TRI_NO_MEMORY, TRI_STOPPED: *candidates is empty. */
enum tri_status tri_candidates_make(struct tri_candidates *candidates, const struct tri_contest *contest, int32_t n,
                                    const struct tri_size_frame *frame, struct tri_error *error);
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
