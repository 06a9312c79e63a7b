/* The triangles of a sweep's worklist that no block can have yet: the work of columns to come.
 *
 * THEOREM. A triangle waits for the first odd column whose blocks' right end lies right of all its corners. Until then
 * no block changes it, and none takes it from the worklist: for a block takes and changes what has all corners in its
 * fence, and the fences of that step and of those before end no further right. So the
 * triangle may be missing from the list until its column has its turn, and come into it by its key then. A list costs
 * what is in a few columns. */
#ifndef SCHED_TILES_AHEAD_H
#define SCHED_TILES_AHEAD_H

#include "sched/schedule/phase.h"

struct par_ahead {
    int32_t *item;  /* by odd column, those of one in the order of the worklist */
    uint64_t *key;  /* of each: its place there */
    int32_t *start; /* [n_odd + 1] */
    int32_t n_odd;
};

/* Of the worklist, which no block has had; the state is as before. False: no memory. To be freed in any case. */
bool par_ahead_make(struct par_ahead *ahead, const struct par_run *run, const struct par_partition *partition);
void par_ahead_free(struct par_ahead *ahead);

/* Those that wait for an odd column come to the worklist. False: no memory. */
bool par_ahead_give(const struct par_ahead *ahead, struct par_run *run, int32_t odd);

#endif
