/* Angles in degrees, for bounds and reports. */
#ifndef TRIANGLE_GEOMETRY_DEGREES_H
#define TRIANGLE_GEOMETRY_DEGREES_H

/* Cosine of an angle in degrees, 0 .. 180, by its power series: within 1e-15 of the true value everywhere. */
double tri_cos_degrees(double degrees);

#endif
