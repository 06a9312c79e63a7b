/* Segments that run along each other on one line. */
#ifndef TRIANGLE_OVERLAP_H
#define TRIANGLE_OVERLAP_H

#include "triangle/mesh.h"

/* The input segments that run along a piece or a subsegment: the first of them, the first with a marker, and whether
 * they are odd in number. */
struct tri_course {
    int32_t first, marked; /* TRI_NONE: there is none */
    bool odd;
};

static inline int32_t tri_earlier(int32_t a, int32_t b) { return a == TRI_NONE || (b != TRI_NONE && b < a) ? b : a; }

/* The course of what both run along. */
static inline struct tri_course tri_course_both(struct tri_course a, struct tri_course b)
{
    struct tri_course both = {tri_earlier(a.first, b.first), tri_earlier(a.marked, b.marked), a.odd != b.odd};
    return both;
}

struct tri_piece {
    tri_vertex_id from, to;
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

/* The same for (*piece)[*n] that overlap in whatever way: piece i runs from stop[reach[i][0]] to stop[reach[i][1]], the
 * first before the second, through all stops between. O((*n + n_stops) log *n). */
bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n);

#endif
