/* Estimates how many triangles the angle bound needs, from the density of the features around a triangle. */
#ifndef TRIANGLE_SIZE_CROWD_H
#define TRIANGLE_SIZE_CROWD_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/geometry/point.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

struct tri_crowd {
    const struct tri_mesh *mesh; /* borrowed */
    double sin2;     /* squared sine of the angle bound */
    double fineness; /* triangles per square of the feature size; 0: no angle bound */
};

/* The mesh must have been prepared for refinement (feature_size.h). Borrowed. */
struct tri_crowd tri_crowd_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Returns how many triangles the angle bound adds to one triangle, besides itself and the triangles needed for sizes
 * (`asked`). The cost is logarithmic in the ratio of sizes, about as much as one insertion. */
double tri_crowd_work(const struct tri_crowd *crowd, tri_triangle_id t, double asked);

/* The integrand 1 / h^2: its integral over a triangle is the number of squares of side h that fill it. A mesh graded
 * by h has that many triangles, up to a constant (Ruppert 1995, theorem 4). */

struct tri_integrand {
    double (*at)(const void *user, struct tri_point q); /* returns h, above 0 and below 1e100 */
    const void *user;                                   /* passed to at */
    double over;  /* only the part of 1 / h^2 above this value counts */
    double large; /* parts with a larger area are always divided, because h may vary inside unnoticed */
    double few;   /* parts with fewer squares than this are not divided */
    int deepest;  /* maximum number of times a part is halved */
    const int64_t *left; /* parts are only divided while this is above 0; NULL: no limit */
    bool at_least; /* true: a part in which h may vary counts with its largest h */
};

/* Integrates over the triangle. h: [3] the values of h at its corners; NULL: not known. If h is smooth, this evaluates
 * O(log of the ratio of sizes) points. */
double tri_integral(const struct tri_integrand *field, const struct tri_point corner[3], const double *h);

#endif
