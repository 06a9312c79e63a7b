/* Which ground a triangle had before edges were flipped. */
#ifndef TRIANGLE_CDT_FLIP_HISTORY_H
#define TRIANGLE_CDT_FLIP_HISTORY_H

#include "triangle/mesh/mesh.h"

struct tri_flip_record;

/* All flips since regions were last right, so that regions can stay where they were: 4 bytes a triangle and 24 a flip,
 * no more than a million flips, or 4 a triangle, at a time. */
struct tri_flip_history {
    int32_t *last; /* [n_triangles] number of the last flip of each triangle, or TRI_NONE */
    struct tri_flip_record *flip;
    int32_t n, capacity;
};

/* Nothing has been flipped yet. False: out of memory. */
bool tri_flip_history_begin(struct tri_flip_history *history, const struct tri_mesh *mesh);
void tri_flip_history_free(struct tri_flip_history *history);

/* Edge e of triangle t is going to be flipped. Until tri_flip_history_settle each triangle keeps the region that its
 * number had. False: out of memory. */
bool tri_flip_history_add(struct tri_flip_history *history, struct tri_mesh *mesh, tri_triangle_id t, int e);

/* Every flipped triangle gets the region in which its centroid lay before the flips; the history begins anew.
 * O(triangles), and for each that was flipped as many steps as flips at that place. */
void tri_flip_history_settle(struct tri_flip_history *history, struct tri_mesh *mesh);

#endif
