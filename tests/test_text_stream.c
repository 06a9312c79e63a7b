/* Text files of a stream of tiles equal those of the mesh in memory byte for byte, for any estimate of its size. */
#include "triangle/text/stream.h"

#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "tests/allocations.h"
#include "tests/files.h"
#include "tests/lattice_tiles.h"

static const struct lattice SMALL = {5, 1, 2, 2, false, false}, PLAIN = {11, 3, 0, 0, true, true},
                            LARGE = {230, 37, 1, 1, true, false};

static double sites[] = {0.5, 0.5, 0.25, 0.125, 1, 2, 3, 4};
static const struct tri_pslg FIGURE = {.n_holes = 2, .holes = sites, .n_regions = 1, .regions = sites + 4};
static char *words[] = {"program", "-pq\n30"};

/* --- files */

static const char *names[] = {"x.node", "x.ele", "x.poly"};

static enum tri_status open_all(struct tri_output_set *set, struct tri_text_options *o, struct tri_error *error)
{
    struct tri_output **files[] = {&o->node, &o->ele, &o->poly};
    enum tri_status status = TRI_OK;
    tri_outputs_begin(set);
    for (int i = 0; i < 3 && !status; i++)
        status = tri_output_open(set, names[i], files[i], error);
    return status;
}

static void write_grid(const struct lattice *lattice, struct tri_text_options o)
{
    struct tri_output_set set;
    struct tri_grid grid = lattice_grid(lattice, o.markers);
    grid.base = o.base;
    grid.figure = o.figure;
    assert_int_equal(open_all(&set, &o, NULL), TRI_OK);
    assert_int_equal(tri_write_node(o.node, &grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_write_ele(o.ele, &grid, NULL, NULL), TRI_OK);
    assert_int_equal(tri_write_poly(o.poly, &grid, NULL, NULL), TRI_OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(tri_write_comment(&set.outputs[i], o.argc, o.argv, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
}

/* A sink that receives a different estimate. */
struct teller {
    struct tri_sink to;
    double estimate;
};

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    const struct teller *teller = user;
    struct tri_stream other = *stream;
    other.estimate = teller->estimate;
    return teller->to.begin(teller->to.user, &other, error);
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    const struct teller *teller = user;
    return teller->to.take(teller->to.user, tile, error);
}

static enum tri_status end(void *user, struct tri_error *error)
{
    const struct teller *teller = user;
    return teller->to.end(teller->to.user, error);
}

static enum tri_status write_stream(const struct lattice *lattice, struct tri_text_options o, double estimate,
                                    struct tri_error *error)
{
    struct tri_output_set set;
    struct tri_text_stream *stream = NULL;
    struct teller teller = {.estimate = estimate};
    const struct tri_sink sink = {&teller, begin, take, end};
    enum tri_status status = open_all(&set, &o, error);
    status = status ? status : tri_text_stream_new(&stream, &o, &teller.to, error);
    status = status ? status : lattice_hand_out(lattice, &sink, error);
    tri_text_stream_free(stream);
    status = status ? status : tri_outputs_commit(&set, error);
    tri_outputs_abort(&set);
    return status;
}

static int remove_files(void **state)
{
    (void)state;
    for (int i = 0; i < 3; i++)
        remove(names[i]);
    assert_int_equal(files_here(), 0);
    return 0;
}

static void compare(const struct lattice *lattice, const struct tri_text_options *o, double estimate)
{
    char *wanted[3];
    size_t n;
    write_grid(lattice, *o);
    for (int i = 0; i < 3; i++)
        wanted[i] = file_bytes(names[i], &n);
    assert_int_equal(write_stream(lattice, *o, estimate, NULL), TRI_OK);
    for (int i = 0; i < 3; i++) {
        char *found = file_bytes(names[i], &n);
        assert_string_equal(found, wanted[i]);
        free(found);
        free(wanted[i]);
    }
}

static void test_streamed_files_have_the_same_bytes(void **state)
{
    (void)state;
    const struct lattice *all[] = {&SMALL, &PLAIN, &LARGE};
    const double estimates[] = {0, 1, 35, 200, 5000, 1e5, 3e7, 1e300, -1};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 9; k++) {
            const struct tri_text_options options = {.base = k % 2, .markers = k % 3 > 0, .argc = 2, .argv = words,
                                                     .figure = k % 5 ? &FIGURE : NULL};
            compare(all[i], &options, estimates[k]);
        }
}

static void test_a_full_disk_is_reported(void **state)
{
    (void)state;
    struct rlimit before, limit;
    struct tri_error error;
    const struct tri_text_options options = {.markers = true, .argc = 2, .argv = words};
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    for (rlim_t size = 0; size < 3000000; size = 2 * size + 7) {
        limit = (struct rlimit){size, before.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        enum tri_status status = write_stream(&LARGE, options, 1, &error);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_int_equal(status, TRI_CANNOT_WRITE);
        assert_int_equal(files_here(), 0);
    }
}

static void test_lack_of_memory_is_reported(void **state)
{
    (void)state;
    const struct tri_text_options options = {.markers = true, .argc = 2, .argv = words};
    enum tri_status status = TRI_NO_MEMORY;
    const int64_t held = atomic_load(&support_held);
    for (int64_t k = 1; status; k++) {
        if (k > 8 && k < 16) /* allocations of the lattice */
            continue;
        atomic_store(&support_calls, 0);
        atomic_store(&support_fail_at, k);
        status = write_stream(&SMALL, options, 1e9, NULL);
        atomic_store(&support_fail_at, INT64_MAX);
        assert_int_equal(atomic_load(&support_held), held);
        assert_true(status == TRI_OK || files_here() == 0);
        assert_true(k < 200);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_streamed_files_have_the_same_bytes, remove_files),
        cmocka_unit_test_teardown(test_a_full_disk_is_reported, remove_files),
        cmocka_unit_test_teardown(test_lack_of_memory_is_reported, remove_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
