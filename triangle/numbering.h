/* Numbers that depend on the mesh alone, not on how it was made.
 *
 * The first vertices, as many as the caller says, keep their numbers; the others follow along a Hilbert curve. A
 * triangle starts at its corner with the largest number, and triangles are sorted by that corner, then by the next
 * one: what is near in the plane is near in the arrays, which is what a solver's cache wants. Subsegments are sorted
 * by parent, then by the vertex at which they start. (All by the numbers that vertices have now: where
 * tri_mesh.origin is set, the caller's points get their own back later, triangles stay where they are.) */
#ifndef TRIANGLE_NUMBERING_H
#define TRIANGLE_NUMBERING_H

#include "triangle/executor.h"
#include "triangle/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Numbers a mesh. Free slots, subsegments with v[0] == TRI_NONE and vertices that are TRI_VERTEX_NONE, which nothing
 * refers to, are gone afterwards. The first n_kept vertices keep their numbers: those that parents end at (the first
 * tri_mesh.incidence.n_vertices), or more; none of them is free.
 *
 * Meshes whose first n_kept vertices and whose parents agree, and which have the same vertices, triangles and
 * subsegments beyond these under any numbers, become the same, byte for byte. O(n); beside the mesh about 20 bytes a
 * slot and 8 a new vertex while it runs. TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_number(struct tri_mesh *mesh, int32_t n_kept, const struct tri_executor *executor,
                           struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
