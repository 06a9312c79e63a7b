/* Segments that run along each other from a common end. */
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
    int32_t from, to;
    struct tri_course course;
};

/* Where pieces start at one vertex in exactly the same direction, each keeps what reaches beyond the next shorter one,
 * and the shorter ones take over its course: so the lengths of all pieces at a vertex sum up to the longest, however
 * many there are. from and to: the ends of each piece, from before to. Empty pieces are left where two are equal. The
 * others stay as they are. O(n log n) at most, O(n) where few share ends; false: out of memory. */
bool tri_share_overlaps(const struct tri_mesh *mesh, struct tri_piece *piece, int32_t n);

#endif
