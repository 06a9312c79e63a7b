/* Segments of the input as pieces, and what is left of pieces that run along each other within rounding. */
#ifndef TRIANGLE_CDT_BUNDLE_H
#define TRIANGLE_CDT_BUNDLE_H

#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"

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

/* Lists the segments that have a meaning in piece[pslg->n_segments], and returns how many there are; *skipped grows by
 * those that have none. corner[v]: a triangle at v, or TRI_NONE. */
int32_t tri_list_pieces(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const tri_triangle_id *corner,
                        struct tri_piece *piece, int32_t *skipped);

/* In random rounds that double, in each in the order of the list. The pieces come from malloc, as what replaces them.
 * False: out of memory, nothing has changed. O(n) */
bool tri_put_in_rounds(struct tri_piece **piece, int32_t n);

/* Cuts (*piece)[*n], at least one of them, at the stops on their way, and leaves one of each elementary piece, with the
 * course of all that run along it: piece i runs from stop[reach[i][0]] to stop[reach[i][1]], the first before the
 * second, through all stops between. Pieces come in the order of their first segments, and from malloc, as what
 * replaces them. O((*n + n_stops) log *n). false: out of memory, nothing has changed. */
bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n);

/* The triangle through which a segment leaves its end *from towards *to, which may be exchanged; TRI_NONE: none. */
typedef tri_triangle_id tri_exit(void *context, tri_vertex_id *from, tri_vertex_id *to);

/* Replaces pieces that run along each other by what the rule in bundle.c makes of them, which come first; the others
 * follow as they were. (*piece)[*n]: from malloc, as what replaces it; its ends are below n_vertices and differ, its
 * courses need not increase afterwards. *looked_at grows by the triangles walked through. false: out of memory; then
 * (*piece)[*n] has lost some. */
bool tri_share_bundles(const struct tri_mesh *mesh, int32_t n_vertices, struct tri_piece **piece, int32_t *n,
                       tri_exit *find_exit, void *context, int64_t *looked_at);

#endif
