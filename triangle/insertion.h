/* One point more in a Delaunay triangulation, by a worker who keeps to a stretch of vertices.
 *
 * The plane outside the hull is tiled by ghosts: triangles of a hull edge and a vertex at infinity (TRI_GHOST). The
 * "circumdisk" of a ghost is the open half plane beyond its hull edge, and the open edge itself; with that, insertion
 * knows no special case outside the hull. INVARIANT: every edge of every triangle, real or ghost, has a neighbour.
 *
 * STRETCHES. Vertices are numbered, and a stretch is a range of numbers. It owns the triangles whose corners all lie
 * in the range, where infinity counts as in every range. A point is inserted only if the stretch owns its whole
 * cavity.
 * THEOREM. Stretches that are disjoint may insert at the same time; the result is that of one after the other, in any
 * order. Proof: every edge has an end other than infinity, so triangles of different owners share no edge. What a
 * stretch writes are triangles it owns, two triangles that are the insertion's alone, and links back to these in
 * triangles just outside the cavity. Such a triangle shares a corner in the range, so nobody else owns it or changes
 * its corners; and nobody else reads or writes its link across an edge of the stretch. What a stretch reads are
 * corners and links of what it owns, and corners of their neighbours: the same argument. New triangles have corners of
 * the cavity and the new vertex, so the stretch owns them: what it has owned it goes on owning, and what others own it
 * never does.
 *
 * Beside triangle/cavity.h this is a search of its own: here every edge has a neighbour and some have a corner at
 * infinity, the stretch is a range of numbers, and nothing but links is wanted; there edges may be subsegments, which
 * are told apart, the fence is a box, and regions and coordinates are kept for those who judge the fan. One search
 * for both would ask of each triangle what only one of its two callers wants to know.
 *
 * A disk without a vertex inside is replaced by two triangles more than it had, whatever its place: so who inserts n
 * points knows beforehand how many triangles that takes, and nobody needs to be asked for room. */
#ifndef TRIANGLE_INSERTION_H
#define TRIANGLE_INSERTION_H

#include "triangle/mesh.h"

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

#endif
