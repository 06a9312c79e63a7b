/* What a run will need, before it begins to refine: triangles, memory, disk, time. */
#ifndef DRIVERS_ESTIMATE_H
#define DRIVERS_ESTIMATE_H

#include "drivers/run.h"

struct estimate {
    double least;   /* triangles that area bounds ask for beyond doubt; 0: none */
    double triangles, vertices;
    double more;    /* bytes of memory that a mesh in memory takes beyond what is taken now .. */
    double least_more; /* .. beyond doubt */
    double swept, least_swept; /* the same for a mesh that is swept */
    double disk, least_disk; /* bytes of files */
    double seconds; /* from here on; costs a few milliseconds to find out, and is 0 unless asked for */
};

/* Of the mesh as it is and the bounds. How good it is: docs/performance.md. O(triangles). */
struct estimate estimate_make(const struct run *run, bool with_seconds);

#endif
