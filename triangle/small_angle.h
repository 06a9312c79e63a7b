/* Where refinement must stop: small input angles, and features that cannot be resolved. */
#ifndef TRIANGLE_SMALL_ANGLE_H
#define TRIANGLE_SMALL_ANGLE_H

#include "triangle/quality.h"

struct tri_resolution {
    double shortest2; /* square of the shortest edge that coordinates of this size can carry */
};

struct tri_resolution tri_resolution_of(const struct tri_mesh *mesh);

/* Where to split a subsegment, as a fraction from its start: in the middle or, beside an acute input vertex, at the power of
 * two nearest to the middle from there. So subsegments that meet at a small angle are split on common circles (concentric
 * shells: Ruppert 1995), and do not encroach each other for ever. */
double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s);

bool tri_can_split(const struct tri_resolution *resolution, struct tri_point a, struct tri_point b);

/* A bad angle that no point can mend, or that would only move it: see the rules in the .c file. */
bool tri_is_hopeless(const struct tri_mesh *mesh, const struct tri_resolution *resolution, int32_t slot,
                     const struct tri_shape *shape);

/* Does the shortest edge of the triangle bridge a space between two parents that is too dear to fill? */
bool tri_is_channel(const struct tri_mesh *mesh, int32_t slot, const struct tri_shape *shape);

#endif
