/* Vertices in spatial order while the mesh is made, in the caller's order at the end.
 *
 * A caller's points lie in memory in any order. The kernel's time is the time to fetch what is near in the plane, so
 * points are sorted along the Hilbert curve first, and get their own numbers back when the mesh is done. (Measured on a
 * million random points: docs/performance.md.) In between, vertex v < n_input is the caller's point
 * mesh->origin[v]. */
#ifndef TRIANGLE_CDT_SPATIAL_H
#define TRIANGLE_CDT_SPATIAL_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Sorts the vertices of a mesh without triangles along the curve, equal ones by index, and sets mesh->origin.
 * (*place)[n_input], malloc'ed, tells where each point went. O(n). TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_sort_points(struct tri_mesh *mesh, int32_t **place, const struct tri_executor *executor,
                                struct tri_error *error);

/* Gives the caller's points their own numbers back; nothing to do where mesh->origin is NULL. O(n).
 * TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_restore_points(struct tri_mesh *mesh, const struct tri_executor *executor,
                                   struct tri_error *error);

#endif
