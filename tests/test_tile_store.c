/* A mesh that was stored tile by tile gives the same files, byte for byte, as a mesh that was in memory as a whole. */
#include "triangle/text/stream.h"

#include <errno.h>
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
#include "triangle/text/formats.h"

/* The last trial has integer attributes, which group its triangles. */
static const struct lattice SMALL = {5, 1, 2, 2, false, false}, PLAIN = {11, 3, 0, 0, true, true},
                            LARGE = {230, 37, 1, 1, true, false};
static const char *const names[] = {"x.vtu", "x.msh"};
enum { FILES = 2 };

/* --- files */

static enum tri_status write_all(const struct tri_grid *grid, struct tri_error *error)
{
    struct tri_output_set set;
    struct tri_output *output;
    enum tri_status status = TRI_OK;
    tri_outputs_begin(&set);
    for (int i = 0; i < FILES && !status; i++) {
        status = tri_output_open(&set, names[i], &output, error);
        status = status ? status : tri_format_of(names[i])->write(output, grid, NULL, error);
    }
    status = status ? status : tri_outputs_commit(&set, error);
    tri_outputs_abort(&set);
    return status;
}

/* The sink receives a few beginnings, each of which discards the mesh before it. */
static enum tri_status write_kept(const struct lattice *lattice, bool markers, int void_meshes, const char *folder,
                                  struct tri_error *error)
{
    struct tri_tile_store *store;
    struct tri_sink sink;
    struct tri_grid grid;
    enum tri_status status = tri_tile_store_new(&store, folder, &sink, error);
    for (int i = 0; i < void_meshes && !status; i++)
        status = lattice_hand_out(&SMALL, &sink, error);
    status = status ? status : lattice_hand_out(lattice, &sink, error);
    status = status ? status : tri_tile_store_grid(store, markers, &grid, error);
    status = status ? status : write_all(&grid, error);
    tri_tile_store_free(store);
    return status;
}

static int remove_files(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++)
        remove(names[i]);
    assert_int_equal(files_here(), 0);
    return 0;
}

static void compare(const struct lattice *lattice, bool markers, int void_meshes)
{
    const struct tri_grid grid = lattice_grid(lattice, markers);
    char *wanted[FILES];
    size_t size[FILES], n;
    assert_int_equal(write_all(&grid, NULL), TRI_OK);
    for (int i = 0; i < FILES; i++)
        wanted[i] = file_bytes(names[i], &size[i]);
    assert_int_equal(write_kept(lattice, markers, void_meshes, ".", NULL), TRI_OK);
    for (int i = 0; i < FILES; i++) {
        char *found = file_bytes(names[i], &n);
        assert_int_equal(n, size[i]);
        assert_memory_equal(found, wanted[i], n);
        free(found);
        free(wanted[i]);
    }
}

static void test_stored_tiles_give_the_same_bytes(void **state)
{
    (void)state;
    const struct lattice *all[] = {&SMALL, &PLAIN, &LARGE};
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            compare(all[i], k == 0, k);
}

static void test_a_lack_of_disk_space_is_reported(void **state)
{
    (void)state;
    struct rlimit before, limit;
    struct tri_error error;
    assert_int_equal(write_kept(&SMALL, true, 0, "nowhere", &error), TRI_CANNOT_WRITE);
    assert_string_equal(error.file, "nowhere");
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    for (rlim_t size = 0; size < 2000000; size = 2 * size + 7) {
        limit = (struct rlimit){size, before.rlim_max};
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
        enum tri_status status = write_kept(&LARGE, true, 0, ".", &error);
        assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
        assert_int_not_equal(status, TRI_OK);
        assert_int_equal(files_here(), 0);
    }
}

/* The error of a work array is in errno as well if there is a limit. */
static int fault_under(const struct tri_storage *storage, int resource, rlim_t most)
{
    struct rlimit before, limit;
    assert_int_equal(getrlimit(resource, &before), 0);
    limit = (struct rlimit){most, before.rlim_max};
    assert_int_equal(setrlimit(resource, &limit), 0);
    errno = 0;
    assert_null(storage->extra(storage->user, 1 << 20));
    const int fault = errno;
    assert_int_equal(setrlimit(resource, &before), 0);
    return fault;
}

static void test_the_reason_for_a_failed_growth_is_reported(void **state)
{
    (void)state;
    struct tri_tile_store *store;
    struct tri_sink sink;
    struct tri_grid grid;
    signal(SIGXFSZ, SIG_IGN);
    assert_int_equal(tri_tile_store_new(&store, ".", &sink, NULL), TRI_OK);
    assert_int_equal(tri_tile_store_grid(store, true, &grid, NULL), TRI_OK);
    assert_int_equal(fault_under(grid.storage, RLIMIT_FSIZE, 1000), EFBIG);
    assert_int_equal(fault_under(grid.storage, RLIMIT_NOFILE, 3), EMFILE);
    tri_tile_store_free(store);
}

static void test_lack_of_memory_is_reported(void **state)
{
    (void)state;
    enum tri_status status = TRI_NO_MEMORY;
    const int64_t held = atomic_load(&support_held);
    for (int64_t k = 1; status && k < 200; k++) {
        if (k == 2 || (k > 3 && k < 11)) /* allocations of the lattice */
            continue;
        atomic_store(&support_calls, 0);
        atomic_store(&support_fail_at, k);
        status = write_kept(&SMALL, true, 0, ".", NULL);
        atomic_store(&support_fail_at, INT64_MAX);
        assert_int_equal(atomic_load(&support_held), held);
        assert_true(status == TRI_OK || files_here() == 0);
    }
    assert_int_equal(status, TRI_OK);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_stored_tiles_give_the_same_bytes, remove_files),
        cmocka_unit_test_teardown(test_a_lack_of_disk_space_is_reported, remove_files),
        cmocka_unit_test(test_the_reason_for_a_failed_growth_is_reported),
        cmocka_unit_test_teardown(test_lack_of_memory_is_reported, remove_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
