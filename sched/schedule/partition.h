/* The plane is cut into cells of about equal work; a block, which is refined as a unit, covers up to four cells.
 *
 * All columns of cells hold equal shares of the estimated final triangles, regardless of the grading. Block column k
 * covers the two columns of cells to the left and right of boundary k:
 *
 *      boundaries      0   1   2   3   4   5   6
 *      blocks 1 3 5    |-------|-------|-------|         (the first and the last reach to infinity)
 *      blocks 0 2 4 6  |---|-------|-------|---|
 *
 * Rows are cut in the same way, for each block column from the work inside it. The phase of a block follows from the
 * parity of its column and row. Phase 0 has odd columns and rows; phases of odd columns precede those of even ones.
 *
 * INVARIANT (docs/theory.md, cells and phases). Blocks of one phase are disjoint half-open boxes and tile the plane.
 * Blocks of the next phase cover the seams of the previous one. The partition depends only on the mesh and the
 * bounds. */
#ifndef SCHED_SCHEDULE_PARTITION_H
#define SCHED_SCHEDULE_PARTITION_H

#include "sched/tunables.h"
#include "triangle/mesh/fence.h"
#include "triangle/refine/refine.h"

enum { PAR_PHASES = 4 };

struct par_partition {
    int32_t n_columns, n_rows;  /* numbers of columns and rows of blocks: odd, at least 3 */
    double *x;                  /* [n_columns] boundaries of the columns of cells, ascending; the first and last are
                                   those of the bounding box */
    double *y;                  /* [n_columns][n_rows] boundaries of the rows of cells, ascending, for each column of
                                   blocks */
    struct tri_point low, high; /* bounding box of the mesh */
    double estimate;            /* estimated number of final triangles of the mesh */
};

/* Returns the default number of final triangles in a cell, for a final mesh of about `triangles` triangles. */
static inline double par_triangles_in_cell(double triangles)
{
    const double share = triangles / PAR_CELLS_WANTED;
    return share < PAR_SMALLEST_CELL ? PAR_SMALLEST_CELL : share > PAR_LARGEST_CELL ? PAR_LARGEST_CELL : share;
}

/* Cuts the plane into cells of about cell_triangles final triangles each. estimate: the result of tri_estimate.
 * TRI_NO_MEMORY. O(triangles + samples log samples). */
enum tri_status par_partition_make(struct par_partition *partition, const struct tri_mesh *mesh,
                                   const struct tri_quality *quality, double estimate, double cell_triangles,
                                   const struct tri_executor *executor, struct tri_error *error);

/* Makes a copy that owns its memory. TRI_NO_MEMORY; *copy is then empty. */
enum tri_status par_partition_copy(struct par_partition *copy, const struct par_partition *partition,
                                   struct tri_error *error);

/* Merges cells in pairs, which halves the numbers of columns and rows of cells, down to two. */
void par_partition_coarsen(struct par_partition *partition);

/* Frees the arrays; the partition is empty afterwards. */
void par_partition_free(struct par_partition *partition);

/* Return the numbers of blocks, and of cells. */
static inline int32_t par_blocks(const struct par_partition *p) { return p->n_columns * p->n_rows; }
static inline int32_t par_cells(const struct par_partition *p) { return (p->n_columns - 1) * (p->n_rows - 1); }

/* Returns whether coarser blocks are worth another round of phases. */
static inline bool par_can_coarsen(const struct par_partition *p) { return par_cells(p) >= 16; }

/* Tiles are the blocks of phase 0, those of odd column and odd row. They are numbered column by column, rows upwards.
 * These functions return the number of tile columns, and of tile rows. */
static inline int32_t par_tile_columns(const struct par_partition *p) { return p->n_columns / 2; }
static inline int32_t par_tile_rows(const struct par_partition *p) { return p->n_rows / 2; }

/* Returns the tile of a block of phase 0; block: column * n_rows + row. */
static inline int32_t par_tile_of_block(const struct par_partition *p, int32_t block)
{
    return block / p->n_rows / 2 * par_tile_rows(p) + block % p->n_rows / 2;
}

/* Items lie in order: those of owner k (a tile, a row, a rank; k = 0 .. n - 1) from start[k] to start[k + 1] - 1.
 * Returns the owner of the item at `place`. O(log n). */
static inline int32_t par_holder_of(const int32_t *start, int32_t n, int32_t place)
{
    int32_t low = 0, high = n;
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (start[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* Returns the box of block (column, row); outer blocks reach to infinity. */
struct tri_fence par_fence(const struct par_partition *partition, int32_t column, int32_t row);

/* Returns the block of a phase that holds q, as column * n_rows + row. Bit 0 of phase: the block's row is even; bit 1:
 * its column is even. O(log blocks). */
int32_t par_block_at(const struct par_partition *partition, int phase, struct tri_point q);

/* Caches the last block that was found, for many look-ups in the same phase: O(1) if q lies in the same block as the
 * previous one. Initialise it with PAR_LOST, whose box is empty. */
struct par_locator {
    struct tri_fence fence; /* box of the block found last */
    int32_t block;          /* this block; TRI_NONE: none yet */
};

static const struct par_locator PAR_LOST = {{1, 1, 0, 0}, TRI_NONE};

/* Returns the block of `phase` that holds q. A locator must be used for one phase and one partition only. */
static inline int32_t par_locate(struct par_locator *locator, const struct par_partition *partition, int phase,
                                 struct tri_point q)
{
    if (!tri_fence_holds(&locator->fence, q)) {
        locator->block = par_block_at(partition, phase, q);
        locator->fence = par_fence(partition, locator->block / partition->n_rows,
                                   locator->block % partition->n_rows);
    }
    return locator->block;
}

/* Returns the last tile, as a block of phase 0, that holds one of n vertices: the corners of a triangle or the ends of
 * a subsegment. */
int32_t par_last_tile(const struct par_partition *partition, const struct tri_mesh *mesh, const tri_vertex_id *v,
                      int n);

/* Returns the block of a phase that holds all corners of triangle t, or TRI_NONE if no block does. O(log blocks), or
 * O(1) with a locator that already holds the block. */
int32_t par_owner_of(const struct par_partition *partition, int phase, const struct tri_mesh *mesh, tri_triangle_id t);
int32_t par_locate_owner(struct par_locator *locator, const struct par_partition *partition, int phase,
                         const struct tri_mesh *mesh, tri_triangle_id t);

/* Returns the smaller side of the cell that holds q. O(log blocks). */
double par_cell_size(const struct par_partition *partition, struct tri_point q);

#endif
