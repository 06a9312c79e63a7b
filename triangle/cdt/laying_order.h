/* The segments of the input as pieces, in the order in which they are laid. */
#ifndef TRIANGLE_CDT_LAYING_ORDER_H
#define TRIANGLE_CDT_LAYING_ORDER_H

#include "triangle/cdt/overlap.h"
#include "triangle/mesh/pslg.h"

/* Lists the segments that have a meaning in piece[pslg->n_segments], and returns how many there are; *skipped grows by
 * those that have none. corner[v]: a triangle at v, or TRI_NONE. */
int32_t tri_list_pieces(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const tri_triangle_id *corner,
                        struct tri_piece *piece, int32_t *skipped);

/* In random rounds that double, in each in the order of the list. The pieces come from malloc, as what replaces them.
 * False: out of memory, nothing has changed. O(n) */
bool tri_put_in_rounds(struct tri_piece **piece, int32_t n);

#endif
