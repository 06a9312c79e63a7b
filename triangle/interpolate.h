/* Attributes of new vertices: linear interpolation. */
#ifndef TRIANGLE_INTERPOLATE_H
#define TRIANGLE_INTERPOLATE_H

#include "triangle/mesh.h"

/* Attributes of vertex `to_vertex`, at the given fraction of the way from vertex a to vertex b. */
void tri_interpolate_edge(struct tri_mesh *mesh, int32_t a, int32_t b, double fraction, int32_t to_vertex);

/* Attributes of vertex v from the plane through the corners of a triangle; v may lie outside it (extrapolation). */
void tri_interpolate_triangle(struct tri_mesh *mesh, const int32_t corners[3], int32_t v);

#endif
