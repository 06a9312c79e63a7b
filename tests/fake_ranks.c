#include "fake_ranks.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

static void wait_for_all(struct fake_world *world) { pthread_barrier_wait(&world->barrier); }

/* Do all ranks make the same call? If not, real MPI would fail or mix up the messages. */
static bool are_together(const struct fake_world *world, int32_t width)
{
    bool same = true;
    for (int p = 0; p < world->n_ranks; p++)
        same = same && world->width[p] == width;
    return same;
}

static bool gather(void *self, const int64_t *mine, int32_t n, int64_t *all)
{
    const struct fake_rank *rank = self;
    struct fake_world *world = rank->world;
    size_t width = (size_t)n;
    world->numbers[rank->self] = mine;
    world->width[rank->self] = n;
    wait_for_all(world);
    const bool good = are_together(world, n);
    for (int p = 0; good && p < world->n_ranks; p++)
        memcpy(all + (size_t)p * width, world->numbers[p], width * sizeof *all);
    wait_for_all(world);
    return good;
}

static bool deal(void *self, const int64_t *to, int64_t *from)
{
    const struct fake_rank *rank = self;
    struct fake_world *world = rank->world;
    world->numbers[rank->self] = to;
    world->width[rank->self] = 0;
    wait_for_all(world);
    const bool good = are_together(world, 0);
    for (int p = 0; good && p < world->n_ranks; p++)
        from[p] = world->numbers[p][rank->self];
    wait_for_all(world);
    return good;
}

static bool transfer(void *self, const struct par_bytes *out, const struct par_bytes *in)
{
    const struct fake_rank *rank = self;
    struct fake_world *world = rank->world;
    bool fits = true;
    world->out[rank->self] = out;
    wait_for_all(world);
    for (int p = 0; p < world->n_ranks; p++) {
        const struct par_bytes *from = &world->out[p][rank->self];
        if (p == rank->self)
            continue;
        fits = fits && from->n == in[p].n;
        if (fits && from->n > 0)
            memcpy(in[p].at, from->at, from->n);
    }
    wait_for_all(world);
    return fits;
}

static bool spread(void *self, void *bytes, size_t n)
{
    const struct fake_rank *rank = self;
    struct fake_world *world = rank->world;
    if (rank->self == 0)
        world->spread = bytes;
    wait_for_all(world);
    if (rank->self > 0 && n > 0)
        memcpy(bytes, world->spread, n);
    wait_for_all(world);
    return true;
}

void fake_world_init(struct fake_world *world, int n_ranks)
{
    size_t n = (size_t)n_ranks;
    *world = (struct fake_world){.n_ranks = n_ranks};
    world->numbers = calloc(n, sizeof *world->numbers);
    world->width = calloc(n, sizeof *world->width);
    world->out = calloc(n, sizeof *world->out);
    world->rank = calloc(n, sizeof *world->rank);
    world->of_each = calloc(n * n * PAR_ROOM, sizeof *world->of_each);
    assert_true(world->numbers && world->width && world->out && world->rank);
    assert_non_null(world->of_each);
    assert_int_equal(pthread_barrier_init(&world->barrier, NULL, (unsigned)n_ranks), 0);
    for (int p = 0; p < n_ranks; p++)
        world->rank[p] = (struct fake_rank){world, p};
}

void fake_world_free(struct fake_world *world)
{
    pthread_barrier_destroy(&world->barrier);
    free(world->numbers);
    free(world->width);
    free(world->out);
    free(world->rank);
    free(world->of_each);
}

struct par_carrier fake_carrier(struct fake_world *world, int rank)
{
    return (struct par_carrier){.rank = rank, .n_ranks = world->n_ranks, .self = &world->rank[rank],
                                .of_each = world->of_each + rank * world->n_ranks * PAR_ROOM,
                                .gather = gather, .deal = deal, .transfer = transfer, .spread = spread};
}

void fake_run(struct fake_world *world, void *(*work)(void *user), void *user, size_t size)
{
    pthread_t *thread = calloc((size_t)world->n_ranks, sizeof *thread);
    assert_non_null(thread);
    for (int p = 0; p < world->n_ranks; p++)
        assert_int_equal(pthread_create(&thread[p], NULL, work, (char *)user + (size_t)p * size), 0);
    for (int p = 0; p < world->n_ranks; p++)
        assert_int_equal(pthread_join(thread[p], NULL), 0);
    free(thread);
}
