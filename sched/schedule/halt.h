/* A phase that has been halted between two points: which blocks have begun, what they have done, and where each goes
 * on.
 *
 * THEOREM. A phase that goes on makes the mesh of one that was never halted, ids included. For what a block has still
 * to do depends on its fence, its part of the mesh, its share of the worklist, its room and its refiner alone, and all
 * these are kept as they are; and room is dealt when all blocks have ended or are full, as without a halt. */
#ifndef SCHED_SCHEDULE_HALT_H
#define SCHED_SCHEDULE_HALT_H

#include "sched/schedule/room.h"
#include "sched/schedule/worklist.h"
#include "triangle/refine/pause.h"

enum par_progress {
    PAR_NEW,   /* waits for its first room */
    PAR_READY, /* has room, and has not begun, or has been stopped */
    PAR_FULL,  /* waits for more room, or for what others hold */
    PAR_ENDED
};

struct par_halted {
    int32_t block, n_worklist, expected;
    int32_t pauses;             /* for room */
    enum par_progress progress;
    double seconds;             /* at work */
    struct tri_refine_report report;
    struct par_room room;
    struct par_ids left;        /* what its gate and fence left */
    struct tri_pause *pause;    /* NULL: it has not begun, or has ended */
};

struct par_halt {
    int32_t n_blocks;           /* 0: no phase has been halted */
    struct par_halted *block;   /* [n_blocks] in canonical order */
    tri_triangle_id *worklist;  /* theirs, one behind the other */
    int32_t n_worklist;
};

/* Ends the phase where it is: room goes back to `spare`, all else is forgotten. Nothing to do where there is none. */
void par_halt_drop(struct par_halt *halt, struct par_room *spare);

#endif
