/* The plane cut into blocks of about equal work, in four colours.
 *
 * Columns hold equal shares of the estimated final triangles, and so do the rows inside each column, whatever the
 * grading. A block's colour is the parity of its column and of its row. The fence of a block reaches half way into its
 * neighbours:
 *
 *      column      0       1       2       3             boundaries of columns:  |
 *              |.......|...:...|.......|...:...|         fences of even columns: from : to : (half of 1, 3, ...)
 *
 * INVARIANT: fences of one colour are disjoint half-open boxes and, with those at the rim reaching to infinity, nearly
 * tile the plane; a fence of the next colour covers the seams of the last one. So the phase of the first colour does
 * most of the work and the other three close the seams, and a triangle smaller than half a block lies in some fence of
 * some colour.
 *
 * The partition depends on the mesh and the bounds alone, never on the number of threads. */
#ifndef SCHED_PARTITION_H
#define SCHED_PARTITION_H

#include "triangle/cavity.h"
#include "triangle/refine.h"

enum { PAR_COLOURS = 4 };

struct par_partition {
    int32_t n_columns, n_rows;
    double *x;       /* [n_columns + 1] boundaries of the columns, increasing, over the bounding box of the mesh */
    double *y;       /* [n_columns][n_rows + 1] boundaries of the rows of each column */
    struct tri_point low, high; /* bounding box of the mesh */
    double estimate; /* of final triangles in all */
};

/* Estimates the number of triangles that refinement will end with: for bounded areas from the areas, for a bounded
 * angle from the number of vertices; what a size test will ask for cannot be known. O(triangles). */
double par_estimate(const struct tri_mesh *mesh, const struct tri_refine_options *options);

/* The share of one triangle in that. */
double par_work_of(const struct tri_mesh *mesh, const struct tri_refine_options *options, int32_t t);

/* Cuts the plane for blocks of about block_triangles. TRI_NO_MEMORY. O(triangles + samples log samples). */
enum tri_status par_partition_make(struct par_partition *partition, const struct tri_mesh *mesh,
                                   const struct tri_refine_options *options, double block_triangles,
                                   struct tri_error *error);

/* A copy with memory of its own. */
enum tri_status par_partition_copy(struct par_partition *copy, const struct par_partition *partition,
                                   struct tri_error *error);

/* Halves the number of columns and rows. */
void par_partition_coarsen(struct par_partition *partition);

void par_partition_free(struct par_partition *partition);

static inline int32_t par_blocks(const struct par_partition *p) { return p->n_columns * p->n_rows; }

/* The fence of block (column, row), for its own colour. */
struct tri_fence par_fence(const struct par_partition *partition, int32_t column, int32_t row);

/* The block of a colour (bit 0: parity of the column, bit 1: of the row) whose fence holds q, as column * n_rows + row,
 * or TRI_NONE. O(log blocks). */
int32_t par_block_at(const struct par_partition *partition, int colour, struct tri_point q);

/* The block of a colour whose fence holds all corners of triangle t, or TRI_NONE. O(log blocks). */
int32_t par_owner_of(const struct par_partition *partition, int colour, const struct tri_mesh *mesh, int32_t t);

/* The smaller side of the cell (not fence) that holds q. O(log blocks). */
double par_cell_size(const struct par_partition *partition, struct tri_point q);

#endif
