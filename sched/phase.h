/* One phase: all blocks of one colour, refined at once on views of the mesh.
 *
 * THEOREM. The result of a phase is that of running its blocks one after the other, in any order (triangle/refine.h,
 * serialisation): their fences are disjoint. And what a block does, it does in an order of its own: so the mesh does
 * not depend on the number of threads. */
#ifndef SCHED_PHASE_H
#define SCHED_PHASE_H

#include "sched/schedule.h"
#include "sched/partition.h"
#include "sched/pool.h"
#include "sched/room.h"

void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add);

/* What the phases of a schedule hand on. */
struct par_state {
    struct tri_mesh *mesh;
    const struct tri_refine_options *quality;
    const struct par_options *options;
    int threads;
    struct par_slots pool;   /* triangles that may be bad, in canonical order; some may have gone since */
    struct par_room spare;   /* unused ranges of the arrays */
    double radius;           /* largest circumradius in the pool when it was last filled */
    struct par_report *report;
    int32_t n_schedules;     /* begun so far; the last is the one that works */
    int round;
    int32_t n_kept;          /* vertices there were before */
    bool may_number;         /* nothing is refined after this schedule but what it leaves over */
    bool numbered;           /* and nothing was */
};

/* Refines the blocks of one colour; takes from the pool what they can take and puts back what they leave. */
enum tri_status par_phase(struct par_state *state, const struct par_partition *partition, int colour,
                          struct tri_error *error);

#endif
