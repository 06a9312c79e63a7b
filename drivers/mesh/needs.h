/* Estimates what a run needs before refinement begins: triangles, memory, disk and time. */
#ifndef DRIVERS_MESH_NEEDS_H
#define DRIVERS_MESH_NEEDS_H

#include "drivers/mesh/stages.h"

/* Bytes for a number of triangles, beyond the bytes in use now. */
struct needs {
    double triangles;
    double whole;      /* memory for a mesh that is in memory as a whole, even if it is too large for one mesh */
    double held;       /* memory for a swept mesh whose arrays are in memory */
    double floor;      /* least memory for a swept mesh whose arrays are in files */
    double away;       /* disk for those files */
    double filed;      /* memory for a mesh kept as a whole in files, with the output */
    double filed_away; /* disk for those files */
    double checkpoint; /* disk for checkpoints of a swept mesh */
    double states;     /* disk for checkpoints of a mesh in memory */
    double kept;       /* disk for files in which tiles wait until they can be written */
    double files;      /* disk for the output */
};

struct estimate {
    struct needs least;  /* what the area bounds certainly require; all 0: there are no area bounds */
    struct needs likely;
    double vertices;
    bool sweeps;         /* a mesh that is handed out is never in memory as a whole: it is swept, or distributed over
                            tasks */
    double seconds;      /* time of the whole run; measuring it takes a few milliseconds; 0: not requested */
};

/* Estimates the needs for the mesh and the bounds. Accuracy: docs/performance.md. O(triangles). */
struct estimate estimate_make(const struct run *run, bool with_seconds);

/* Sets what a schedule needs for a mesh that grows by `grown` triangles: all members of *needs except triangles and
 * files. demand: number of triangles that areas require; < 0: needs->whole is already known. For run_settings. */
void schedule_needs(const struct run *run, bool sweeps, double grown, double demand, struct needs *needs);

/* Bytes per triangle of the mesh and of the data that refinement or writing needs beside it. */
double estimate_bytes_each(const struct run *run);

/* Bytes needed after refinement, for a mesh that has grown by this number of triangles. */
double estimate_bytes_beside(const struct run *run, double grown);

/* Bytes per triangle of the lists of edges for the output. */
double estimate_edge_lists(const struct run *run);

/* Bytes of memory beside a mesh of this number of triangles while it is handed to the HDF5 files of the run. */
double estimate_streams(const struct run *run, double triangles);

/* Returns true if this number of bytes could be moved to mapped files. It returns false if the address space is smaller
 * than --memory allows. */
bool estimate_can_park(const struct run *run, double held);

#endif
