/* The boundary of a mesh as chains of nodes, for formats that want it so. */
#ifndef TRIANGLE_TEXT_BOUNDARY_H
#define TRIANGLE_TEXT_BOUNDARY_H

#include "triangle/mesh/grid.h"

/* A maximal run of boundary edges with one marker, the mesh on its left. */
struct tri_boundary_piece {
    int64_t first, n; /* its nodes; of a closed piece each once */
    int32_t marker;
    bool closed;      /* a whole loop */
    bool outer;       /* of a loop that goes round the mesh, counter-clockwise; else round a hole */
};

struct tri_boundary {
    int64_t n_pieces;
    struct tri_boundary_piece *pieces;
    int64_t *nodes;
};

/* All edges of the boundary are segments. O(triangles + segments log segments); memory in proportion to segments, and a
 * byte for each point. TRI_NO_MEMORY. To be freed in any case. */
enum tri_status tri_boundary_make(struct tri_boundary *boundary, const struct tri_grid *grid, struct tri_error *error);
void tri_boundary_free(struct tri_boundary *boundary);

#endif
