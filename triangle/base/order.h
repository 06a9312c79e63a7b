/* An ordered list of items whose order the caller defines, such as the edges that a sweep line crosses, from bottom to
 * top.
 *
 * It is a skip list (Pugh 1990). All items are in the ring of level 0, which passes through a sentinel. An item is also
 * in the coarser rings of all levels below its height. Heights are a hash of the item's number, so that the structure
 * is the same in every run. */
#ifndef TRIANGLE_BASE_ORDER_H
#define TRIANGLE_BASE_ORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/status.h"

enum { TRI_ORDER_LEVELS = 16 };

struct tri_order {
    int32_t n;      /* items are 0 .. n - 1; the sentinel is n */
    int64_t *first; /* [n + 1] index in `link` of an item's first link, which is that of level 0 */
    struct {
        int32_t below, above;
    } *link; /* neighbours in each ring; indices start at first */
};

/* Makes an empty order for the items 0 .. n - 1. Fails only with TRI_NO_MEMORY. */
enum tri_status tri_order_init(struct tri_order *order, int32_t n);
void tri_order_clear(struct tri_order *order);

/* Returns the item just above s, or the lowest item if s is -1; -1 if there is none. */
int32_t tri_order_above(const struct tri_order *order, int32_t s);

/* Returns the highest item for which is_below returns true, or -1 if there is none. If is_below is true for an item, it
 * must be true for all items below it. */
int32_t tri_order_find(const struct tri_order *order, bool (*is_below)(const void *user, int32_t s),
                             const void *user);

/* Inserts s just above item `below`, or as the lowest item if that is -1. Both functions take expected O(log n), and
 * O(n) for all n calls together. */
void tri_order_insert(struct tri_order *order, int32_t s, int32_t below);
void tri_order_remove(struct tri_order *order, int32_t s);

#endif
