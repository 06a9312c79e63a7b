/* Inputs with bounds, for tests of the schedule. */
#ifndef TESTS_TRIALS_H
#define TESTS_TRIALS_H

#include "support.h"

/* An input and its bounds. target > 0: about this many triangles, from which the area bound is computed. 0: no bound.
 * Below 0: edge lengths for about -target triangles, three times as long on the right. */
struct trial {
    const char *file; /* name of an input in the data folder */
    double angle, target, block;
    bool conforming, regions;
    int protect;
};

/* The start of a trial: the constrained triangulation and the options of refinement. */
struct start {
    struct tri_pslg pslg;
    struct tri_options options;
};

/* The caller frees the result with trials_free, or only start.pslg if there are no edge lengths. */
struct start trials_start_of(const struct trial *trial);

void trials_free(struct start *start);

/* Returns the mesh before refinement. */
struct tri_mesh trials_coarse_mesh(const struct start *start);

#endif
