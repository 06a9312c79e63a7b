/* Where a segment leaves the vertex that it begins at. */
#ifndef TRIANGLE_CDT_ROTATION_H
#define TRIANGLE_CDT_ROTATION_H

#include "triangle/mesh/mesh.h"

/* The triangle through which the segment leaves its end *a towards *b. Where *a is a hub, with many triangles, the
 * search goes on around both ends in turns, and the two are exchanged if it succeeds at *b: so the cost is that of the
 * end with fewer triangles. Remembered as the corner, so that the edges of a fan in order cost O(1) each.
 * TRI_NONE: there is none. corner[v]: a triangle at v. */
tri_triangle_id tri_find_exit(const struct tri_mesh *mesh, tri_triangle_id *corner, tri_vertex_id *a, tri_vertex_id *b);

#endif
