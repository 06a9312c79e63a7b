/* The way of refiners that have paused, and of a phase that has been halted, into a state's file and out of it. */
#ifndef SCHED_CHECKPOINT_CARRY_HALT_H
#define SCHED_CHECKPOINT_CARRY_HALT_H

#include "sched/checkpoint/checkpoint.h"
#include "sched/schedule/halt.h"

/* What is carried refers to things below these counts. */
struct par_carried_counts {
    int64_t triangles, subs, blocks;
};

/* Of a refiner whose list has so many entries. Where it is read, *pause becomes a new one. Sets file->failed where it
 * cannot be one. TRI_NO_MEMORY: *pause is NULL. */
enum tri_status par_carry_pause(struct par_state_file *file, struct tri_pause **pause,
                                const struct par_carried_counts *counts, int64_t n_listed, struct tri_error *error);

/* Where it is read, *halt is empty before, and `spare` has room for what the blocks will give back; its blocks are
 * those that the state told of. The same errors: what *halt has then is to be dropped. */
enum tri_status par_carry_halt(struct par_state_file *file, struct par_halt *halt, struct par_room *spare,
                               const struct par_carried_counts *counts, int64_t n_blocks, struct tri_error *error);

#endif
