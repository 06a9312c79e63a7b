/* The program as one of several tasks that a launcher (mpirun, srun) has started: they are ranks of one MPI, and make
 * one mesh together. A build without MPI refuses, or each task would write the same files. */
#ifndef DRIVERS_MESH_LAUNCH_H
#define DRIVERS_MESH_LAUNCH_H

#include "sched/ranks/carrier.h"
#include "triangle/base/system.h"

struct launch {
    int rank;                     /* 0 where there is one task */
    struct par_carrier *carrier;  /* NULL there */
    tri_file voice;               /* of several: standard error, also of a task whose words are not heard */
};

/* Looks who started the program; of several tasks only the first one's words are heard from here on. TRI_BAD_INPUT:
 * there are several, and they cannot find together. */
enum tri_status launch_join(struct launch *launch, struct tri_error *error);

/* The tasks agree on the exit code, which is returned: where some were asked to end, and have, that of the first of
 * these. error: why this one has failed, where that is known. */
int launch_agree(struct launch *launch, int code, struct tri_error *error);

/* The last thing that is done: the tasks learn whether one has failed, and part. A task that cannot reach the others
 * says so, and ends them all. Returns the exit code. */
int launch_leave(struct launch *launch, int code, struct tri_error *error);

/* By whether there is MPI: how tasks become ranks, and cease to be. */
enum tri_status launch_ranks(struct launch *launch, int tasks, struct tri_error *error);
void launch_end(struct launch *launch);

#endif
