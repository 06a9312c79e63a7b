/* The place of a run: what it does next. This, the round and the phase, the column of a sweep, and the blocks of the
 * phase that are done, are all that a state has to tell of what has been done, beside the mesh and the lists. */
#ifndef SCHED_SCHEDULE_NEXT_H
#define SCHED_SCHEDULE_NEXT_H

#include <stdbool.h>

/* The mesh has been triangulated, and angles are dear; else the run begins with PAR_BOUNDS.
 *
 *     PAR_SIZES --------------------.
 *        | coarse mesh              | one call, where the mesh is small
 *     PAR_SIZES_PHASE --.           |
 *        | rounds       | nothing   |
 *     PAR_SIZES_REST    | is left   |
 *        | last call    |           |
 *     PAR_BOUNDS <------'-----------' <-----------------------------------------------.
 *        | coarse mesh, or that of the sizes   |  \                                   |
 *        |                                     |   \ too large for memory             |
 *        |                                     |    PAR_COLUMN <--. the column's      | blocks leave something
 *        |                        one call, if |     | its list   | tiles             | over: from its mesh on,
 *     PAR_BOUNDS_PHASE --.  small, -S, ...     |    PAR_COLUMN_PHASE                  | and never swept again
 *        | rounds        | nothing             |     |   '------------------------------'
 *     PAR_BOUNDS_REST    | is left             |     | last tiles
 *        | last call     |                     |     '-> the end
 *     PAR_HAND_OUT <-----'---------------------'
 *        | tiles, or none
 *     the end
 *
 * A state may be kept at each of these but for the first, where nothing has been done. Made by, in schedule.c:
 * refine_by_schedule (SIZES to BOUNDS), run_schedule (to .._PHASE), finish_schedule (to .._REST), deliver (to
 * HAND_OUT); in sched/tiles/sweep.c: sweep_columns, go_through; leave_memory goes back to BOUNDS. In a state:
 *
 *     PAR_BOUNDS    the mesh, and its tiles where a schedule has made it: no lists
 *     .._PHASE      worklist and keys, free ranges, blocks that are done; the mesh has free places
 *     .._REST       the same, and the round is the last
 *     PAR_COLUMN    the mesh holds columns from here on; tiles before them have been handed out
 *     PAR_HAND_OUT  the mesh is finished, and numbered unless that is left out */
enum par_next {
    PAR_SIZES,        /* sizes, from the beginning */
    PAR_SIZES_PHASE,  /* phase `phase` of round `round` of the schedule for sizes, but for blocks that are done */
    PAR_SIZES_REST,   /* the call for what no block could do */
    PAR_BOUNDS,       /* all bounds, from the beginning */
    PAR_COLUMN,       /* of a sweep: a column, from its beginning */
    PAR_COLUMN_PHASE, /* phase `phase` of this column, but for blocks that are done */
    PAR_BOUNDS_PHASE,
    PAR_BOUNDS_REST,
    PAR_HAND_OUT      /* nothing is refined any more */
};

/* Amid a schedule of the whole mesh? */
static inline bool par_is_phase(enum par_next next) { return next == PAR_SIZES_PHASE || next == PAR_BOUNDS_PHASE; }
static inline bool par_is_rest(enum par_next next) { return next == PAR_SIZES_REST || next == PAR_BOUNDS_REST; }

#endif
