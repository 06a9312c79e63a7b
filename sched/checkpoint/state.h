/* The state of a run that a checkpoint holds, and when states are written.
 *
 * A state holds the position of the run (sched/schedule/next.h). In a sweep it also holds the part of the mesh that is
 * in memory. If the mesh is kept as a whole, in memory or parked, it holds the whole mesh. A run that gives up its
 * sweep goes on with states of the second kind.
 *
 * THEOREM. A resumed run makes the same bytes as a run that was never stopped. The rest of a run depends only on the
 * mesh, the worklist and other lists, the free ranges of the arrays, the cells and the counts. All of these are in the
 * state, with the numbers by which they refer to each other. Refinement only reads the rest of the mesh (parents,
 * regions, limits, the caller's order), which is made again from the input. Tiles in the file are handed out again
 * unchanged. A run may therefore be resumed with another number of threads or another memory limit. A run is identified
 * by a hash of its initial mesh, bounds and options, on which everything else depends. */
#ifndef SCHED_CHECKPOINT_STATE_H
#define SCHED_CHECKPOINT_STATE_H

#include "sched/checkpoint/checkpoint.h"
#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* Returns whether a state written now would be the last one before the time limit. now: tri_seconds(). triangles:
 * number of triangles that the state would hold.
 *
 * The last state begins at the latest when the remaining time is twice the time that writing it takes. That time is
 * estimated from the previous state, in proportion to the numbers of triangles. Early states measure the disk, until
 * one takes long enough to be a measurement. A resumed run measures halfway to the limit, because a large state right
 * at the beginning could use up all its time. */
bool par_state_is_last(const struct par_checkpoint *checkpoint, double now, double triangles);

/* Returns whether a state is due because of the interval between states or because of the time limit. */
bool par_state_is_due(const struct par_checkpoint *checkpoint, double now, double triangles);

/* Called at the beginning of a run, with the mesh as the caller passed it. If there is a state of a whole mesh,
 * restores the mesh, the lists, the cells, the counts and the position, which then says that this mesh is not swept.
 * TRI_BAD_INPUT: the state belongs to another run or is damaged, and nothing has changed. TRI_NO_MEMORY,
 * TRI_CANNOT_WRITE. */
enum tri_status par_state_begin(struct par_checkpoint *checkpoint, struct par_run *run, struct tri_error *error);

/* Returns a hash of everything on which the result depends: the requested bounds and options, and the mesh as it is
 * now. */
uint64_t par_state_run(const struct par_run *run);

/* Offers to write a state between two steps, or, if tiles is not NULL, between two columns of a sweep. run->place.next
 * is the step that the state will resume with. The state is written in four cases: if it is due; if the end was
 * requested (the function then returns TRI_STOPPED); if the receiver of the tiles has failed (returns its error); or if
 * `surely` is set. From this call on the mesh is not stopped within a step. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status par_state_border(struct par_checkpoint *checkpoint, struct par_run *run, struct par_tiles *tiles,
                                 bool surely, struct tri_error *error);

/* Runs a phase to its end, for a column of a sweep or, if tiles is NULL, for the whole mesh. On the way, states are
 * written between blocks. A state is written if it is due and states take at most a tenth of the time, or if the end is
 * requested; the function then returns TRI_STOPPED. With by_block, ids depend on which blocks run at once, so states
 * are written only between phases. Also TRI_CANNOT_WRITE, TRI_NO_MEMORY, or the result of the phase.
 *
 * Called on the calling thread. The blocks run as tasks; while a state is written, no block runs. */
enum tri_status par_state_phase(struct par_checkpoint *checkpoint, struct par_run *run, struct par_turn turn,
                                struct par_tiles *tiles, struct tri_error *error);

/* Called at the beginning of a sweep. Replaces the sink of the tiles by the checkpoint's spool, which hands out the
 * stored tiles again, and calls par_tiles_begin. If there is a state of the sweep, restores the mesh, the lists, the
 * position and the tiles' counts. From this call on the mesh is stopped only when a state can be written.
 * TRI_BAD_INPUT: the state is damaged. TRI_NO_MEMORY, TRI_CANNOT_WRITE, or the sink's error. */
enum tri_status par_state_begin_sweep(struct par_checkpoint *checkpoint, struct par_run *run,
                                      struct par_tiles *tiles, struct tri_error *error);

/* Called if the sweep is given up: discards its state and its tiles. TRI_CANNOT_WRITE. */
enum tri_status par_state_give_up_sweep(struct par_checkpoint *checkpoint, struct par_run *run,
                                        struct tri_error *error);

#endif
