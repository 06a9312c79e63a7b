/* Which parents are at a vertex, and how two of them meet. */
#ifndef TRIANGLE_MESH_PARENTS_H
#define TRIANGLE_MESH_PARENTS_H

#include "triangle/mesh/mesh.h"

/* Lists the parents at each vertex that there is, in mesh->incidence. O(vertices + parents log parents) at most. */
enum tri_status tri_incidence_list(struct tri_mesh *mesh, struct tri_error *error);

/* Lists them anew, in the same arrays, when vertices have got other numbers. */
void tri_incidence_fill(struct tri_mesh *mesh);

/* The parents at u that bound spaces in which triangle u, v, w may lie: at a hub of many the next ones around it, which
 * are put into beside[], else all. *n: how many. */
const tri_parent_id *tri_parents_beside(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, tri_vertex_id w,
                                        tri_parent_id beside[8], int32_t *n);

/* Is the direction from o to a before that to b, counter-clockwise from that of the axis of x? */
bool tri_turns_before(struct tri_point o, struct tri_point a, struct tri_point b);

/* How two parents meet. */
enum tri_corner {
    TRI_APART,         /* not at all, or they are the same */
    TRI_WIDE_CORNER,   /* at 60 degrees or more */
    TRI_NARROW_CORNER, /* at less */
    TRI_SPIKE          /* at so little that the space between is not filled: a quarter of a degree */
};
enum tri_corner tri_corner_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q);

/* Does the vertex touch the parent, as far as coordinates tell: is it an end of it, or nearer than the square root of
 * limits.shortest2? */
bool tri_touches(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

/* Does the vertex lie on a parent? */
bool tri_is_on_parent(const struct tri_mesh *mesh, tri_vertex_id v);

/* The common end of a parent and a parent that vertex v lies on; TRI_NONE where there is none. O(parents at v). */
tri_vertex_id tri_common_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

#endif
