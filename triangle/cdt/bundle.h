/* Segments that run along each other within rounding. */
#ifndef TRIANGLE_CDT_BUNDLE_H
#define TRIANGLE_CDT_BUNDLE_H

#include "triangle/cdt/overlap.h"

/* The triangle through which a segment leaves its end *from towards *to, which may be exchanged; TRI_NONE: none. */
typedef tri_triangle_id tri_exit(void *context, tri_vertex_id *from, tri_vertex_id *to);

/* Replaces pieces that run along each other by what the rule in bundle.c makes of them, which come first; the others
 * follow as they were. (*piece)[*n]: from malloc, as what replaces it; its ends are below n_vertices and differ, its
 * courses need not increase afterwards. *looked_at grows by the triangles walked through. false: out of memory; then
 * (*piece)[*n] has lost some. */
bool tri_share_bundles(const struct tri_mesh *mesh, int32_t n_vertices, struct tri_piece **piece, int32_t *n,
                       tri_exit *find_exit, void *context, int64_t *looked_at);

#endif
