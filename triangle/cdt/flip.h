/* Edge flips, which turn any triangulation into the constrained Delaunay triangulation. */
#ifndef TRIANGLE_CDT_FLIP_H
#define TRIANGLE_CDT_FLIP_H

#include "triangle/mesh/mesh.h"

/* Flips edges that are not subsegments until the mesh is constrained Delaunay. Edges between four cocircular points are
 * not flipped. Regions keep their places: a flipped triangle gets the region in which its centroid lay before. A region
 * too narrow to hold a centroid disappears. O(triangles) if there is little to do, and near that in practice. The
 * number of flips may be quadratic (a fan of n triangles over a thin ellipse); then the history is processed in parts.
 * After TRI_NO_MEMORY the mesh is valid, except for its regions. */
enum tri_status tri_flip_to_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor,
                                     struct tri_error *error);

struct tri_flip_history;

/* Local flips: the caller touches triangles that it has changed, and then legalises them. Without a history, a triangle
 * keeps the region of its number. */
struct tri_flips {
    struct tri_mesh *mesh; /* the mesh whose edges are flipped; not owned */
    struct tri_flip_history *history; /* records each flip; not owned; NULL: none */
    tri_triangle_id *corner; /* [vertices] a live triangle at each vertex, updated by flips; not owned; NULL: none */
    int32_t *degree;         /* [vertices] triangles at each vertex, updated by flips; not owned; NULL: none */
    const int32_t *home;     /* [vertices] the block of each vertex; not owned; NULL: no limit */
    int32_t block;           /* with home: flip edges only if all four corners belong to this block */
    bool ties_stay;          /* do not flip between four cocircular points; false: coordinates break the tie */
    tri_halfedge *touched;   /* stack of edges to test for the Delaunay property */
    int32_t n_touched, capacity; /* of `touched` */
};

void tri_flips_free(struct tri_flips *flips);

/* Pushes the three edges of triangle t to be tested. Returns false if out of memory. */
bool tri_flip_touch(struct tri_flips *flips, tri_triangle_id t);

/* Flips edge e of t, whose quadrilateral is strictly convex, even if it is Delaunay. Edge 1 of t is the new one; three
 * more flips of it restore both triangles. Returns the neighbour across it. */
tri_triangle_id tri_flip_edge(struct tri_flips *flips, tri_triangle_id t, int e);

/* Lawson's algorithm: flips until all touched edges are Delaunay. Returns false if out of memory; then the mesh is
 * valid. */
bool tri_flip_legalise(struct tri_flips *flips);

/* Regions of triangles before edges were flipped. */

struct tri_flip_record;

/* All flips since the regions were last updated. Uses 4 bytes per triangle and 24 per flip, for at most a million
 * flips, or four per triangle if that is more. */
struct tri_flip_history {
    int32_t *last; /* [n_triangles] number of the last flip of each triangle, or TRI_NONE */
    struct tri_flip_record *flip; /* [n] in order of time */
    int32_t n, capacity;          /* of `flip` */
};

/* Makes an empty history. Returns false if out of memory. */
bool tri_flip_history_begin(struct tri_flip_history *history, const struct tri_mesh *mesh);
void tri_flip_history_free(struct tri_flip_history *history);

/* Records that edge e of triangle t is about to be flipped. Until tri_flip_history_settle each triangle keeps the
 * region of its number. Returns false if out of memory. */
bool tri_flip_history_add(struct tri_flip_history *history, struct tri_mesh *mesh, tri_triangle_id t, int e);

/* Gives every flipped triangle the region in which its centroid lay before the flips, and empties the history.
 * O(triangles), plus the number of flips at the place of each flipped triangle. */
void tri_flip_history_settle(struct tri_flip_history *history, struct tri_mesh *mesh);

#endif
