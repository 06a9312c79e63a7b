/* A sink behind a queue receives copies of all tiles in order. Failures are returned, nothing hangs, and nothing
   leaks. */
#include "sched/tiles/queue.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "tests/allocations.h"
#include "tests/lattice_tiles.h"
#include "triangle/base/status.h"

static const struct lattice LATTICE = {60, 3, 2, 1, true, false};

/* Checksum over all received bytes, in order. */
struct judge {
    uint64_t sum;
    int tiles, begun, ended;
    int fail_at; /* number of the tile that is refused; 0: none */
};

static void add_bytes(struct judge *judge, const void *data, size_t n)
{
    const unsigned char *bytes = data;
    for (size_t i = 0; i < n; i++)
        judge->sum = (judge->sum ^ bytes[i]) * 1099511628211u;
}

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct judge *judge = user;
    (void)stream, (void)error;
    judge->begun++;
    judge->sum = 7;
    judge->tiles = 0;
    return TRI_OK;
}

static enum tri_status take(void *user, const struct tri_tile *t, struct tri_error *error)
{
    struct judge *judge = user;
    if (++judge->tiles == judge->fail_at)
        return tri_fail(error, TRI_CANNOT_WRITE, "x", 0, "refused");
    const size_t n = (size_t)t->n_vertices, m = (size_t)t->n_triangles, s = (size_t)t->n_segments;
    add_bytes(judge, &t->first_vertex, 24);
    add_bytes(judge, t->points, n * 16);
    add_bytes(judge, t->point_markers, n * 4);
    add_bytes(judge, t->attributes, n * 16);
    add_bytes(judge, t->corners, m * 24);
    add_bytes(judge, t->regions, m * 4);
    add_bytes(judge, t->ends, s * 16);
    add_bytes(judge, t->segment_markers, s * 4);
    return TRI_OK;
}

static enum tri_status end(void *user, struct tri_error *error)
{
    (void)error;
    ((struct judge *)user)->ended++;
    return TRI_OK;
}

static struct tri_sink sink_of(struct judge *judge) { return (struct tri_sink){judge, begin, take, end}; }

static void test_the_sink_receives_the_same_tiles(void **state)
{
    (void)state;
    const int64_t most[] = {0, 1, 5000, 1 << 20};
    struct judge straight = {0}, queued = {0};
    const struct tri_sink to_straight = sink_of(&straight), to_queued = sink_of(&queued);
    assert_int_equal(lattice_hand_out(&LATTICE, &to_straight, NULL), TRI_OK);
    for (int i = 0; i < 8; i++) { /* each run twice, for a second beginning */
        struct par_queue queue;
        assert_true(par_queue_begin(&queue, &to_queued, most[i / 2]));
        const struct tri_sink sink = par_queue_sink(&queue);
        for (int k = 0; k <= i % 2; k++)
            assert_int_equal(lattice_hand_out(&LATTICE, &sink, NULL), TRI_OK);
        par_queue_free(&queue);
        assert_int_equal(queued.tiles, straight.tiles);
        assert_true(queued.sum == straight.sum);
    }
    assert_int_equal(queued.begun, 12);
    assert_int_equal(queued.ended, 12);
}

static void test_failures_are_returned(void **state)
{
    (void)state;
    for (int k = 1; k <= 21; k++) {
        struct judge judge = {.fail_at = k};
        const struct tri_sink to = sink_of(&judge);
        struct par_queue queue;
        struct tri_error error;
        assert_true(par_queue_begin(&queue, &to, k % 3 ? 20000 : 1 << 30));
        const struct tri_sink sink = par_queue_sink(&queue);
        assert_int_equal(lattice_hand_out(&LATTICE, &sink, &error), TRI_CANNOT_WRITE);
        assert_string_equal(error.text, "refused");
        par_queue_free(&queue);
        assert_int_equal(judge.tiles, k);
        assert_int_equal(judge.ended, 0);
    }
}

/* The producer of the tiles has failed, so the last tile never arrives. */
static enum tri_status hand_out_some(const struct tri_sink *sink)
{
    const struct tri_sink endless = {sink->user, sink->begin, sink->take, NULL};
    return lattice_hand_out(&LATTICE, &endless, NULL);
}

static void test_a_queue_may_be_dropped_before_its_end(void **state)
{
    (void)state;
    struct judge judge = {0};
    const struct tri_sink to = sink_of(&judge);
    struct par_queue queue;
    int64_t held = atomic_load(&support_held);
    assert_true(par_queue_begin(&queue, &to, 1 << 30));
    const struct tri_sink sink = par_queue_sink(&queue);
    assert_int_equal(hand_out_some(&sink), TRI_OK);
    par_queue_free(&queue);
    assert_int_equal(judge.ended, 0);
    assert_int_equal(atomic_load(&support_held), held);
    assert_true(par_queue_begin(&queue, &to, 1)); /* and a queue that never begins */
    par_queue_free(&queue);
}

static void test_lack_of_memory_is_reported(void **state)
{
    (void)state;
    struct judge judge = {0};
    const struct tri_sink to = sink_of(&judge);
    enum tri_status status = TRI_NO_MEMORY;
    int64_t held = atomic_load(&support_held);
    for (int64_t k = 10; status; k++) { /* earlier allocations are the lattice's and the thread's */
        struct par_queue queue;
        assert_true(par_queue_begin(&queue, &to, 5000));
        const struct tri_sink sink = par_queue_sink(&queue);
        atomic_store(&support_calls, 0);
        atomic_store(&support_fail_at, k);
        status = lattice_hand_out(&LATTICE, &sink, NULL);
        atomic_store(&support_fail_at, INT64_MAX);
        par_queue_free(&queue);
        assert_int_equal(atomic_load(&support_held), held);
        assert_true(status == TRI_OK || status == TRI_NO_MEMORY);
        assert_true(k < 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_the_sink_receives_the_same_tiles),
        cmocka_unit_test(test_failures_are_returned),
        cmocka_unit_test(test_a_queue_may_be_dropped_before_its_end),
        cmocka_unit_test(test_lack_of_memory_is_reported),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
