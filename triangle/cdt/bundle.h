/* Input segments as pieces, and the merging of pieces that overlap within rounding. */
#ifndef TRIANGLE_CDT_BUNDLE_H
#define TRIANGLE_CDT_BUNDLE_H

#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"

/* Summary of the input segments that run along a piece or a subsegment: the first of them, the first with a marker, and
 * whether their number is odd. */
struct tri_course {
    int32_t first, marked; /* segment numbers; TRI_NONE: there is none */
    bool odd;              /* the number of segments is odd */
};

static inline int32_t tri_earlier(int32_t a, int32_t b) { return a == TRI_NONE || (b != TRI_NONE && b < a) ? b : a; }

/* Returns the summary for the union of two sets of segments. */
static inline struct tri_course tri_course_both(struct tri_course a, struct tri_course b)
{
    struct tri_course both = {tri_earlier(a.first, b.first), tri_earlier(a.marked, b.marked), a.odd != b.odd};
    return both;
}

struct tri_piece {
    tri_vertex_id from, to; /* its ends */
    struct tri_course course; /* the input segments along it */
};

/* Lists the valid segments in piece[pslg->n_segments] and returns their number. Adds the number of invalid segments to
 * *skipped. corner[v]: a triangle at v, or TRI_NONE. */
int32_t tri_list_pieces(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const tri_triangle_id *corner,
                        struct tri_piece *piece, int32_t *skipped);

/* Sorts the pieces into random rounds that double in size; each round keeps the order of the list. The array is from
 * malloc and is replaced. Returns false if out of memory; then nothing has changed. O(n). */
bool tri_put_in_rounds(struct tri_piece **piece, int32_t n);

/* Cuts the pieces (*piece)[*n], at least one, at the stops between their ends, and keeps one copy of each elementary
 * piece, with the summary of all segments along it. Piece i runs from stop[reach[i][0]] to stop[reach[i][1]], the first
 * before the second, through all stops between. The pieces are in the order of their first segments. The array is from
 * malloc and is replaced. O((*n + n_stops) log *n). Returns false if out of memory; then nothing has changed. */
bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n);

/* Returns the triangle through which a segment leaves its end *from towards *to; TRI_NONE: none. May exchange the
 * ends. */
typedef tri_triangle_id tri_exit(void *context, tri_vertex_id *from, tri_vertex_id *to);

/* Merges pieces that run along each other by the rule in bundle.c. The merged pieces come first; the others follow
 * unchanged. The ends of each piece are different and below n_vertices. The array (*piece)[*n] is from malloc and is
 * replaced; afterwards the pieces need not be in segment order. Adds the number of visited triangles to *looked_at.
 * Returns false if out of memory; then (*piece)[*n] is incomplete. */
bool tri_share_bundles(const struct tri_mesh *mesh, int32_t n_vertices, struct tri_piece **piece, int32_t *n,
                       tri_exit *find_exit, void *context, int64_t *looked_at);

#endif
