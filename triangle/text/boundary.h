/* The boundary of a mesh as chains of nodes, for the formats that need it. */
#ifndef TRIANGLE_TEXT_BOUNDARY_H
#define TRIANGLE_TEXT_BOUNDARY_H

#include "triangle/mesh/grid.h"

/* A maximal chain of boundary edges with one marker; the mesh is on its left. */
struct tri_boundary_piece {
    int64_t first, n; /* range of its nodes; a closed piece lists each node once */
    int32_t marker;   /* marker of its edges */
    bool closed;      /* the piece is a whole loop */
    bool outer;       /* its loop encloses the mesh, counter-clockwise; false: it encloses a hole */
};

struct tri_boundary {
    int64_t n_pieces;
    struct tri_boundary_piece *pieces; /* [n_pieces] */
    int64_t *nodes;                    /* point numbers of all pieces, one piece after another */
};

/* Lists the pieces of the boundary; all boundary edges must be segments. O(triangles + segments log segments). Memory
 * is proportional to the segments, plus one byte per point. TRI_NO_MEMORY. Call tri_boundary_free in any case. */
enum tri_status tri_boundary_make(struct tri_boundary *boundary, const struct tri_grid *grid, struct tri_error *error);
void tri_boundary_free(struct tri_boundary *boundary);

#endif
