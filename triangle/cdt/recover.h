/* Recovery of an edge: where it leaves its first vertex, and how the triangles that it crosses make way for it. */
#ifndef TRIANGLE_CDT_RECOVER_H
#define TRIANGLE_CDT_RECOVER_H

#include "triangle/mesh/mesh.h"

/* Work space, kept from call to call; all zero to begin with. */
struct tri_recovery {
    int32_t n_crossed, n_left; /* what the last call has replaced: so many triangles; vertices left of the edge */
    tri_halfedge *crossed;     /* [n_crossed] codes of their edges; the new triangles get the numbers of these */
    tri_triangle_id *pool;     /* [n_crossed] free ones among these triangles */
    int32_t n_free, crossed_capacity, room;
    struct tri_recovery_place *at;
    struct tri_recovery_node *gap[2];
};

void tri_recovery_free(struct tri_recovery *r);

/* Makes ab an edge of a mesh that is constrained Delaunay, ties broken as by tri_in_circle, and keeps it so: of the
 * union of the m triangles that the open segment ab crosses, the polygon left of ab and that on the right each get
 * their constrained Delaunay triangulation. t is the triangle at a through whose interior ab leaves. Neither a vertex
 * nor a subsegment lies on, or crosses, the open segment. *code receives the edge as the triangle left of a -> b sees
 * it; ab is no subsegment yet. Triangles keep their regions. O(m log m) time, O(m) memory; TRI_NO_MEMORY comes before
 * anything is changed. */
enum tri_status tri_recover_edge(struct tri_recovery *r, struct tri_mesh *mesh, tri_triangle_id t,
                                 tri_vertex_id a, tri_vertex_id b, tri_halfedge *code, struct tri_error *error);

/* The triangle through which the segment leaves its end *a towards *b. Where *a is a hub, with many triangles, the
 * search goes on around both ends in turns, and the two are exchanged if it succeeds at *b: so the cost is that of the
 * end with fewer triangles. Remembered as the corner, so that the edges of a fan in order cost O(1) each.
 * TRI_NONE: there is none. corner[v]: a triangle at v. */
tri_triangle_id tri_find_exit(const struct tri_mesh *mesh, tri_triangle_id *corner, tri_vertex_id *a, tri_vertex_id *b);

#endif
