/* Cavity insertion. The triangles that a new point replaces are found completely before the mesh is changed.
 *
 * The cavity of a point p is the set of triangles whose circumdisk holds p, connected without crossing a subsegment.
 * Its boundary, seen from p, is a closed chain of edges in counter-clockwise order.
 *
 * THEOREM (star shape; docs/theory.md, cavities). The search begins at a triangle with p in its circumdisk, and needs
 * no point location. It sees every edge counter-clockwise from p, except subsegments of the first triangle if p lies
 * beyond them. The caller tests the side of these walls.
 *
 * THEOREM (encroachment is local). Let no vertex of the mesh encroach subsegment e, and let p encroach e and see it.
 * Then e is a wall of p's own cavity.
 *
 * The search stores coordinates relative to p, so each step loads one triangle and one vertex. The incircle filter uses
 * the bound (10 + 96 u) u of Shewchuk (1997), with the permanent overestimated by Cauchy-Schwarz. If the filter cannot
 * decide a sign, exact arithmetic does. */
#ifndef TRIANGLE_MESH_CAVITY_H
#define TRIANGLE_MESH_CAVITY_H

#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"

struct tri_relative {
    double x, y, l; /* position relative to the new point; squared distance to it */
};

struct tri_cavity_corner {
    struct tri_relative r; /* position relative to the new point */
    tri_vertex_id v;       /* the vertex */
};

struct tri_cavity_edge {
    double area2; /* twice the area of the triangle on this edge: the cross product of its ends */
    const struct tri_cavity_corner *a; /* the edge starts here; it ends where the next edge starts */
    tri_link outer;       /* link to the neighbour across the edge */
    tri_region_id region; /* region of the cavity triangle on the inner side */
};

struct tri_pending { /* an edge that the search has not crossed yet; it starts where the last boundary edge ends */
    double area2;
    const struct tri_cavity_corner *end;
    tri_link link;
    tri_region_id region;
};

struct tri_cavity {
    struct tri_point p;            /* the new point */
    const struct tri_fence *fence; /* NULL: all triangles are owned */
    const struct tri_owners *owners; /* for asserts in debug builds; NULL: none */
    tri_vertex_id beyond[2];       /* after TRI_SEARCH_BEYOND: the ends of the edge with that link */
    int32_t n_tri, n_corners, n_edges, n_wall, capacity; /* lengths of the arrays below; their common capacity */
    int32_t n_left_tri;   /* of a split: number of triangles left of the subsegment, which come first */
    tri_region_id region; /* region of the triangle at which the search began */
    uint32_t mixed;       /* not 0: the cavity has triangles of several regions without subsegments between them */
    tri_triangle_id *tri; /* the cavity's triangles; after filling, those of the fan, one for each edge */
    struct tri_cavity_corner *corner; /* in the order found: at most n_tri + 4, and the one being tested */
    struct tri_cavity_edge *edge;  /* at most n_tri + 2 edges, and one entry that marks the end of the last one */
    int32_t *wall;        /* indices of the edges whose outer link is a subsegment */
    struct tri_pending *pending;   /* stack of the search */
};

enum tri_search {
    TRI_SEARCH_FOUND,
    TRI_SEARCH_FENCED,   /* a triangle of the cavity is outside the fence */
    TRI_SEARCH_BEYOND,   /* a triangle that may belong to the cavity is not in this address space (TRI_BEYOND) */
    TRI_SEARCH_OUTSIDE,  /* the point is not in the circumdisk of the start triangle, or coincides with a vertex */
    TRI_SEARCH_NO_MEMORY /* out of memory for the arrays of the cavity */
};

/* Returns whether all corners of the triangle lie in the fence. fence == NULL: always true. */
bool tri_fence_owns(const struct tri_fence *fence, const struct tri_mesh *mesh, tri_triangle_id t);

void tri_cavity_free(struct tri_cavity *cavity);

/* Finds the cavity of p, starting at triangle t. Reads the mesh only. O(cavity); expected O(1) in a good mesh. */
enum tri_search tri_cavity_search(struct tri_cavity *cavity, const struct tri_mesh *mesh, struct tri_point p,
                                  tri_triangle_id t);

/* The same for a point on subsegment s, up to rounding, at which s will be split. The chain holds the edges left of s
 * from its end to its start and then, if there is a triangle on the right, the edges right of s from start to end.
 * *n_left receives the number of edges on the left. Also returns TRI_SEARCH_OUTSIDE if p does not see every edge, or is
 * not in the disk of a triangle beside s (because that triangle is flatter than rounding). */
enum tri_search tri_cavity_search_split(struct tri_cavity *cavity, const struct tri_mesh *mesh, struct tri_point p,
                                        tri_sub_id s, int32_t *n_left);

/* Replaces the cavity by the fan of vertex v, whose coordinates are already stored and equal cavity->p. Corner 0 of
 * each new triangle is v, corner 1 is the start of its edge. The caller has reserved room for two more triangles. */
void tri_cavity_fill(struct tri_cavity *cavity, struct tri_mesh *mesh, tri_vertex_id v);

/* The same after tri_cavity_search_split: subsegment s becomes (v[0], v), and a new one (v, v[1]) is appended and
 * returned. The caller has reserved room for one more subsegment. */
tri_sub_id tri_cavity_fill_split(struct tri_cavity *cavity, struct tri_mesh *mesh, tri_vertex_id v, tri_sub_id s,
                                 int32_t n_left);

static inline struct tri_relative tri_relative(const struct tri_point *q, struct tri_point p)
{
    double x = q->x - p.x, y = q->y - p.y;
    struct tri_relative relative = {x, y, x * x + y * y};
    return relative;
}

/* tri_cavity_fill in two steps, for callers that process each new triangle as it is made. tri_cavity_number_fan assigns
 * numbers to the triangles of the fan. tri_make_fan_triangle makes triangle `own` on an edge, between its neighbours
 * `before` and `behind`. */
void tri_cavity_number_fan(struct tri_cavity *cavity, struct tri_mesh *mesh);

static inline void tri_make_fan_triangle(struct tri_mesh *mesh, tri_vertex_id v, const struct tri_cavity_edge *edge,
                                         tri_triangle_id before, tri_triangle_id own, tri_triangle_id behind)
{
    const tri_vertex_id a = edge[0].a->v, b = edge[1].a->v;
    struct tri_triangle *t = &mesh->tri[own];
    assert(a != b && a != v && b != v);
    *t = (struct tri_triangle){{v, a, b}, {edge->outer, tri_code(behind, 2), tri_code(before, 1)}, edge->region,
                               t->generation + 1};
    tri_relink(mesh, edge->outer, a, tri_code(own, 0));
}

/* Twice the area of the triangle p, a, b. */
static inline double tri_cross(struct tri_relative a, struct tri_relative b) { return a.x * b.y - a.y * b.x; }

#endif
