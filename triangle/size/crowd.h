/* How many triangles refinement will end with, from how crowded the features of a mesh are: --dry-run tells it. Blocks
 * are cut by the quicker measure of triangle/size/estimate.h. */
#ifndef TRIANGLE_SIZE_CROWD_H
#define TRIANGLE_SIZE_CROWD_H

#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

/* For angles and areas, not for a size test. The mesh has been made ready for refinement
 * (triangle/size/groundwork.h). Looks at no more than 32,768 triangles, in each for a time that grows with the
 * logarithms of ratios of sizes in it. */
double tri_forecast(const struct tri_mesh *mesh, const struct tri_quality *quality);

#endif
