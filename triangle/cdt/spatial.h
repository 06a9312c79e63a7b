/* Vertices are in spatial order while the mesh is made, and in input order at the end.
 *
 * Input points may be in any order. Most time is spent loading data of neighbouring points, so points are first sorted
 * along the Hilbert curve, and get their input numbers back when the mesh is finished. (Measured with a million random
 * points: docs/performance.md.) In between, vertex v < n_input is input point mesh->origin[v]. */
#ifndef TRIANGLE_CDT_SPATIAL_H
#define TRIANGLE_CDT_SPATIAL_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Sorts the vertices of a mesh without triangles along the curve, equal ones by index, and sets mesh->origin.
 * (*place)[n_input], from malloc, receives the new number of each point. O(n). TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_sort_points(struct tri_mesh *mesh, int32_t **place, const struct tri_executor *executor,
                                struct tri_error *error);

/* Gives the input points their input numbers back. Does nothing if mesh->origin is NULL. O(n). TRI_NO_MEMORY: nothing
 * has changed. */
enum tri_status tri_restore_points(struct tri_mesh *mesh, const struct tri_executor *executor,
                                   struct tri_error *error);

#endif
