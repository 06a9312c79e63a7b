/* What a checkpoint keeps of a run, and when.
 *
 * What comes next (sched/schedule/next.h), and of a sweep what is in memory, of a mesh that stays as a whole, in memory
 * or parked, all of it. A run that gives up its sweep goes over to the second.
 *
 * THEOREM. A run that goes on ends with the bytes of one that was never stopped. For what is still to come depends on
 * the mesh, the lists of what is left, the free ranges of the arrays, the cells and the counts alone: all of them are
 * in the state, with the numbers by which they refer to each other; the rest of the mesh (parents,
 * regions, limits, the caller's order) refinement only reads, and it is made anew from the input. Tiles that are in the
 * file are handed out again as they were. So neither the number of threads nor the memory need be the same. What the
 * run is of is told by a hash over the mesh, the bounds and the options with which it begins, on which all else
 * depends. */
#ifndef SCHED_CHECKPOINT_STATE_H
#define SCHED_CHECKPOINT_STATE_H

#include "sched/checkpoint/checkpoint.h"
#include "sched/schedule/phase.h"
#include "sched/tiles/tiles.h"

/* Is a state that begins now the last before the limit of time? It begins before the limit by twice the time that it
 * will take, as the last one took for its triangles. Early states measure the disk, until one takes long enough for
 * that. A run that is resumed measures halfway: a large state right at the beginning could take all of its time. */
bool par_state_is_last(const struct par_checkpoint *checkpoint, double now, double triangles);

/* Is it time for a state? */
bool par_state_is_due(const struct par_checkpoint *checkpoint, double now, double triangles);

/* When a run begins, with the mesh as it came. Where there is the state of a mesh as a whole, the mesh, the lists, the
 * cells and the counts become what they were, and the place, which then tells that this mesh is not swept.
 * TRI_BAD_INPUT: the state is another run's, or damaged, and nothing has changed. TRI_NO_MEMORY, TRI_CANNOT_WRITE. */
enum tri_status par_state_begin(struct par_checkpoint *checkpoint, struct par_run *run, struct tri_error *error);

/* A hash of all that the result depends on: the bounds and options that are asked for, and the mesh as it is now. */
uint64_t par_state_run(const struct par_run *run);

/* Between two steps, or (tiles not NULL) two columns of a sweep, the next one being what the state says. Writes the
 * state where it is time to, where somebody asks for the end (TRI_STOPPED then), where the tiles' taker has failed (its
 * failure then), or, `surely`, in any case. From here on the mesh is not stopped within a step. TRI_CANNOT_WRITE,
 * TRI_NO_MEMORY. */
enum tri_status par_state_border(struct par_checkpoint *checkpoint, struct par_run *run, struct par_tiles *tiles,
                                 bool surely, struct tri_error *error);

/* Runs a phase to its end, of a column of a sweep or (tiles NULL) of the whole mesh. Keeps states of it on the way,
 * between blocks: where it is time to, unless more than a tenth of the time would go into that, and where somebody asks
 * for the end (TRI_STOPPED then); by_block, where ids depend on which blocks run at once, between phases alone. Also
 * TRI_CANNOT_WRITE, TRI_NO_MEMORY, or what the phase says. */
enum tri_status par_state_phase(struct par_checkpoint *checkpoint, struct par_run *run, struct par_turn turn,
                                struct par_tiles *tiles, struct tri_error *error);

/* When a sweep begins: the tiles' sink becomes the checkpoint's, which may hand out tiles again; then par_tiles_begin;
 * and where there is a state, the mesh, the lists, the place and the tiles' counts become what they were. From here on
 * the mesh is stopped where a state is kept alone. TRI_BAD_INPUT: the state is damaged. TRI_NO_MEMORY,
 * TRI_CANNOT_WRITE, or what the sink says. */
enum tri_status par_state_begin_sweep(struct par_checkpoint *checkpoint, struct par_run *run,
                                      struct par_tiles *tiles, struct tri_error *error);

/* The sweep has been given up: what it has done is worth nothing. TRI_CANNOT_WRITE. */
enum tri_status par_state_give_up_sweep(struct par_checkpoint *checkpoint, struct par_run *run,
                                        struct tri_error *error);

#endif
