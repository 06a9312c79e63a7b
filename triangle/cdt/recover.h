/* Recovery of an edge: finds where it leaves its first vertex, and retriangulates the area of the triangles that it
 * crosses. */
#ifndef TRIANGLE_CDT_RECOVER_H
#define TRIANGLE_CDT_RECOVER_H

#include "triangle/mesh/mesh.h"

/* Work space, reused between calls; initialise with zeros. */
struct tri_recovery {
    int32_t n_crossed, n_left; /* of the last call: number of crossed triangles; number of vertices on the left chain */
    tri_halfedge *crossed;     /* [n_crossed] codes of their edges; the new triangles reuse these numbers */
    tri_triangle_id *pool;     /* [n_crossed] free numbers among these triangles */
    int32_t n_free, crossed_capacity, room; /* entries of `pool`; capacities */
    struct tri_recovery_place *at;          /* [n_crossed + 4] the places of both chains */
    struct tri_recovery_node *gap[2];       /* the two sides of the gap during a merge */
};

void tri_recovery_free(struct tri_recovery *r);

/* Makes ab an edge of a constrained Delaunay mesh and keeps it constrained Delaunay, with ties broken as by
 * tri_in_circle. The union of the m triangles that the open segment ab crosses is split into the polygon left of ab and
 * the one right of it, and each gets its constrained Delaunay triangulation. t is the triangle at a through whose
 * interior ab leaves. No vertex or subsegment may lie on, or cross, the open segment. *code receives the half-edge of
 * the triangle left of a -> b; ab is not a subsegment yet. Triangles keep their regions. O(m log m) time, O(m) memory.
 * TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_recover_edge(struct tri_recovery *r, struct tri_mesh *mesh, tri_triangle_id t,
                                 tri_vertex_id a, tri_vertex_id b, tri_halfedge *code, struct tri_error *error);

/* Returns the triangle through which the segment leaves its end *a towards *b; TRI_NONE if there is none. If *a is a
 * hub, with many triangles, the search alternates between both ends, and the ends are exchanged if it succeeds at *b
 * first. So the cost depends on the end with fewer triangles. The result is stored in corner[*a], so segments of a fan,
 * in order, cost O(1) each. corner[v]: a triangle at v. */
tri_triangle_id tri_find_exit(const struct tri_mesh *mesh, tri_triangle_id *corner, tri_vertex_id *a, tri_vertex_id *b);

#endif
