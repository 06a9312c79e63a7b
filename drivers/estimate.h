/* What a run will need, before it begins to refine: triangles, memory, disk, time. */
#ifndef DRIVERS_ESTIMATE_H
#define DRIVERS_ESTIMATE_H

#include "drivers/run.h"

struct estimate {
    double least;   /* triangles that area bounds ask for beyond doubt; 0: none */
    double triangles, vertices;
    double memory;  /* bytes, of the whole process at its peak */
    double more;    /* of these, bytes that it has not got yet */
    double disk;    /* bytes of files */
    double seconds; /* from here on; costs a few milliseconds to find out, and is 0 unless asked for */
};

/* Of the mesh as it is and the bounds. How good it is: docs/performance.md. O(triangles). */
struct estimate estimate_make(const struct run *run, bool with_seconds);

/* TRI_TOO_LARGE or TRI_NO_MEMORY, with what is needed and what there is, where that is beyond doubt; a warning, where
 * it is likely. */
enum tri_status estimate_check(const struct estimate *estimate, const struct console *console, struct tri_error *error);

void estimate_print(const struct estimate *estimate, const struct run *run);

#endif
