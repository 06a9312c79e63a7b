/* The program as one of several tasks that a launcher (mpirun, srun) has started. The tasks are ranks of one MPI and
 * make one mesh together. A build without MPI reports an error, because each task would write the same files. */
#ifndef DRIVERS_MESH_LAUNCH_H
#define DRIVERS_MESH_LAUNCH_H

#include "drivers/mesh/stages.h"
#include "sched/ranks/carrier.h"
#include "sched/schedule/schedule.h"
#include "triangle/base/system.h"

struct launch {
    int rank;                     /* number of this task; 0 for a single task */
    struct par_carrier *carrier;  /* connection between the ranks; NULL for a single task */
    tri_file voice;               /* standard error of one of several tasks, also of a task whose output is
                                     suppressed */
};

/* Finds out who started the program. Of several tasks only the first prints from now on. TRI_BAD_INPUT: there are
 * several tasks, and they cannot connect. */
enum tri_status launch_join(struct launch *launch, struct tri_error *error);

/* Agrees on the exit code of all tasks, and returns it. If some tasks were asked to end, it is the code of the first of
 * these. error: why this task has failed, if known. */
int launch_agree(struct launch *launch, int code, struct tri_error *error);

/* Parts from the other tasks, as the last action. Each task learns whether another has failed. A task that cannot reach
 * the others reports this and ends all. Returns the exit code. */
int launch_leave(struct launch *launch, int code, struct tri_error *error);

/* How tasks become ranks, and how they end; one implementation with MPI and one without. */
enum tri_status launch_ranks(struct launch *launch, int tasks, struct tri_error *error);
void launch_end(struct launch *launch);

/* --- The input, sent from one rank to all. */

/* Sends the input that rank 0 has read into *run (figure, triangles, base) to all ranks. Collective. status: of
 * reading, on rank 0. TRI_NO_MEMORY. */
enum tri_status shared_input(struct par_carrier *carrier, struct run *run, enum tri_status status,
                             struct tri_error *error);

/* --- Work of each rank, collected on all ranks. */

/* Numbers that each rank reports. */
enum {
    RANK_THREADS,
    RANK_PEAK_MEMORY,                         /* bytes */
    RANK_NS_PROCESSOR,                        /* processor time of all threads since the program began, nanoseconds */
    RANK_NS_BLOCKS,                           /* time in which blocks were refined */
    RANK_NS_WAITING,                          /* time of waiting for other ranks */
    RANK_NS_MOVING,                           /* time of sending and receiving */
    RANK_BYTES,                               /* bytes sent, by kind of message */
    RANK_MESSAGES = RANK_BYTES + PAR_MOVES,
    RANK_NUMBERS = RANK_MESSAGES + PAR_MOVES
};

struct rank_report {
    int n_ranks;                         /* 0: there is a single process */
    int64_t (*number)[RANK_NUMBERS];     /* [n_ranks], malloc'ed */
};

/* Collects the numbers of all ranks. Collective. schedule: the work of this rank. */
enum tri_status rank_report_gather(struct rank_report *report, struct par_carrier *carrier,
                                   const struct par_report *schedule, enum tri_status status, struct tri_error *error);

#endif
