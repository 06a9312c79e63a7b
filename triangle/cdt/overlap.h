/* Pieces of segments, and what is left of those that run along each other. */
#ifndef TRIANGLE_CDT_OVERLAP_H
#define TRIANGLE_CDT_OVERLAP_H

#include "triangle/mesh/mesh.h"

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

/* Cuts (*piece)[*n], at least one of them, at the stops on their way, and leaves one of each elementary piece, with the
 * course of all that run along it: piece i runs from stop[reach[i][0]] to stop[reach[i][1]], the first before the
 * second, through all stops between. Pieces come in the order of their first segments, and from malloc, as what
 * replaces them. O((*n + n_stops) log *n). false: out of memory, nothing has changed. */
bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n);

#endif
