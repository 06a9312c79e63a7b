/* Checks a mesh in memory and part by part. */
#ifndef TESTS_BOTH_WAYS_H
#define TESTS_BOTH_WAYS_H

#include "triangle/check/check.h"

/* Calls tri_check. If the mesh is small, calls it again with almost no memory, so that it works part by part, and
 * requires the same report. */
enum tri_status check_both_ways(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                                const struct tri_check_options *options, struct tri_check_report *report,
                                struct tri_error *error);

#endif
