/* The place of a run: what it does next. This, the round and the phase, the column of a sweep, and the blocks of the
 * phase that are done, are all that a state has to tell of what has been done, beside the mesh and the lists. */
#ifndef SCHED_SCHEDULE_NEXT_H
#define SCHED_SCHEDULE_NEXT_H

#include <stdbool.h>

/*              angles are dear          else
 *                     |                  |
 *                 PAR_SIZES              |          PAR_SIZES: coarse mesh, schedule; or one call, if small
 *                     v                  |
 *      .------- PAR_SIZES_PHASE          |          rounds of four phases
 *      |              v something left   |
 *      |        PAR_SIZES_REST           |          one call
 *      v              v                  |
 *      '--------> PAR_BOUNDS <-----------' <------------------------------------------.
 *                  |  |  \                                                            |
 *         one call |  |   '-- too large for memory --> PAR_COLUMN <----.              |
 *                  |  v                                    v           | next column  |
 *      .---------- | PAR_BOUNDS_PHASE               PAR_COLUMN_PHASE --'              |
 *      |           |  v something left                     |  |                       |
 *      |           | PAR_BOUNDS_REST         last column   |  '-- something left, for later rounds:
 *      v           v  v                                    |      the mesh as it was, not to be swept again
 *      '------> PAR_HAND_OUT                               |
 *                     v                                    v
 *                    end                                  end
 *
 * refine_by_schedule (schedule.c) chooses the first; run_schedule goes to .._PHASE, finish_schedule to .._REST,
 * refine_sizes_first to BOUNDS, deliver to HAND_OUT; begin_sweep and go_through (sched/tiles/sweep.c) to .._COLUMN and
 * .._COLUMN_PHASE, par_sweep back to BOUNDS. On ranks only .._PHASE is taken, by sched/ranks/ranks.c: the phase may be
 * PAR_PHASES, a round that is over.
 *
 * A state may be kept at all but PAR_SIZES, and at PAR_BOUNDS where something has been done before. In it:
 *
 *     .._PHASE       the mesh, with places that nobody uses; these; worklist, keys, cells, blocks that are done
 *     .._REST        the same; the worklist is for the call
 *     PAR_BOUNDS, PAR_HAND_OUT   the mesh, without gaps; the cells that made it, if any; no lists
 *     PAR_COLUMN     the mesh from this column on, and its worklist; tiles before it have been handed out
 *     PAR_COLUMN_PHASE   the same amid the column, whose list from the coarse mesh has joined the worklist */
enum par_next {
    PAR_SIZES,        /* the first step for sizes alone */
    PAR_SIZES_PHASE,  /* phase `phase` of round `round` of that schedule, but for the blocks that are `done` */
    PAR_SIZES_REST,   /* the call for what no block could do */
    PAR_BOUNDS,       /* the first step for all bounds */
    PAR_COLUMN,       /* `column` of a sweep */
    PAR_COLUMN_PHASE, /* phase `phase` of this column, but for the blocks that are `done` */
    PAR_BOUNDS_PHASE,
    PAR_BOUNDS_REST,
    PAR_HAND_OUT      /* nothing is refined any more */
};

/* Amid a schedule of the whole mesh? */
static inline bool par_is_phase(enum par_next next) { return next == PAR_SIZES_PHASE || next == PAR_BOUNDS_PHASE; }
static inline bool par_is_rest(enum par_next next) { return next == PAR_SIZES_REST || next == PAR_BOUNDS_REST; }

#endif
