/* The sweep line as a threaded treap. Seidel & Aragon 1996.
 *
 * INVARIANT: next[0] and next[1] are the neighbours in the in-order walk of the tree, and a parent's priority is never
 * below its children's. */
#include "triangle/geometry/sweep_line.h"

#include <assert.h>
#include <stdlib.h>

static uint32_t priority(int32_t s)
{
    uint32_t x = (uint32_t)s * 0x9e3779b1u;
    x ^= x >> 15;
    x *= 0x85ebca77u;
    return x ^ x >> 13;
}

enum tri_status tri_sweep_line_init(struct tri_sweep_line *order, int32_t n)
{
    order->root = -1;
    order->node = malloc(((size_t)n + 1) * sizeof *order->node);
    return order->node == NULL ? TRI_NO_MEMORY : TRI_OK;
}

void tri_sweep_line_clear(struct tri_sweep_line *order)
{
    free(order->node);
    order->node = NULL;
}

/* Makes `child` (or -1) the child of `parent` (or the root, if -1) that `old` was. */
static void replace_child(struct tri_sweep_line *o, int32_t parent, int32_t old, int32_t child)
{
    if (child >= 0)
        o->node[child].up = parent;
    if (parent < 0) {
        o->root = child;
        return;
    }
    int side = o->node[parent].down[1] == old;
    assert(o->node[parent].down[side] == old);
    o->node[parent].down[side] = child;
}

/* Lifts s above its parent. */
static void rotate_up(struct tri_sweep_line *o, int32_t s)
{
    struct tri_sweep_line_node *node = o->node;
    int32_t parent = node[s].up;
    int side = node[parent].down[1] == s;
    int32_t moved = node[s].down[!side];
    replace_child(o, node[parent].up, parent, s);
    node[s].down[!side] = parent;
    node[parent].up = s;
    node[parent].down[side] = moved;
    if (moved >= 0)
        node[moved].up = parent;
}

int32_t tri_sweep_line_above(const struct tri_sweep_line *o, int32_t s)
{
    if (s >= 0)
        return o->node[s].next[1];
    s = o->root;
    while (s >= 0 && o->node[s].down[0] >= 0)
        s = o->node[s].down[0];
    return s;
}

static void thread(struct tri_sweep_line *o, int32_t below, int32_t above)
{
    if (below >= 0)
        o->node[below].next[1] = above;
    if (above >= 0)
        o->node[above].next[0] = below;
}

void tri_sweep_line_insert(struct tri_sweep_line *o, int32_t s, int32_t below)
{
    struct tri_sweep_line_node *node = o->node;
    int32_t above = tri_sweep_line_above(o, below);
    node[s] = (struct tri_sweep_line_node){-1, {-1, -1}, {below, above}};
    thread(o, below, s);
    thread(o, s, above);
    if (below >= 0 && node[below].down[1] < 0) { /* room above it? else its successor has room below */
        node[below].down[1] = s;
        node[s].up = below;
    } else if (above >= 0) {
        assert(node[above].down[0] < 0);
        node[above].down[0] = s;
        node[s].up = above;
    } else {
        o->root = s;
    }
    while (node[s].up >= 0 && priority(node[s].up) < priority(s))
        rotate_up(o, s);
}

void tri_sweep_line_remove(struct tri_sweep_line *o, int32_t s)
{
    struct tri_sweep_line_node *node = o->node;
    while (node[s].down[0] >= 0 && node[s].down[1] >= 0) {
        int32_t a = node[s].down[0], b = node[s].down[1];
        rotate_up(o, priority(a) > priority(b) ? a : b);
    }
    int32_t child = node[s].down[0] >= 0 ? node[s].down[0] : node[s].down[1];
    replace_child(o, node[s].up, s, child);
    thread(o, node[s].next[0], node[s].next[1]);
}
