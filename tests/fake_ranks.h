/* Ranks that are threads of one process: what MPI does, done with barriers, so that sanitizers see all of it. */
#ifndef TESTS_FAKE_RANKS_H
#define TESTS_FAKE_RANKS_H

#include <pthread.h>

#include "sched/ranks/carrier.h"

struct fake_world {
    int n_ranks;
    pthread_barrier_t barrier;
    const int64_t **numbers;       /* [n_ranks] what each shows the others now .. */
    int32_t *width;                /* [n_ranks] .. and how many numbers; 0: one for each rank */
    const struct par_bytes **out;
    const void *spread;
    struct fake_rank *rank;
    int64_t *of_each;              /* [n_ranks][n_ranks * PAR_ROOM] */
};

struct fake_rank {
    struct fake_world *world;
    int self;
};

/* Asserts by cmocka that there is memory. */
void fake_world_init(struct fake_world *world, int n_ranks);
void fake_world_free(struct fake_world *world);
struct par_carrier fake_carrier(struct fake_world *world, int rank);

/* Runs work(user[i]) on one thread a rank, user[i] at user + i * size, and waits for all. */
void fake_run(struct fake_world *world, void *(*work)(void *user), void *user, size_t size);

#endif
