/* Attributes of vertices that are not in the input. A crossing of segments interpolates the attributes along one of
 * them. New vertices get their attributes from a piecewise linear surface over the triangles of the mesh before
 * refinement. Refinement itself sets no attributes. A copy of the mesh before refinement is kept, and when the mesh, or
 * a tile of it, is finished, each new vertex is located in the copy. So attributes depend only on the positions of the
 * vertices. */
#ifndef TRIANGLE_MESH_SURFACE_H
#define TRIANGLE_MESH_SURFACE_H

#include "triangle/mesh/mesh.h"

/* Interpolates the attributes of vertices a and b into to[n_attributes], at the projection of p on the line through
 * them, or at the nearer end if the projection lies beyond it. */
void tri_interpolate_edge(const struct tri_mesh *mesh, tri_vertex_id a, tri_vertex_id b, struct tri_point p,
                          double *to);

/* Copies the current mesh to mesh->surface. Does nothing if vertices have no attributes or there is a surface already.
 * All attributes must be set. Uses 50 bytes per triangle and 32 per vertex, and 16 more per triangle temporarily.
 * TRI_NO_MEMORY: no surface has been made. */
enum tri_status tri_surface_keep(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);
void tri_surface_free(struct tri_surface *surface);

/* Sets the attributes of n new vertices. Fastest if the list follows a curve through the plane. Each value lies within
 * the range of its triangle's corners. The error is at most 2^-48 of the largest difference between them, plus 2^-53 of
 * the value, in thin triangles as well. Calls for different vertices may run in parallel. */
void tri_surface_set(const struct tri_mesh *mesh, const tri_vertex_id *vertices, int32_t n);

/* Sets the attributes of all vertices that have none yet. */
void tri_surface_settle(struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
