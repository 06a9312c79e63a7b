/* For each cell of a quadtree, lists which of many items can win inside the cell. The lists are made once. */
#ifndef TRIANGLE_SIZE_CANDIDATES_H
#define TRIANGLE_SIZE_CANDIDATES_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quadtree.h"

/* The key of an item around a point p. For a displacement q from p, the key is at least value + gradient * q, since
 * keys are convex functions. It is at most value + slope * |q|, and at most value + gradient * q + bend * |q|^2. */
struct tri_key {
    double value, slope, bend; /* bend may be infinite */
    struct tri_point gradient; /* of the key at p */
};

/* Returns the key `length` + `growth` * distance from a convex set. away: vector from the point to the nearest point
 * of the set. */
static inline struct tri_key tri_key_of_distance(double length, double growth, struct tri_point away)
{
    const double d = sqrt(away.x * away.x + away.y * away.y), steep = d > 0 ? growth / d : 0;
    return (struct tri_key){length + growth * d, growth, d > 0 ? steep / 2 : HUGE_VAL,
                            {-steep * away.x, -steep * away.y}};
}

/* The contest: at each point, the item with the smallest key wins; among equal keys, the first item. */
struct tri_contest {
    struct tri_key (*key)(const void *user, int32_t item, struct tri_point p); /* returns an item's key at p */
    /* Returns the tolerated error of keys in a cell with this side, if `winner` has the smallest key `key` there.
     * Must be 0 in cells that are not small compared with the wanted accuracy. */
    double (*allowed)(const void *user, int32_t winner, double key, double side);
    const void *user; /* passed to both functions */
};

struct tri_candidates {
    struct tri_quadtree tree; /* the number of a leaf is the index of its list */
    int32_t *list;            /* [n] for each leaf: the number of items, then the items in ascending order */
    int32_t n, capacity;      /* numbers in list; allocated */
};

/* Common data for all sources. */
struct tri_size_frame {
    const struct tri_mesh *mesh; /* the mesh; borrowed */
    struct tri_point low, high; /* bounding box of the mesh */
    double gradation;           /* largest slope; above 0, may be infinite */
    const struct tri_executor *executor; /* runs parallel tasks; NULL: none */
};

/* Makes the lists of n >= 1 items for points in the frame's box. A point outside the box uses the list for the
 * nearest point of the box. Takes about n log n time; several threads call the contest. After TRI_NO_MEMORY or
 * TRI_STOPPED, *candidates is empty. */
enum tri_status tri_candidates_make(struct tri_candidates *candidates, const struct tri_contest *contest, int32_t n,
                                    const struct tri_size_frame *frame, struct tri_error *error);
void tri_candidates_clear(struct tri_candidates *candidates);

/* Returns the items that can win at p, and sets *n >= 1 to their number. */
static inline const int32_t *tri_candidates_at(const struct tri_candidates *candidates, struct tri_point p, int32_t *n)
{
    struct tri_cell cell;
    const int32_t *list = candidates->list + tri_quadtree_find(&candidates->tree, p, &cell);
    *n = list[0];
    return list + 1;
}

#endif
