/* The parents at each vertex, and how two of them meet. */
#ifndef TRIANGLE_MESH_PARENTS_H
#define TRIANGLE_MESH_PARENTS_H

#include "triangle/mesh/mesh.h"

/* Lists the parents at each vertex in mesh->incidence. O(vertices + parents log parents). */
enum tri_status tri_incidence_list(struct tri_mesh *mesh, struct tri_error *error);

/* Lists them again in the same arrays, after vertices have been renumbered. */
void tri_incidence_fill(struct tri_mesh *mesh);

/* Returns the parents at u that bound the sectors in which triangle u, v, w may lie, and their number in *n. At a hub
 * these are the nearest ones on both sides, stored in beside[]; otherwise all parents at u. */
const tri_parent_id *tri_parents_beside(const struct tri_mesh *mesh, tri_vertex_id u, tri_vertex_id v, tri_vertex_id w,
                                        tri_parent_id beside[8], int32_t *n);

/* Does the direction from o to a come before that from o to b, counter-clockwise from the direction of the x axis? */
bool tri_turns_before(struct tri_point o, struct tri_point a, struct tri_point b);

/* How two parents meet. */
enum tri_corner {
    TRI_APART,         /* not at all, or they are the same parent */
    TRI_WIDE_CORNER,   /* at 60 degrees or more */
    TRI_NARROW_CORNER, /* at less than 60 degrees */
    TRI_SPIKE          /* at less than a quarter of a degree: the space between is not filled */
};
enum tri_corner tri_corner_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q);

/* Is the vertex an end of the parent, or nearer to it than the square root of limits.shortest2? */
bool tri_touches(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

/* Does the vertex lie on a parent? */
bool tri_is_on_parent(const struct tri_mesh *mesh, tri_vertex_id v);

/* Returns a common end of the parent and a parent on which vertex v lies, or TRI_NONE. O(parents at v). */
tri_vertex_id tri_common_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

#endif
