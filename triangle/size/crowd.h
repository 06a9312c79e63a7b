/* How many triangles angles ask for, from how crowded the features around a triangle are. */
#ifndef TRIANGLE_SIZE_CROWD_H
#define TRIANGLE_SIZE_CROWD_H

#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

struct tri_crowd {
    const struct tri_mesh *mesh;
    double sin2;     /* square of the sine of the angle bound */
    double fineness; /* triangles for each square of the size of features; 0: there is no bound */
};

/* The mesh has been made ready for refinement (groundwork.h). Borrowed. */
struct tri_crowd tri_crowd_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Triangles that angles make of one, beside itself and those that sizes ask for in it, `asked`. Cost:
 * logarithmic in the ratio of sizes, about that of one point. */
double tri_crowd_work(const struct tri_crowd *crowd, tri_triangle_id t, double asked);

#endif
