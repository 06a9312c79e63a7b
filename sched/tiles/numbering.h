/* Numbers a mesh in memory tile by tile, in the order in which tiles are handed out (sched/tiles/tiles.h).
 *
 * The first n_kept vertices keep their numbers. The others follow tile by tile, sorted along a Hilbert curve in each
 * tile. A triangle belongs to the last tile of its corners and starts at its corner with the largest number. The
 * triangles of a tile are sorted by that corner, then by the next one. Neighbours in the plane are thus close in the
 * arrays, which makes good use of a solver's cache. A subsegment belongs to the last tile of its ends. The subsegments
 * of a tile are sorted by parent, then by the vertex at which they start. All orders use the new vertex numbers. If
 * tri_mesh.origin is set, the caller's points get their own numbers back later, and triangles keep their order. */
#ifndef SCHED_TILES_NUMBERING_H
#define SCHED_TILES_NUMBERING_H

#include "sched/schedule/partition.h"
#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Numbers a mesh. Removes free triangle numbers, subsegments with v[0] == TRI_NONE and vertices that are
 * TRI_VERTEX_NONE, to which nothing refers. The first n_kept vertices keep their numbers. They include all ends of
 * parents (the first tri_mesh.incidence.n_vertices), and none of them is free.
 *
 * Meshes whose first n_kept vertices and parents agree, and which have the same other vertices, triangles and
 * subsegments in any numbering, become identical byte for byte. O(n). TRI_NO_MEMORY: nothing has changed. */
enum tri_status par_number(struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept,
                           const struct tri_executor *executor, struct tri_error *error);

/* Returns the bytes that par_number needs besides the mesh: two numbers of each triangle and vertex, one of each
 * subsegment, a copy of all subsegments, and of half of the triangles. */
static inline double par_number_bytes(double triangles, double vertices, double subs)
{
    const double number = sizeof(int32_t);
    return (2 * number + sizeof(struct tri_triangle) / 2.0) * triangles + 2 * number * vertices +
           (number + sizeof(struct tri_subsegment)) * subs;
}

/* Returns the bytes per triangle of a mesh that is numbered in memory. */
static inline double par_whole_bytes_each(void) { return tri_mesh_bytes_each(0) + par_number_bytes(1, 0.5, 0); }

#endif
