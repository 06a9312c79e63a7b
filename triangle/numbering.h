/* Numbers that depend on the mesh alone, not on how it was made.
 *
 * Vertices that were there when refinement began keep their numbers; those that refinement made follow along a Hilbert
 * curve. A triangle starts at its corner with the largest number, and triangles are sorted by that corner, then by the
 * next one: what is near in the plane is near in the arrays, which is what a solver's cache wants. Subsegments are
 * sorted by parent, then by the vertex at which they start. */
#ifndef TRIANGLE_NUMBERING_H
#define TRIANGLE_NUMBERING_H

#include "triangle/executor.h"
#include "triangle/mesh.h"

/* Numbers a mesh that tri_refine_prepare or a refinement has seen. Free slots, subsegments with v[0] == TRI_NONE and
 * vertices that are TRI_VERTEX_NONE, which nothing refers to, are gone afterwards.
 *
 * Meshes whose first n_hubs vertices and whose parents agree, and which have the same vertices, triangles and
 * subsegments beyond these under any numbers, become the same, byte for byte. O(n), and a second copy of the triangles
 * for a while. TRI_NO_MEMORY: as before. */
enum tri_status tri_number(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

#endif
