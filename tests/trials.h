/* Inputs with bounds, for tests of the schedule. */
#ifndef TESTS_TRIALS_H
#define TESTS_TRIALS_H

#include "support.h"

/* An input and bounds; `target` triangles to the order, from which the area bound is drawn (0: none); below 0: lengths
 * ask for -target, threefold ones on the right. */
struct trial {
    const char *file;
    double angle, target, block;
    bool conforming, regions;
    int protect;
};

/* What a trial starts from: the constrained triangulation and the options of refinement. */
struct start {
    struct tri_pslg pslg;
    struct tri_options options;
};

/* To be freed by trials_free, or start.pslg where there are no lengths. */
struct start trials_start_of(const struct trial *trial);

void trials_free(struct start *start);

/* The mesh before refinement. */
struct tri_mesh trials_coarse_mesh(const struct start *start);

#endif
