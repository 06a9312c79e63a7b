/* The numbers of a mesh in memory: tile by tile, those by which it is handed out (sched/tiles/tiles.h).
 *
 * The first vertices, as many as the caller says, keep their numbers; the others follow tile by tile, in each along a
 * Hilbert curve. A triangle belongs to the last tile of its corners and starts at its corner with the largest number;
 * the triangles of a tile are sorted by that corner, then by the next one: what is near in the plane is near in the
 * arrays, which is what a solver's cache wants. The subsegments of a tile, the last one of their ends, are sorted by
 * parent, then by the vertex at which they start. (All by the numbers that vertices have now: where tri_mesh.origin is
 * set, the caller's points get their own back later, triangles stay where they are.) */
#ifndef SCHED_TILES_NUMBERING_H
#define SCHED_TILES_NUMBERING_H

#include "sched/schedule/partition.h"
#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Numbers a mesh. Free triangle numbers, subsegments with v[0] == TRI_NONE and vertices that are TRI_VERTEX_NONE, which
 * nothing refers to, are gone afterwards. The first n_kept vertices keep their numbers: those that parents end at (the
 * first tri_mesh.incidence.n_vertices), or more; none of them is free.
 *
 * Meshes whose first n_kept vertices and whose parents agree, and which have the same vertices, triangles and
 * subsegments beyond these under any numbers, become the same, byte for byte. O(n); beside the mesh about 20 bytes a
 * triangle and 4 a vertex while it runs. TRI_NO_MEMORY: nothing has changed. */
enum tri_status par_number(struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept,
                           const struct tri_executor *executor, struct tri_error *error);

/* What par_number takes beside the mesh, to the order. */
static inline size_t par_number_bytes(const struct tri_mesh *mesh)
{
    return 28 * (size_t)mesh->n_triangles + 8 * (size_t)mesh->n_vertices + 28 * (size_t)mesh->n_subs;
}

#endif
