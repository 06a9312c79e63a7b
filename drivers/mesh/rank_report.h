/* What each of several ranks has done, told to all. */
#ifndef DRIVERS_MESH_RANK_REPORT_H
#define DRIVERS_MESH_RANK_REPORT_H

#include "sched/ranks/carrier.h"
#include "sched/schedule/schedule.h"

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
