/* The place of a run: what it does next. This, the mesh and the lists are all that a state keeps of what has been done.
 *
 *     from                to, the first where there is nothing to choose
 *     PAR_SIZES           PAR_SIZES_PHASE (a schedule), PAR_BOUNDS (one call), PAR_BOUNDS_WHOLE (resumed, see there)
 *     PAR_SIZES_PHASE     PAR_SIZES_REST (something is left), PAR_BOUNDS_WHOLE
 *     PAR_SIZES_REST      PAR_BOUNDS_WHOLE
 *     PAR_BOUNDS          PAR_BOUNDS_PHASE (a schedule), PAR_COLUMN (too large for memory), PAR_HAND_OUT (one call)
 *     PAR_BOUNDS_WHOLE    PAR_BOUNDS_PHASE, PAR_HAND_OUT (one call)
 *     PAR_COLUMN          PAR_COLUMN_PHASE, PAR_BOUNDS_WHOLE (something is left: the mesh is as it was), PAR_END
 *     PAR_COLUMN_PHASE    PAR_COLUMN
 *     PAR_BOUNDS_PHASE    PAR_BOUNDS_REST (something is left), PAR_HAND_OUT
 *     PAR_BOUNDS_REST     PAR_HAND_OUT
 *     PAR_HAND_OUT        PAR_END
 *
 * A run begins at PAR_SIZES if angles are expensive, otherwise at PAR_BOUNDS, or where the state is. par_go (phase.h)
 * makes every step, but for the one to where a state is; the test `next` compares this table with what runs do.
 *
 * A state is kept at all but PAR_SIZES and PAR_END, and at PAR_BOUNDS.. if something has been done before. In it:
 *
 *     .._PHASE       the mesh, with places that nobody uses; worklist, keys, cells, blocks that are done
 *     .._REST        the same; the worklist is for the call
 *     PAR_BOUNDS.., PAR_HAND_OUT   the mesh, without gaps; the cells that made it, if any; no lists
 *     PAR_COLUMN     the mesh from this column on, and its worklist; tiles before it have been handed out
 *     PAR_COLUMN_PHASE   the same amid the column, whose list from the coarse mesh has joined the worklist */
#ifndef SCHED_SCHEDULE_NEXT_H
#define SCHED_SCHEDULE_NEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "sched/schedule/worklist.h"

enum par_next {
    PAR_SIZES,        /* the first step for sizes alone */
    PAR_SIZES_PHASE,  /* phase `phase` of round `round` of that schedule, except for the blocks that are `done` */
    PAR_SIZES_REST,   /* the call for what no block could do */
    PAR_BOUNDS,       /* the first step for all bounds, of a mesh that may be swept */
    PAR_BOUNDS_WHOLE, /* the same, of one that stays as a whole: after a schedule for sizes, or a sweep that was given
                         up, or resumed from the state of a whole mesh */
    PAR_COLUMN,       /* `column` of a sweep */
    PAR_COLUMN_PHASE, /* phase `phase` of this column, except for the blocks that are `done` */
    PAR_BOUNDS_PHASE,
    PAR_BOUNDS_REST,
    PAR_HAND_OUT,     /* nothing is refined any more; a mesh with cells is numbered by them, unless by_block. Smoothing
                         comes first, if it is asked for */
    PAR_END           /* the mesh has been handed out, or stays with the caller */
};

struct par_position {
    enum par_next next;
    int level;           /* of the schedule or the call at work; 0: the whole mesh, of which alone states are kept */
    int round, phase;    /* of the schedule, from 0; the phase may be PAR_PHASES: the round is over */
    int32_t step;        /* of the phase, on ranks, from 0; otherwise 0 */
    int32_t column;      /* of a sweep: odd ones alone, from 1; 0: it is none */
    struct par_ids done; /* blocks of phase `phase` that have ended, where it has been halted; empty: none */
};

/* Amid a schedule of the whole mesh? */
static inline bool par_is_phase(enum par_next next) { return next == PAR_SIZES_PHASE || next == PAR_BOUNDS_PHASE; }
static inline bool par_is_rest(enum par_next next) { return next == PAR_SIZES_REST || next == PAR_BOUNDS_REST; }

/* Is it for sizes alone, before the schedule or call for all bounds? */
static inline bool par_is_of_sizes(enum par_next next) { return next < PAR_BOUNDS; }

#endif
