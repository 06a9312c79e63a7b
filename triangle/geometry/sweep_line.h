/* The sweep line of a plane sweep: non-crossing segments in their order along it, from bottom to top.
 *
 * A treap over segment numbers, threaded from bottom to top. Priorities are a hash of the number, so that the shape is
 * the same in every run. "Below" means before in the order of y on the sweep line; the line is vertical, tilted by a
 * hair so that points of equal x are met from bottom to top, and vertical segments need no special case. */
#ifndef TRIANGLE_GEOMETRY_SWEEP_LINE_H
#define TRIANGLE_GEOMETRY_SWEEP_LINE_H

#include <stdint.h>

#include "triangle/base/status.h"

struct tri_sweep_line_node {
    int32_t up, down[2]; /* tree: parent, children below and above; -1: none */
    int32_t next[2];     /* thread: the segment just below, just above; -1: none */
};

struct tri_sweep_line {
    struct tri_sweep_line_node *node; /* [n] */
    int32_t root;            /* -1: empty */
};

/* An empty order for segments 0 .. n - 1. TRI_NO_MEMORY. */
enum tri_status tri_sweep_line_init(struct tri_sweep_line *order, int32_t n);
void tri_sweep_line_clear(struct tri_sweep_line *order);

/* The segment just above s, or the lowest of all if s is -1; -1: none. */
int32_t tri_sweep_line_above(const struct tri_sweep_line *order, int32_t s);

/* Puts segment s just above segment `below`, or lowest of all if that is -1. O(log n) expected. */
void tri_sweep_line_insert(struct tri_sweep_line *order, int32_t s, int32_t below);
void tri_sweep_line_remove(struct tri_sweep_line *order, int32_t s);

#endif
