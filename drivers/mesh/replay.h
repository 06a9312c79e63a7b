/* What a mesh that one process has made would have taken on the ranks of a network: a prediction from measured blocks,
 * never a measurement.
 *
 * MODEL. Every rank makes the coarse mesh. Tiles go to ranks as sched/ranks/ deals them out; a block is done by the
 * rank that owns the first of its tiles, and whoever owns another of them lends and gets back. Four phases follow each
 * other, and those of a second schedule on the same cells, where angles are dear. Each takes as long as its busiest
 * rank refines (list scheduling on its threads: prediction.h), then as long as the busiest one packs and unpacks, then
 * as long as the slowest one's messages are under way; agreements take some latencies in proportion to the logarithm
 * of the number of ranks, and whoever waits for one sleeps and looks again, half a millisecond late at most. Then each
 * rank numbers and hands out what it owns.
 *
 * Not in the model: links of the network that are shared, threads and ranks that share caches and memory, files. Nor
 * may ranks begin a phase while others, elsewhere in the plane, still refine for the last one, which would be quicker.
 */
#ifndef DRIVERS_MESH_REPLAY_H
#define DRIVERS_MESH_REPLAY_H

#include "sched/schedule/schedule.h"

enum { REPLAY_SCHEDULES = 2 };

/* A block, and one more rank that owns a part of it. */
struct replay_pair {
    double bytes;   /* lent and given back */
    double seconds; /* of a processor, for packing and unpacking these, of both ranks */
    double swaps;   /* times that ranks exchange something in a phase: lent, asked for and lent, given back */
};

struct replay_how {
    int n_ranks, threads;  /* of each rank */
    int times;             /* the mesh is so many copies of the measured one, in each direction; >= 1 */
    double latency;        /* seconds of a message */
    double bandwidth;      /* bytes a second that a rank sends and receives */
    double lateness;       /* seconds, on average, that a rank which waits notices an agreement too late */
    struct replay_pair pair[REPLAY_SCHEDULES];
};

struct replay { /* seconds; the first five add up to the total */
    double alone;           /* for the coarse mesh, on each rank, and for what is not replayed */
    double refine, merge, communicate;
    double hand_out;        /* numbers and tiles */
    double total;
    double processor;       /* of the rank that takes most */
    double bytes, messages; /* that are sent, of all ranks */
    double most_bytes;      /* that one rank sends */
};

/* The network of the predictions in docs/scaling.md, and what has been measured on ranks, for cells of so many
 * triangles. In the first schedule it goes with their area: the seam that a phase leaves for the next is as long as a
 * cell, and some triangles of the coarse mesh wide, which grow with the cells. In the second, which finds little to do
 * in most places, it is the same for all. */
struct replay_how replay_usual(int n_ranks, int threads, int times, double cell);

/* Blocks of the first rounds of the report's own schedule, and of the one behind it, are replayed; later rounds count
 * as done by one rank. False: no memory, or no schedule. O(blocks times^2). */
bool replay_on_ranks(const struct par_report *report, const struct replay_how *how, struct replay *replay);

#endif
