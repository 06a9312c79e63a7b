/* The order of the sweep: non-crossing segments from bottom to top where the sweep line is.
 *
 * A treap over segment numbers, threaded from bottom to top. Priorities are a hash of the number, so that the shape is
 * the same in every run. "Below" means before in the order of y on the sweep line; the line is vertical, tilted by a
 * hair so that points of equal x are met from bottom to top, and vertical segments need no special case. */
#ifndef TRIANGLE_SWEEP_ORDER_H
#define TRIANGLE_SWEEP_ORDER_H

#include <stdint.h>

#include "triangle/status.h"

struct sweep_node {
    int32_t up, down[2]; /* tree: parent, children below and above; -1: none */
    int32_t next[2];     /* thread: the segment just below, just above; -1: none */
};

struct sweep_order {
    struct sweep_node *node; /* [n] */
    int32_t root;            /* -1: empty */
};

/* An empty order for segments 0 .. n - 1. TRI_NO_MEMORY. */
enum tri_status tri_sweep_order_init(struct sweep_order *order, int32_t n);
void tri_sweep_order_clear(struct sweep_order *order);

/* The segment just above s, or the lowest of all if s is -1; -1: none. */
int32_t tri_sweep_order_above(const struct sweep_order *order, int32_t s);

/* Puts segment s just above segment `below`, or lowest of all if that is -1. O(log n) expected. */
void tri_sweep_order_insert(struct sweep_order *order, int32_t s, int32_t below);
void tri_sweep_order_remove(struct sweep_order *order, int32_t s);

#endif
