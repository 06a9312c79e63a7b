/* Delaunay triangulation of a point set. */
#ifndef TRIANGLE_CDT_DELAUNAY_H
#define TRIANGLE_CDT_DELAUNAY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Triangulates the convex hull of the mesh's vertices (which has no triangles yet), which tri_sort_points has sorted.
 * Cocircular ties are broken by coordinates, and triangles and hull edges are numbered by what they are: the result
 * depends on the set of points alone. Duplicates stay out: mesh->twin then maps every point to the first one at its
 * place. Every hull edge becomes a subsegment without input segment. Collinear points give no triangle, TRI_OK.
 * Expected O(n log n) for any set of points. */
enum tri_status tri_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

/* The same mesh by leaves of at least so many vertices; for tests. */
enum tri_status tri_delaunay_in_leaves(struct tri_mesh *mesh, int32_t leaf_size, const struct tri_executor *executor,
                                       struct tri_error *error);

/* --- one point more in a Delaunay triangulation, by a worker who keeps to a stretch of vertices.
 *
 * The plane outside the hull is tiled by ghosts: triangles of a hull edge and a vertex at infinity (TRI_GHOST). The
 * "circumdisk" of a ghost is the open half plane beyond its hull edge, and the open edge itself; with these disks,
 * insertion knows no special case outside the hull. INVARIANT: every edge of every triangle, real or ghost, has a
 * neighbour.
 *
 * STRETCHES. Vertices are numbered, and a stretch is a range of numbers. It owns the triangles whose corners all lie in
 * the range, where infinity counts as in every range. A point is inserted only if the stretch owns its whole cavity.
 * THEOREM (docs/theory.md, stretches). Stretches that are disjoint may insert at the same time; the result is that of
 * one after the other, in any order.
 *
 * A disk without a vertex inside is replaced by two triangles more than it had. So n points take a known number of
 * triangles, and nobody needs to be asked for room. */

enum { TRI_GHOST = -2 };

struct tri_inserter_edge;
struct tri_inserter_pending;

struct tri_inserter {
    const struct tri_point *xy;
    struct tri_triangle *tri;
    struct tri_range stretch;
    tri_triangle_id last; /* a triangle that the stretch owns, near the last place looked at; TRI_NONE: none is known */
    int32_t n_cavity, n_edges, capacity;
    tri_triangle_id *cavity;              /* [n_cavity] triangles */
    struct tri_inserter_edge *edge;       /* [n_edges] their boundary, counter-clockwise */
    struct tri_inserter_pending *pending; /* stack of the search */
};

/* Frees what insertions have allocated. */
void tri_inserter_free(struct tri_inserter *b);

/* The first triangle, with its three ghosts, of three vertices that are not collinear, in four triangles. */
void tri_insert_first(const struct tri_point *xy, struct tri_triangle *tri, tri_triangle_id triangle,
                      const tri_vertex_id v[3]);

/* Which corner is at infinity? -1: none. */
static inline int tri_ghost_corner(const struct tri_triangle *t)
{
    return t->v[0] == TRI_GHOST ? 0 : t->v[1] == TRI_GHOST ? 1 : t->v[2] == TRI_GHOST ? 2 : -1;
}

/* Does the stretch own this triangle? */
bool tri_inserter_owns(const struct tri_inserter *b, const struct tri_triangle *t);

/* A triangle whose disk holds q, and which the stretch owns; TRI_NONE where the way there from `last` leaves what it
 * owns. Sets `last`. */
tri_triangle_id tri_inserter_locate(struct tri_inserter *b, struct tri_point q);

enum tri_insertion { TRI_INSERTED, TRI_NOT_OWNED, TRI_INSERTION_NO_MEMORY };

/* Inserts vertex v, of the stretch and at a place where no vertex is; takes this triangle and the next. TRI_NOT_OWNED:
 * the stretch does not own the cavity, or did not find it; nothing has changed. */
enum tri_insertion tri_insert(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id triangle);

/* The mesh, which has neither triangles nor subsegments, receives those of tri[n_triangles]: a triangulation of its
 * vertices, n_live triangles with ghosts and free triangles. Ghosts become subsegments,
 * counter-clockwise around the hull from its lowest vertex. A triangle begins at the lower end of its shortest edge,
 * and triangles are sorted by that vertex, then by the next: there is the work of refinement, however far the rest of a
 * triangle reaches, and every later stage runs faster where neighbours are near in memory. tri[] is in ruins
 * afterwards. O(n). */
enum tri_status tri_curve_sort(struct tri_mesh *mesh, struct tri_triangle *tri, int32_t n_triangles,
                               int32_t n_live, const struct tri_executor *executor, struct tri_error *error);

#endif
