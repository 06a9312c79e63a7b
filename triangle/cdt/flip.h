/* Edge flips: from any triangulation to the constrained Delaunay triangulation. */
#ifndef TRIANGLE_CDT_FLIP_H
#define TRIANGLE_CDT_FLIP_H

#include "triangle/mesh/mesh.h"

/* Flips edges that are no subsegments until the mesh is constrained Delaunay; where four points lie on one circle it
 * stays as it is. Regions stay on their ground: a triangle that was flipped has the one in which its centroid lay in
 * the mesh as it was; ground too narrow for any centroid gives its region up. O(triangles) where little is to do, and
 * near that in practice; flips may be quadratic (a fan of n triangles over a thin ellipse), and their history is
 * then taken in parts. On TRI_NO_MEMORY the mesh is valid, but for its regions. */
enum tri_status tri_flip_to_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor,
                                     struct tri_error *error);

struct tri_flip_history;

/* The same at one place: whoever changes triangles touches them, then makes them legal. Without a history a triangle
 * keeps the region of its number. */
struct tri_flips {
    struct tri_mesh *mesh;
    struct tri_flip_history *history; /* NULL, or hears of each flip before it is made; not owned */
    tri_triangle_id *corner; /* NULL, or for each vertex a live triangle that has it as a corner, kept so; not owned */
    int32_t *degree;         /* NULL, or for each vertex the triangles at it, kept so; not owned */
    const int32_t *home;     /* NULL, or the block of each vertex: an edge is flipped only if all four corners .. */
    int32_t block;           /* .. have this block; not owned */
    bool ties_stay;          /* of four points on one circle nothing is flipped; else coordinates break the tie */
    tri_halfedge *touched;   /* stack of edges to test for the Delaunay property */
    int32_t n_touched, capacity;
};

void tri_flips_free(struct tri_flips *flips);

/* The three edges of triangle t are to be tested. False: out of memory. */
bool tri_flip_touch(struct tri_flips *flips, tri_triangle_id t);

/* Flips edge e of t, whose quadrilateral is strictly convex, whether or not it is Delaunay. Edge 1 of t is the new one;
 * flipping it leads back, up to the order of corners. Returns the neighbour across it. */
tri_triangle_id tri_flip_edge(struct tri_flips *flips, tri_triangle_id t, int e);

/* Lawson: flips what is not Delaunay until everything touched is. False: out of memory; the mesh is valid then. */
bool tri_flip_legalise(struct tri_flips *flips);

/* Which ground a triangle had before edges were flipped. */

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
