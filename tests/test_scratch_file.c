/* Files without a name: each its own, gone with its descriptor; and what is told where there is none. */
#define _GNU_SOURCE /* O_TMPFILE */
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/allocations.h"
#include "tests/files.h"
#include "triangle/base/scratch_file.h"

static void test_each_is_its_own(void **state)
{
    (void)state;
    char found[2];
    struct stat about;
    const int before = files_here(), first = tri_scratch_file("."), second = tri_scratch_file("./");
    assert_true(first >= 0 && second >= 0);
    assert_int_equal(files_here(), before);
    assert_int_equal(pwrite(first, "ab", 2, 0), 2);
    assert_int_equal(pread(first, found, 2, 0), 2);
    assert_memory_equal(found, "ab", 2);
    assert_int_equal(fstat(second, &about), 0);
    assert_int_equal(about.st_size, 0);
    assert_int_equal(about.st_nlink, 0);
    close(first);
    close(second);
}

/* One that had a name is listed under it, as deleted. */
static void test_never_has_a_name(void **state)
{
    (void)state;
#ifdef O_TMPFILE
    char link[64], found[4096] = "";
    const int probe = open(".", O_TMPFILE | O_RDWR, S_IRUSR | S_IWUSR), file = tri_scratch_file(".");
    assert_true(file >= 0);
    snprintf(link, sizeof link, "/proc/self/fd/%d", file);
    if (probe >= 0 && readlink(link, found, sizeof found - 1) > 0)
        assert_null(strstr(found, "/ptriangle-"));
    close(probe);
    close(file);
#endif
}

static void test_there_is_none(void **state)
{
    (void)state;
    enum { N = 100000 };
    char *const longest = malloc(N);
    memset(longest, 'x', N);
    longest[N - 1] = '\0';
    assert_int_equal(tri_scratch_file("nowhere"), -1);
    assert_int_equal(errno, ENOENT);
    assert_int_equal(tri_scratch_file(longest), -1);
    assert_int_equal(errno, ENAMETOOLONG);
    free(longest);
}

#ifdef SUPPORT_WRAP
static void test_no_memory(void **state)
{
    (void)state;
    const int64_t held = support_held;
    errno = 0;
    support_calls = 0;
    support_fail_at = 1;
    assert_int_equal(tri_scratch_file("nowhere"), -1); /* only a name takes memory */
    support_fail_at = INT64_MAX;
    assert_int_equal(errno, ENOMEM);
    assert_int_equal(support_held, held);
}
#endif

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_is_its_own),
        cmocka_unit_test(test_never_has_a_name),
        cmocka_unit_test(test_there_is_none),
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_no_memory),
#endif
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
