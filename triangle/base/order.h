/* Items in an order that the caller knows: the edges that a sweep line crosses, from bottom to top.
 *
 * A skip list (Pugh 1990): the items stand in a ring through a sentinel, and each item stands in the coarser rings of
 * the levels below its height too. Heights are a hash of the number, so that the shape is the same in every run. */
#ifndef TRIANGLE_BASE_ORDER_H
#define TRIANGLE_BASE_ORDER_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/status.h"

enum { TRI_ORDER_LEVELS = 16 };

struct tri_order {
    int32_t n;      /* items are 0 .. n - 1; the sentinel is n */
    int64_t *first; /* [n + 1] where the links of an item begin, level 0 first */
    struct {
        int32_t below, above;
    } *link;
};

/* An empty order for the items 0 .. n - 1. TRI_NO_MEMORY. */
enum tri_status tri_order_init(struct tri_order *order, int32_t n);
void tri_order_clear(struct tri_order *order);

/* The item just above s, or the lowest of all if s is -1; -1: none. */
int32_t tri_order_above(const struct tri_order *order, int32_t s);

/* The highest item for which is_below says so, -1: none. Whatever is below such an item is one too. */
int32_t tri_order_find(const struct tri_order *order, bool (*is_below)(const void *user, int32_t s),
                             const void *user);

/* Puts s just above item `below`, or lowest of all if that is -1. These take O(log n) expected, in all n calls O(n). */
void tri_order_insert(struct tri_order *order, int32_t s, int32_t below);
void tri_order_remove(struct tri_order *order, int32_t s);

#endif
