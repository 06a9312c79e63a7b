/* What refinement has to know of the input before it inserts its first point: found once, by tri_refine_prepare, and
 * kept with the mesh. */
#ifndef TRIANGLE_SIZE_GROUNDWORK_H
#define TRIANGLE_SIZE_GROUNDWORK_H

#include "triangle/mesh/mesh.h"

/* Makes the mesh ready for refinement: keeps the surface of the attributes, lists the parents at each vertex, estimates
 * feature sizes, sets the limits, and marks the input vertices at which two subsegments meet at less than 60 degrees
 * inside the mesh (TRI_VERTEX_ACUTE). Call it after carving, before the first point; a mesh that is ready stays as it
 * is. O(triangles). */
enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

#endif
