/* Mapped scratch files: bytes stay while files grow, and a file that cannot grow is an error that changes nothing. */
#define _GNU_SOURCE
#include <errno.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>
#include <sys/resource.h>

#include <cmocka.h>

#include "triangle/base/mapped_file.h"

static void test_bytes_stay_while_a_file_grows(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = -1};
    for (size_t size = 1; size <= 1 << 20; size *= 32) {
        const size_t before = f.size;
        assert_int_equal(tri_mapped_file_extend(&f, ".", size), 0);
        assert_true(f.size == size && f.at);
        for (size_t k = 0; k < before; k++)
            assert_int_equal(((unsigned char *)f.at)[k], k % 251);
        for (size_t k = before; k < size; k++)
            ((unsigned char *)f.at)[k] = (unsigned char)(k % 251);
        tri_mapped_file_release_pages(&f);
    }
    tri_mapped_file_close(&f);
    assert_true(f.file == -1 && !f.at && f.size == 0);
}

static void test_what_is_appended_is_mapped(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = -1};
    assert_true(tri_mapped_file_map(&f) && !f.at);
    assert_true(tri_mapped_file_append(&f, ".", "one", 3) && tri_mapped_file_append(&f, ".", "two", 3));
    assert_true(tri_mapped_file_map(&f) && f.size == 6);
    assert_memory_equal(f.at, "onetwo", 6);
    tri_mapped_file_close(&f);
}

/* errno survives closing. */
static void test_a_file_that_cannot_grow_stays(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = -1};
    struct rlimit usual, small;
    assert_int_equal(tri_mapped_file_extend(&f, ".", 4096), 0);
    memset(f.at, 7, 4096);
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &usual), 0);
    small = usual;
    small.rlim_cur = 8192;
    signal(SIGXFSZ, SIG_DFL);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    assert_int_equal(tri_mapped_file_extend(&f, ".", 1 << 20), EFBIG);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &usual), 0);
    assert_true(f.size == 4096 && ((char *)f.at)[4095] == 7);
    errno = EFBIG;
    tri_mapped_file_close(&f);
    assert_int_equal(errno, EFBIG);
    assert_int_equal(tri_mapped_file_extend(&f, "no/such/folder", 1), ENOENT);
    assert_false(tri_mapped_file_append(&f, "no/such/folder", "x", 1));
    tri_mapped_file_close(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_bytes_stay_while_a_file_grows),
        cmocka_unit_test(test_what_is_appended_is_mapped),
        cmocka_unit_test(test_a_file_that_cannot_grow_stays),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
