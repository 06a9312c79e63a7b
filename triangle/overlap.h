/* Segments that run along each other on one line. */
#ifndef TRIANGLE_OVERLAP_H
#define TRIANGLE_OVERLAP_H

#include "triangle/mesh.h"

/* The input segments that run along a piece or a subsegment: the first of them, and the first with a marker. */
struct tri_course {
    int32_t first, marked; /* TRI_NONE: there is none */
};

struct tri_piece {
    int32_t from, to;
    struct tri_course course;
};

/* Is the piece an edge of the mesh? */
typedef bool tri_is_edge(void *context, const struct tri_piece *piece);

/* Cuts pieces that overlap on exactly one line, and are no edges of the mesh, at each other's ends, and leaves one of
 * each elementary piece, where the first piece along it was, with the course of all that run along it. So there are
 * fewer than 2 *n, no two of which overlap unless one is an edge. The others stay as they are. (*piece)[*n]: from
 * malloc, as what replaces it; its courses increase, and the ends of a piece differ. O(n log n) at most, O(n) where few
 * lines hold several pieces, and as many questions. false: out of memory, nothing has changed. */
bool tri_share_overlaps(const struct tri_mesh *mesh, struct tri_piece **piece, int32_t *n, tri_is_edge *is_edge,
                        void *context);

#endif
