/* What a run would have taken on other numbers of threads: a prediction from its own clock, never a measurement.
 *
 * Blocks of one phase are independent, phases follow one another. So the parallel part takes, on n threads, the sum
 * over the phases of the time that list scheduling of their blocks takes. What other stages do in equal shares, and
 * numbering, is shared out, to as many threads as there were shares; all else is taken for sequential. List scheduling,
 * largest first, ends within 4/3 of the best schedule.
 * Not in the model: threads that share caches, memory bandwidth or a core's units, beyond what the measured run had of
 * it.
 * Source: R. L. Graham, "Bounds on Multiprocessing Timing Anomalies", SIAM J. Appl. Math. 17 (1969), theorem 2. */
#ifndef DRIVERS_MESH_PREDICTION_H
#define DRIVERS_MESH_PREDICTION_H

#include "sched/schedule/schedule.h"

/* Seconds until the last of n pieces of work ends, where each goes to the thread that is free first, the longest first.
 * Sorts `seconds`; `load` [threads] is scratch. */
double prediction_makespan(double *seconds, int32_t n, double *load, int threads);

/* Seconds of the phases' parallel parts on so many threads, threads >= 1. first_round: blocks of rounds before it do
 * not count. Negative: no memory. O(n log n + n threads). */
double prediction_refine(const struct par_block_report *blocks, int32_t n_blocks, int first_round, int threads);

/* Seconds of refinement that no number of threads would shorten. */
double prediction_sequential(const struct par_report *report);

/* Seconds on so many threads of what stages did in shares; and of numbering, in TRI_MOST_SHARES of them. */
double prediction_shared(const struct par_report *report, int threads);
double prediction_number(const struct par_report *report, int threads);

/* Share of the schedule in the time from the Delaunay triangulation to the merged mesh, in percent: all that is neither
 * pre-refinement nor the refinement of blocks; and what numbering takes after it, against the same. 0 where one
 * sequential call did the work. */
double prediction_overhead(const struct par_report *report);
double prediction_numbering(const struct par_report *report);

#endif
