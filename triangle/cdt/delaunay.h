/* Delaunay triangulation of a point set. */
#ifndef TRIANGLE_CDT_DELAUNAY_H
#define TRIANGLE_CDT_DELAUNAY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Triangulates the convex hull of the vertices of a mesh without triangles; tri_sort_points must have sorted the
 * vertices. Cocircular ties are broken by coordinates, and the numbering of triangles and hull edges depends on their
 * vertices only. So the result depends only on the set of points. Duplicates are not inserted; mesh->twin then maps
 * every point to the first one at its place. Every hull edge becomes a subsegment without an input segment. Collinear
 * points give no triangle, and TRI_OK. Expected O(n log n) for any set of points. */
enum tri_status tri_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

/* Makes the same mesh with leaves of at least leaf_size vertices; for tests. */
enum tri_status tri_delaunay_in_leaves(struct tri_mesh *mesh, int32_t leaf_size, const struct tri_executor *executor,
                                       struct tri_error *error);

/* --- insertion of one point into a Delaunay triangulation, restricted to a stretch of vertices
 *
 * The plane outside the hull is tiled by ghosts: triangles of a hull edge and a vertex at infinity (TRI_GHOST). The
 * "circumdisk" of a ghost is the open half plane beyond its hull edge, together with the open edge itself. With these
 * disks, insertion needs no special case outside the hull. INVARIANT: every edge of every triangle, real or ghost, has
 * a neighbour.
 *
 * STRETCHES. A stretch is a range of vertex numbers. It owns the triangles whose corners all lie in the range; the
 * vertex at infinity lies in every range. A point is inserted only if the stretch owns its whole cavity. THEOREM
 * (docs/theory.md, stretches). Disjoint stretches may insert in parallel; the result is the same as when they run one
 * after another, in any order.
 *
 * A cavity, a disk without a vertex inside, is replaced by two more triangles than it had. So n points need a known
 * number of triangles, and no further memory is allocated for them. */

enum { TRI_GHOST = -2 };

struct tri_inserter_edge;
struct tri_inserter_pending;

struct tri_inserter {
    const struct tri_point *xy; /* coordinates of all vertices */
    struct tri_triangle *tri;   /* all triangles, ghosts included */
    struct tri_range stretch;   /* the vertices that it may connect */
    tri_triangle_id last; /* a triangle that the stretch owns, near the last location; TRI_NONE: none is known */
    int32_t n_cavity, n_edges, capacity;  /* of the arrays below */
    tri_triangle_id *cavity;              /* [n_cavity] triangles of the cavity */
    struct tri_inserter_edge *edge;       /* [n_edges] boundary of the cavity, counter-clockwise */
    struct tri_inserter_pending *pending; /* stack of edges that the search has not crossed yet */
};

/* Frees the arrays allocated by insertions. */
void tri_inserter_free(struct tri_inserter *b);

/* Makes the first triangle, from three vertices that are not collinear, and its three ghosts, in triangles `triangle`
 * to `triangle` + 3. */
void tri_insert_first(const struct tri_point *xy, struct tri_triangle *tri, tri_triangle_id triangle,
                      const tri_vertex_id v[3]);

/* Returns the corner at infinity; -1: none. */
static inline int tri_ghost_corner(const struct tri_triangle *t)
{
    return t->v[0] == TRI_GHOST ? 0 : t->v[1] == TRI_GHOST ? 1 : t->v[2] == TRI_GHOST ? 2 : -1;
}

/* Does the stretch own this triangle? */
bool tri_inserter_owns(const struct tri_inserter *b, const struct tri_triangle *t);

/* Returns a triangle that the stretch owns and whose disk holds q. Returns TRI_NONE if the walk from `last` leaves the
 * triangles that the stretch owns. Sets `last`. */
tri_triangle_id tri_inserter_locate(struct tri_inserter *b, struct tri_point q);

enum tri_insertion { TRI_INSERTED, TRI_NOT_OWNED, TRI_INSERTION_NO_MEMORY };

/* Inserts vertex v of the stretch, which must not coincide with an inserted vertex. Uses triangles `triangle` and
 * `triangle` + 1. TRI_NOT_OWNED: the stretch does not own the cavity, or did not reach it; nothing has changed. */
enum tri_insertion tri_insert(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id triangle);

/* Copies the triangulation in tri[n_triangles] to the mesh, which has no triangles and subsegments. n_live is the
 * number of triangles without ghosts and free ones. Ghosts become subsegments, counter-clockwise around the hull from
 * its lowest vertex. A triangle begins at the lower end of its shortest edge, and triangles are sorted by that vertex,
 * then by the next one: refinement works at short edges, and later stages run faster if neighbours are near in memory.
 * Destroys the contents of tri[]. O(n). */
enum tri_status tri_curve_sort(struct tri_mesh *mesh, struct tri_triangle *tri, int32_t n_triangles,
                               int32_t n_live, const struct tri_executor *executor, struct tri_error *error);

#endif
