/* Flips that bring the degrees of vertices near six. */
#ifndef TRIANGLE_REFINE_DEGREES_H
#define TRIANGLE_REFINE_DEGREES_H

#include "triangle/cdt/flip.h"
#include "triangle/refine/star.h"

/* Counts the triangles at each vertex and sets the ideal numbers; required before tri_degrees_improve. Returns false if
 * memory runs out. O(triangles). */
bool tri_degrees_count(struct tri_smooth *smooth);

/* Flips one edge at a free vertex of too high a degree, if that is better, and restores the Delaunay property around
 * it. The star is that of the vertex; it lies in the block of `flips`. Returns false if memory runs out; the mesh is
 * valid then. O(1) for bounded degrees. */
bool tri_degrees_improve(const struct tri_smooth *smooth, struct tri_flips *flips, tri_vertex_id v,
                         const struct tri_star *star);

#endif
