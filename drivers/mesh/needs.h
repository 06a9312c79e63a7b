/* What a run will need, before it begins to refine: triangles, memory, disk, time. */
#ifndef DRIVERS_MESH_NEEDS_H
#define DRIVERS_MESH_NEEDS_H

#include "drivers/mesh/stages.h"

/* Bytes of a number of triangles, beyond what is taken now. */
struct needs {
    double triangles;
    double whole;      /* memory of a mesh that is in memory as a whole, were it not too large for one */
    double held;       /* memory of one that is handed out as it is made, where its arrays are in memory, */
    double floor;      /* and where they are in files: it cannot be less */
    double away;       /* of these files */
    double filed;      /* memory of one that stays a mesh, but lies in files, with what its output takes beside it .. */
    double filed_away; /* .. and of these files */
    double checkpoint; /* of the folder of checkpoints where it is handed out as it is made, */
    double states;     /* and where it is in memory as a whole */
    double kept;       /* of files in which tiles wait until they can be written */
    double files;      /* of the output */
};

struct estimate {
    struct needs least;  /* what area bounds ask for beyond doubt; all 0: there are none */
    struct needs likely;
    double vertices;
    bool sweeps;         /* a mesh that is handed out as it is made is never there as a whole: some columns are, or
                            each task has its part */
    double seconds;      /* of the whole run; costs a few milliseconds to find out, and is 0 unless asked for */
};

/* Of the mesh as it is and the bounds. How good it is: docs/performance.md. O(triangles). */
struct estimate estimate_make(const struct run *run, bool with_seconds);

/* Finds what a schedule needs for a mesh that grows by so many triangles: all of *needs except triangles and files.
 * demand: how many of them areas ask for; < 0: needs->whole has been found already. For run_settings. */
void schedule_needs(const struct run *run, bool sweeps, double grown, double demand, struct needs *needs);

/* Bytes for a triangle of the mesh, and of what stands beside it when it is refined, or when it is written. */
double estimate_bytes_each(const struct run *run);

/* Bytes of what is done with a mesh that is finished, and has grown by so many triangles. */
double estimate_bytes_beside(const struct run *run, double grown);

/* Bytes for a triangle of the lists of edges that the output takes. */
double estimate_edge_lists(const struct run *run);

/* Bytes of memory that handing out a mesh of so many triangles takes beside it, to the HDF5 files of the run. */
double estimate_streams(const struct run *run, double triangles);

/* Could so much be moved to files that are mapped? Not where the address space ends before what --memory allows. */
bool estimate_can_park(const struct run *run, double held);

#endif
