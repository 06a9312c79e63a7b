/* The plane cut into cells of about equal work, and the blocks of cells that are refined at once.
 *
 * Columns of cells hold equal shares of the estimated final triangles, whatever the grading. Block column k reaches
 * over the columns of cells on both sides of boundary k:
 *
 *      boundaries      0   1   2   3   4   5   6
 *      blocks 1 3 5    |-------|-------|-------|         (the first and the last reach to infinity)
 *      blocks 0 2 4 6  |---|-------|-------|---|
 *
 * Rows are cut in the same way, for each block column from the work inside it. The phase of a block is the parity of
 * its column and of its row; phase 0 has the odd ones, and both phases of odd columns come before those of even ones.
 *
 * INVARIANT (docs/theory.md, cells and phases). Blocks of one phase are disjoint half-open boxes and tile the plane; a
 * block of the next phase covers the seams of the last one. The partition depends on the mesh and the bounds alone. */
#ifndef SCHED_SCHEDULE_PARTITION_H
#define SCHED_SCHEDULE_PARTITION_H

#include "sched/tunables.h"
#include "triangle/mesh/fence.h"
#include "triangle/refine/refine.h"

enum { PAR_PHASES = 4 };

struct par_partition {
    int32_t n_columns, n_rows; /* of blocks: odd, at least 3 */
    double *x;       /* [n_columns] boundaries of the columns of cells, ascending, over the bounding box of the mesh */
    double *y;       /* [n_columns][n_rows] boundaries of the rows of cells in each column of blocks */
    struct tri_point low, high; /* bounding box of the mesh */
    double estimate; /* of final triangles in all */
};

/* Final triangles of a cell, where a mesh ends with about so many. */
static inline double par_triangles_in_cell(double triangles)
{
    const double share = triangles / PAR_CELLS_WANTED;
    return share < PAR_SMALLEST_CELL ? PAR_SMALLEST_CELL : share > PAR_LARGEST_CELL ? PAR_LARGEST_CELL : share;
}

/* Cuts the plane into cells of about cell_triangles. estimate: what tri_estimate says. TRI_NO_MEMORY. O(triangles +
 * samples log samples). */
enum tri_status par_partition_make(struct par_partition *partition, const struct tri_mesh *mesh,
                                   const struct tri_quality *quality, double estimate, double cell_triangles,
                                   const struct tri_executor *executor, struct tri_error *error);

/* A copy with memory of its own. */
enum tri_status par_partition_copy(struct par_partition *copy, const struct par_partition *partition,
                                   struct tri_error *error);

/* Halves the number of columns and rows of cells, down to two. */
void par_partition_coarsen(struct par_partition *partition);

void par_partition_free(struct par_partition *partition);

static inline int32_t par_blocks(const struct par_partition *p) { return p->n_columns * p->n_rows; }
static inline int32_t par_cells(const struct par_partition *p) { return (p->n_columns - 1) * (p->n_rows - 1); }

/* Is there a coarser one that is worth a round of phases? */
static inline bool par_can_coarsen(const struct par_partition *p) { return par_cells(p) >= 16; }

/* Tiles are the blocks of odd column and odd row, phase 0: counted column by column, rows upwards. */
static inline int32_t par_tile_columns(const struct par_partition *p) { return p->n_columns / 2; }
static inline int32_t par_tile_rows(const struct par_partition *p) { return p->n_rows / 2; }

/* The tile of a block of phase 0, which is column * n_rows + row. */
static inline int32_t par_tile_of_block(const struct par_partition *p, int32_t block)
{
    return block / p->n_rows / 2 * par_tile_rows(p) + block % p->n_rows / 2;
}

/* Things lie in order, the things of k = 0 .. n - 1 (tiles, rows, ranks) from start[k] to start[k + 1] - 1: whose is
 * this place, which is one's? O(log n). */
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

/* The box of block (column, row). */
struct tri_fence par_fence(const struct par_partition *partition, int32_t column, int32_t row);

/* The block of a phase (bit 0: its row is even, bit 1: its column is) that holds q, as column * n_rows + row.
 * O(log blocks). */
int32_t par_block_at(const struct par_partition *partition, int phase, struct tri_point q);

/* The same for places of one phase that mostly lie in the same block as the last: then O(1). Starts as PAR_LOST. */
struct par_locator {
    struct tri_fence fence;
    int32_t block;
};

static const struct par_locator PAR_LOST = {{1, 1, 0, 0}, TRI_NONE};

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

/* The last tile, as a block of phase 0, that holds one of n vertices: those of a triangle, or of a subsegment. */
int32_t par_last_tile(const struct par_partition *partition, const struct tri_mesh *mesh, const tri_vertex_id *v,
                      int n);

/* The block of a phase that holds all corners of triangle t, or TRI_NONE. O(log blocks); or O(1). */
int32_t par_owner_of(const struct par_partition *partition, int phase, const struct tri_mesh *mesh, tri_triangle_id t);
int32_t par_locate_owner(struct par_locator *locator, const struct par_partition *partition, int phase,
                         const struct tri_mesh *mesh, tri_triangle_id t);

/* The smaller side of the cell that holds q. O(log blocks). */
double par_cell_size(const struct par_partition *partition, struct tri_point q);

#endif
