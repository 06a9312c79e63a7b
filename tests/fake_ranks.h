/* Ranks that are threads of one process. They exchange data with barriers instead of MPI, so that sanitizers see
 * everything. */
#ifndef TESTS_FAKE_RANKS_H
#define TESTS_FAKE_RANKS_H

#include <pthread.h>

#include "sched/ranks/carrier.h"

struct fake_world {
    int n_ranks;
    pthread_barrier_t barrier;
    const int64_t **numbers;      /* [n_ranks] the numbers that each rank currently shows to the others ... */
    int32_t *width;               /* [n_ranks] ... and their count; 0: one for each rank */
    const struct par_bytes **out; /* [n_ranks] messages of each rank */
    const void *spread;           /* bytes that rank 0 sends to all */
    struct fake_rank *rank;       /* [n_ranks] */
    int64_t *of_each;             /* [n_ranks][n_ranks * PAR_ROOM] */
};

struct fake_rank {
    struct fake_world *world;
    int self; /* number of this rank */
};

/* Fails the test if there is no memory. */
void fake_world_init(struct fake_world *world, int n_ranks);
void fake_world_free(struct fake_world *world);
struct par_carrier fake_carrier(struct fake_world *world, int rank);

/* Runs work(user + i * size) for each rank i on a thread of its own, and waits for all. */
void fake_run(struct fake_world *world, void *(*work)(void *user), void *user, size_t size);

#endif
