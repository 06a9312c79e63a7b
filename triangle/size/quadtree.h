/* A quadtree: finds the leaf that contains a point. */
#ifndef TRIANGLE_SIZE_QUADTREE_H
#define TRIANGLE_SIZE_QUADTREE_H

#include <math.h>
#include <stdint.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/point.h"

enum { TRI_QUADTREE_DEEPEST = 30 };

struct tri_quadtree {
    struct tri_point low; /* lower left corner of the root */
    double side;          /* side of the root */
    double scale;         /* 2^TRI_QUADTREE_DEEPEST / side */
    int32_t *child;       /* [n] four consecutive entries per divided cell, in the order x + 2 y. >= 0: index of the
                             first of its own four; < 0: ~number of a leaf. child[0] is the root */
    int32_t n, capacity;  /* entries of child; allocated */
};

/* A cell. Its side is side * 2^-depth. */
struct tri_cell {
    uint32_t x, y; /* column and row among the cells of this depth */
    int depth;     /* 0 for the root */
};

/* Returns the leaf that contains the cell x, y of the largest depth, and sets *cell to the leaf's cell. */
static inline int32_t tri_quadtree_leaf(const struct tri_quadtree *tree, uint32_t x, uint32_t y, struct tri_cell *cell)
{
    int32_t at = tree->child[0];
    int bit = TRI_QUADTREE_DEEPEST;
    while (at >= 0) {
        bit--;
        at = tree->child[(uint32_t)at + (x >> bit & 1) + 2 * (y >> bit & 1)];
    }
    *cell = (struct tri_cell){x >> bit, y >> bit, TRI_QUADTREE_DEEPEST - bit};
    return ~at;
}

/* The same for a point. Outside the root, the nearest point in the root counts. */
static inline int32_t tri_quadtree_find(const struct tri_quadtree *tree, struct tri_point p, struct tri_cell *cell)
{
    const double most = (double)((1U << TRI_QUADTREE_DEEPEST) - 1);
    const double x = tri_lesser(tri_larger((p.x - tree->low.x) * tree->scale, 0), most);
    const double y = tri_lesser(tri_larger((p.y - tree->low.y) * tree->scale, 0), most);
    return tri_quadtree_leaf(tree, (uint32_t)x, (uint32_t)y, cell);
}

static inline double tri_cell_side(const struct tri_quadtree *tree, int depth)
{
    return tree->side / (double)(UINT32_C(1) << depth);
}

/* Returns the cell's lower left corner. */
static inline struct tri_point tri_cell_low(const struct tri_quadtree *tree, struct tri_cell cell)
{
    const double side = tri_cell_side(tree, cell.depth);
    return (struct tri_point){tree->low.x + cell.x * side, tree->low.y + cell.y * side};
}

static inline struct tri_cell tri_cell_child(struct tri_cell cell, uint32_t k)
{
    return (struct tri_cell){2 * cell.x + (k & 1), 2 * cell.y + (k >> 1), cell.depth + 1};
}

/* Makes room for four more entries. Returns false if memory ran out. */
static inline bool tri_quadtree_grow(struct tri_quadtree *tree)
{
    return tri_grow(&tree->child, &tree->capacity, tree->n + 4, sizeof *tree->child);
}

/* Initialises a tree whose root contains the box. It has no leaf yet. Returns false if memory ran out. */
static inline bool tri_quadtree_init(struct tri_quadtree *tree, struct tri_point low, struct tri_point high)
{
    double side = tri_larger(high.x - low.x, high.y - low.y);
    side = side > 0 ? side * (1 + 0x1p-20) : 1;
    *tree = (struct tri_quadtree){.low = low, .side = side, .scale = (double)(1U << TRI_QUADTREE_DEEPEST) / side};
    if (!tri_quadtree_grow(tree))
        return false;
    tree->child[0] = -1;
    tree->n = 1;
    return true;
}

#endif
