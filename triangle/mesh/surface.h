/* Attributes of vertices that the input does not have. A crossing of segments interpolates them along one of these. New
 * vertices lie on the surface that is linear in each triangle of the input's own triangulation: refinement sets no
 * attributes, but a copy of the triangulation is kept as it was before. When the mesh, or a tile of it, is finished,
 * each new vertex is located in the copy. So attributes depend on places alone. */
#ifndef TRIANGLE_MESH_SURFACE_H
#define TRIANGLE_MESH_SURFACE_H

#include "triangle/mesh/mesh.h"

/* Sets to[n_attributes] between those of vertices a and b, at the foot of the perpendicular from p on the line through
 * them, or at the nearer end if the foot lies beyond it. */
void tri_interpolate_edge(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p,
                          double *to);

/* Copies the mesh as it is now to mesh->surface, if vertices have attributes, all of them, and there is no surface yet.
 * 50 bytes a triangle and 32 a vertex, and 16 more a triangle while it runs. TRI_NO_MEMORY: there is none. */
enum tri_status tri_surface_keep(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);
void tri_surface_free(struct tri_surface *surface);

/* Sets the attributes of n new vertices. The list should follow a curve through the plane: that is fastest. A value
 * lies within the range of its triangle's corners. It errs by at most 2^-48 of the largest difference between them, and
 * 2^-53 of itself, also in thin triangles. Calls for different vertices may run at the same time. */
void tri_surface_set(const struct tri_mesh *mesh, const tri_vertex_id *vertices, int32_t n);

/* Sets those of all vertices that have none yet. */
void tri_surface_settle(struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
