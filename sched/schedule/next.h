/* The position of a run: which step comes next. A checkpoint state consists of this position, the mesh and the lists.
 *
 *     from                to (the first one if there is no choice to make)
 *     PAR_SIZES           PAR_SIZES_PHASE (a schedule), PAR_BOUNDS (one call), PAR_BOUNDS_WHOLE (resumed, see there)
 *     PAR_SIZES_PHASE     PAR_SIZES_REST (work is left), PAR_BOUNDS_WHOLE
 *     PAR_SIZES_REST      PAR_BOUNDS_WHOLE
 *     PAR_BOUNDS          PAR_BOUNDS_PHASE (a schedule), PAR_COLUMN (too large for memory), PAR_HAND_OUT (one call)
 *     PAR_BOUNDS_WHOLE    PAR_BOUNDS_PHASE, PAR_HAND_OUT (one call)
 *     PAR_COLUMN          PAR_COLUMN_PHASE, PAR_BOUNDS_WHOLE (work is left: the sweep is undone), PAR_END
 *     PAR_COLUMN_PHASE    PAR_COLUMN
 *     PAR_BOUNDS_PHASE    PAR_BOUNDS_REST (work is left), PAR_HAND_OUT
 *     PAR_BOUNDS_REST     PAR_HAND_OUT
 *     PAR_HAND_OUT        PAR_END
 *
 * A run begins at PAR_SIZES if angles are expensive, otherwise at PAR_BOUNDS. A resumed run begins at the position in
 * the state. par_go (phase.h) makes every step except the one to a resumed position. The test `next` compares this
 * table with the steps of real runs.
 *
 * A state can be written at every step except PAR_SIZES and PAR_END, and at PAR_BOUNDS.. only if work has been done
 * before. It holds:
 *
 *     .._PHASE       the mesh, including unused room; worklist, keys, cells, and the blocks of the phase that are done
 *     .._REST        the same; the worklist is for the sequential call
 *     PAR_BOUNDS.., PAR_HAND_OUT   the mesh without gaps; the cells that made it, if any; no lists
 *     PAR_COLUMN     the mesh from this column on, and its worklist; tiles of earlier columns have been handed out
 *     PAR_COLUMN_PHASE   the same during the column, after its list from the coarse mesh has joined the worklist */
#ifndef SCHED_SCHEDULE_NEXT_H
#define SCHED_SCHEDULE_NEXT_H

#include <stdbool.h>
#include <stdint.h>

#include "sched/schedule/worklist.h"

enum par_next {
    PAR_SIZES,        /* decides how to refine for sizes alone */
    PAR_SIZES_PHASE,  /* phase `phase` of round `round` of the schedule for sizes, except for the blocks in `done` */
    PAR_SIZES_REST,   /* the sequential call for triangles that no block could refine */
    PAR_BOUNDS,       /* decides how to refine for all bounds; the mesh may be swept */
    PAR_BOUNDS_WHOLE, /* the same for a mesh that is kept as a whole: after a schedule for sizes, after a sweep that was
                         given up, or resumed from the state of a whole mesh */
    PAR_COLUMN,       /* the beginning of column `column` of a sweep */
    PAR_COLUMN_PHASE, /* phase `phase` of this column, except for the blocks in `done` */
    PAR_BOUNDS_PHASE, /* as PAR_SIZES_PHASE, but in the schedule for all bounds */
    PAR_BOUNDS_REST,  /* as PAR_SIZES_REST, but in the schedule for all bounds */
    PAR_HAND_OUT,     /* refinement is complete. A mesh with cells has been numbered by them, unless by_block. If
                         smoothing is requested, this step begins with it */
    PAR_END           /* the mesh has been handed out, or the caller keeps it */
};

struct par_position {
    enum par_next next;  /* the next step */
    int level;           /* level of the current schedule or call; 0: the whole mesh. States are written on level 0
                            only */
    int round, phase;    /* of the current schedule, from 0; phase PAR_PHASES: the round is complete */
    int32_t step;        /* on ranks: step of the phase, from 0; otherwise 0 */
    int32_t column;      /* of a sweep: column of blocks, odd, from 1; 0: the mesh is not swept */
    struct par_ids done; /* blocks of phase `phase` that ended before it was halted; empty: the phase has not been
                            halted */
};

/* Returns whether the run is in the middle of a schedule of the whole mesh. */
static inline bool par_is_phase(enum par_next next) { return next == PAR_SIZES_PHASE || next == PAR_BOUNDS_PHASE; }
/* Returns whether the next step is the sequential call that ends a schedule of the whole mesh. */
static inline bool par_is_rest(enum par_next next) { return next == PAR_SIZES_REST || next == PAR_BOUNDS_REST; }

/* Returns whether a step belongs to the refinement for sizes alone, which precedes the one for all bounds. */
static inline bool par_is_of_sizes(enum par_next next) { return next < PAR_BOUNDS; }

#endif
