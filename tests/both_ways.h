/* The judge in memory and in parts. */
#ifndef TESTS_BOTH_WAYS_H
#define TESTS_BOTH_WAYS_H

#include "triangle/check/check.h"

/* tri_check, and, where the mesh is small, once more with next to no memory, part by part, with the same report. */
enum tri_status check_both_ways(const struct tri_check_mesh *mesh, const struct tri_pslg *input,
                                const struct tri_check_options *options, struct tri_check_report *report,
                                struct tri_error *error);

#endif
