/* The program as one of several tasks that a launcher (mpirun, srun) has started: they are ranks of one MPI, and make
 * one mesh together. A build without MPI refuses, or each task would write the same files. */
#ifndef DRIVERS_MESH_LAUNCH_H
#define DRIVERS_MESH_LAUNCH_H

#include "drivers/mesh/stages.h"
#include "sched/ranks/carrier.h"
#include "sched/schedule/schedule.h"
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

/* --- An input that one rank has read, on all ranks. */

/* Collective: all that is read into *run by rank 0 (figure, triangles, base) comes to all. status: whether it has read
 * it. TRI_NO_MEMORY. */
enum tri_status shared_input(struct par_carrier *carrier, struct run *run, enum tri_status status,
                             struct tri_error *error);

/* --- What each of several ranks has done, told to all. */

/* Numbers that all ranks tell of themselves. */
enum {
    RANK_THREADS,
    RANK_PEAK_MEMORY,                         /* bytes */
    RANK_NS_PROCESSOR,                        /* nanoseconds of all its threads, since the program began */
    RANK_NS_BLOCKS,                           /* in which blocks were refined */
    RANK_NS_WAITING,                          /* for other ranks */
    RANK_NS_MOVING,                           /* to and from them */
    RANK_BYTES,                               /* sent, by reason */
    RANK_MESSAGES = RANK_BYTES + PAR_MOVES,
    RANK_NUMBERS = RANK_MESSAGES + PAR_MOVES
};

struct rank_report {
    int n_ranks;                         /* 0: there is one process */
    int64_t (*number)[RANK_NUMBERS];     /* [n_ranks] malloc'ed */
};

/* Collective. schedule: what this rank has done. */
enum tri_status rank_report_gather(struct rank_report *report, struct par_carrier *carrier,
                                   const struct par_report *schedule, enum tri_status status, struct tri_error *error);

#endif
