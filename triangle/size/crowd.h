/* How many triangles angles ask for, from how crowded the features around a triangle are. */
#ifndef TRIANGLE_SIZE_CROWD_H
#define TRIANGLE_SIZE_CROWD_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/geometry/point.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

struct tri_crowd {
    const struct tri_mesh *mesh;
    double sin2;     /* square of the sine of the angle bound */
    double fineness; /* triangles for each square of the size of features; 0: there is no bound */
};

/* The mesh has been made ready for refinement (feature_size.h). Borrowed. */
struct tri_crowd tri_crowd_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Triangles that angles make of one, beside itself and those that sizes ask for in it, `asked`. Cost:
 * logarithmic in the ratio of sizes, about that of one point. */
double tri_crowd_work(const struct tri_crowd *crowd, tri_triangle_id t, double asked);

/* The integral of 1 / h^2 over a triangle: how many squares of the size h fill it. A mesh graded by h has that many
 * triangles, to a constant (Ruppert 1995, theorem 4). */

struct tri_integrand {
    double (*at)(const void *user, struct tri_point q); /* h, above 0 and below 1e100 */
    const void *user;
    double over;  /* what counts is 1 / h^2 beyond this */
    double large; /* parts of a larger area are divided in any case: h may vary inside them unseen */
    double few;   /* parts that hold no more squares than this are not divided */
    int deepest;  /* so many times a part is halved at most, whatever h does */
    const int64_t *left; /* parts are halved while this is above 0; NULL: always */
    bool at_least; /* parts in which h may vary count by their largest h */
};

/* Where h is smooth, O(log of the ratios of sizes) places are looked at. */
double tri_integral(const struct tri_integrand *field, const struct tri_point corner[3]);

#endif
