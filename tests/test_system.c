/* The interface to the operating system (triangle/base/system.h): files, folders, memory maps, threads, and the errors
   that they report. */
#define _GNU_SOURCE /* for O_TMPFILE */
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/allocations.h"
#include "tests/files.h"
#include "triangle/base/system.h"

/* --- files without a name: each is distinct, and is removed when its last user closes it */

static void test_scratch_files_are_distinct(void **state)
{
    (void)state;
    char found[2];
    struct tri_file_facts about;
    const int before = files_here();
    const tri_file first = tri_scratch_file("."), second = tri_scratch_file("./");
    assert_true(first != TRI_NO_FILE && second != TRI_NO_FILE);
    assert_int_equal(files_here(), before);
    assert_true(tri_write_at(first, "ab", 2, 0) && tri_read_back(first, found, 2, 0));
    assert_memory_equal(found, "ab", 2);
    assert_true(tri_file_get_facts(second, &about) && about.kind == TRI_REGULAR && about.size == 0 && about.names == 0);
    assert_true(tri_file_close(first) && tri_file_close(second));
}

/* A file that had a name is listed under it, marked as deleted. */
static void test_scratch_files_never_have_a_name(void **state)
{
    (void)state;
#ifdef O_TMPFILE
    char link[64], found[4096] = "";
    const int probe = open(".", O_TMPFILE | O_RDWR, S_IRUSR | S_IWUSR);
    const tri_file file = tri_scratch_file(".");
    assert_true(file != TRI_NO_FILE);
    snprintf(link, sizeof link, "/proc/self/fd/%d", (int)file);
    if (probe >= 0 && readlink(link, found, sizeof found - 1) > 0)
        assert_null(strstr(found, "/ptriangle-"));
    close(probe);
    assert_true(tri_file_close(file));
#endif
}

static void test_a_scratch_file_in_no_folder_is_an_error(void **state)
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
static void test_lack_of_memory_is_reported(void **state)
{
    (void)state;
    const int64_t held = support_held;
    errno = 0;
    support_calls = 0;
    support_fail_at = 1;
    assert_int_equal(tri_scratch_file("nowhere"), -1); /* only the name needs memory */
    support_fail_at = INT64_MAX;
    assert_int_equal(errno, ENOMEM);
    assert_int_equal(support_held, held);
}
#endif

/* --- maps: bytes are kept while files grow, and a failed growth is an error that changes nothing */

static void test_bytes_stay_while_a_file_grows(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = TRI_NO_FILE};
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
    assert_true(f.file == TRI_NO_FILE && !f.at && f.size == 0);
}

static void test_appended_bytes_are_mapped(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = TRI_NO_FILE};
    assert_true(tri_mapped_file_map(&f) && !f.at);
    assert_true(tri_mapped_file_append(&f, ".", "one", 3) && tri_mapped_file_append(&f, ".", "two", 3));
    assert_true(tri_mapped_file_map(&f) && f.size == 6);
    assert_memory_equal(f.at, "onetwo", 6);
    tri_mapped_file_close(&f);
}

/* Closing leaves errno unchanged. */
static void test_a_file_that_cannot_grow_is_unchanged(void **state)
{
    (void)state;
    struct tri_mapped_file f = {.file = TRI_NO_FILE};
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

/* --- reading and writing at an offset */

static void test_reading_and_writing_at_an_offset(void **state)
{
    (void)state;
    char found[8] = "";
    struct tri_file_facts about;
    const tri_file file = tri_file_open("placed", TRI_OPEN_NEW);
    assert_true(file != TRI_NO_FILE);
    assert_true(tri_write_at(file, "beyond", 6, 1000));
    assert_int_equal(tri_read_at(file, found, 8, 1003), 3);
    assert_memory_equal(found, "ond", 3);
    errno = 0;
    assert_false(tri_read_back(file, found, 8, 1003));
    assert_int_equal(errno, EIO);
    assert_true(tri_file_set_size(file, 2) && tri_file_get_facts(file, &about));
    assert_int_equal(about.size, 2);
    assert_int_equal(tri_file_open("placed", TRI_OPEN_NEW), TRI_NO_FILE);
    assert_int_equal(errno, EEXIST);
    assert_true(tri_file_sync(file) && tri_file_close(file) && tri_path_remove("placed"));
    assert_true(tri_file_close(TRI_NO_FILE));
    assert_int_equal(tri_file_open("placed", TRI_OPEN_READ), TRI_NO_FILE);
    assert_int_equal(errno, ENOENT);
}

/* Bytes written asynchronously are in the file once the caller has waited, both past the cache and through it. */
static void test_asynchronous_writes_arrive(void **state)
{
    (void)state;
    enum { N = 4 * TRI_PAGE_BYTES };
    const tri_file file = tri_scratch_file("."), direct = tri_file_direct(file);
    char *bytes = tri_page_alloc(N), *found = malloc(N);
    assert_non_null(bytes);
    for (int k = 0; k < N; k++)
        bytes[k] = (char)(k % 97);
    for (int k = 0; k < 2; k++) {
        struct tri_async *behind = tri_async_start(k && direct != TRI_NO_FILE ? direct : file, bytes, N, k * N);
        assert_non_null(behind);
        assert_int_equal(tri_async_wait(behind), N);
        assert_true(tri_read_back(file, found, N, k * N));
        assert_memory_equal(found, bytes, N);
    }
    free(bytes);
    free(found);
    assert_true(tri_file_close(direct) && tri_file_close(file));
}

/* --- names and folders */

static void make(const char *path)
{
    const tri_file file = tri_file_open(path, TRI_OPEN_NEW);
    assert_true(tri_file_close(file) && tri_path_allows(path, TRI_THERE));
}

/* Two names of one file, and a rename over an existing name. */
static void test_files_are_linked_and_renamed(void **state)
{
    (void)state;
    struct tri_file_facts one, other;
    make("one");
    assert_true(tri_path_link("one", "two") && tri_path_get_facts("one", &one) && tri_path_get_facts("two", &other));
    assert_true(one.node == other.node && one.device == other.device && one.names == 2);
    make("three");
    assert_true(tri_path_rename("three", "two") && tri_path_get_facts("two", &other) && other.node != one.node);
    assert_false(tri_path_allows("three", TRI_THERE));
    assert_true(tri_path_remove("one") && tri_path_remove("two"));
    assert_false(tri_path_remove("one"));
    assert_int_equal(errno, ENOENT);
}

static void test_links_are_resolved(void **state)
{
    (void)state;
    assert_int_equal(symlink("nothing/yet", "link"), 0);
    char *resolved = tri_path_resolve("link");
    assert_string_equal(resolved, "nothing/yet");
    free(resolved);
    assert_int_equal(symlink("round", "round"), 0);
    assert_null(tri_path_resolve("round"));
    assert_int_equal(errno, ELOOP);
    assert_true(tri_path_remove("link") && tri_path_remove("round"));
}

static void test_folder_of_a_path(void **state)
{
    (void)state;
    char folder[TRI_PATH];
    tri_path_folder("nothing", folder);
    assert_string_equal(folder, ".");
    tri_path_folder("no/thing", folder);
    assert_string_equal(folder, "no/");
    tri_path_folder("/", folder);
    assert_string_equal(folder, "/");
}

static bool count_names(void *user, const char *name)
{
    *(int *)user += name[0] != '.';
    return true;
}

/* A file gets its name when it is complete. Links are not followed, and a file with a second name is refused if it is
   to be extended. */
static void test_files_get_names_when_complete(void **state)
{
    (void)state;
    int names = 0;
    assert_true(tri_folder_make("folder"));
    const tri_file folder = tri_folder_open("folder", true);
    assert_true(folder != TRI_NO_FILE);
    tri_file file = tri_folder_create(folder, "state");
    assert_true(file != TRI_NO_FILE && tri_write_at(file, "x", 1, 0) && tri_folder_commit(folder, "state", file));
    assert_true(tri_file_close(file) && tri_folder_has(folder, "state") && tri_file_sync(folder));
    assert_true(tri_folder_list(folder, count_names, &names));
    assert_int_equal(names, 1);
    assert_int_equal(symlink("state", "folder/link"), 0);
    assert_int_equal(tri_folder_file(folder, "link", TRI_FOLDER_READ), TRI_NO_FILE);
    assert_true(tri_path_link("folder/state", "folder/second"));
    assert_int_equal(tri_folder_file(folder, "second", TRI_FOLDER_EXTEND), TRI_NO_FILE);
    assert_int_equal(errno, EPERM);
    file = tri_folder_file(folder, "second", TRI_FOLDER_READ);
    assert_true(file != TRI_NO_FILE && tri_file_close(file));
    assert_true(tri_folder_rename(folder, "second", "first") && tri_folder_unlink(folder, "first"));
    assert_true(tri_folder_unlink(folder, "link") && tri_folder_unlink(folder, "state") && tri_file_close(folder));
    assert_true(tri_folder_remove("folder"));
    assert_int_equal(tri_folder_open("folder", false), TRI_NO_FILE);
}

/* --- threads */

struct counted {
    struct tri_monitor *monitor;
    int n;
};

static void *count_one(void *user)
{
    struct counted *c = user;
    tri_monitor_enter(c->monitor);
    c->n++;
    tri_monitor_wake(c->monitor);
    tri_monitor_leave(c->monitor);
    return NULL;
}

static void *look_at_mask(void *mask)
{
    pthread_sigmask(SIG_SETMASK, NULL, mask);
    return NULL;
}

/* Otherwise a crash on another thread would end the program without calling its handler. */
static void test_threads_receive_only_their_own_faults(void **state)
{
    (void)state;
    sigset_t mask;
    struct tri_thread *thread = tri_thread_start(look_at_mask, &mask);
    assert_non_null(thread);
    tri_thread_join(thread);
    assert_true(sigismember(&mask, SIGTERM) && sigismember(&mask, SIGINT));
    assert_false(sigismember(&mask, SIGSEGV) || sigismember(&mask, SIGBUS));
}

static void test_threads_meet_in_a_monitor(void **state)
{
    (void)state;
    enum { N = 8 };
    struct counted c = {tri_monitor_new(), 0};
    struct tri_thread *thread[N];
    assert_non_null(c.monitor);
    for (int i = 0; i < N; i++)
        assert_non_null(thread[i] = tri_thread_start(count_one, &c));
    tri_monitor_enter(c.monitor);
    while (c.n < N)
        tri_monitor_wait(c.monitor);
    tri_monitor_leave(c.monitor);
    for (int i = 0; i < N; i++)
        tri_thread_join(thread[i]);
    tri_monitor_free(c.monitor);
}

/* --- time, memory, processes */

static void test_facts_about_the_machine_are_plausible(void **state)
{
    (void)state;
    char host[64];
    double of_files;
    const double before = tri_seconds();
    assert_true(tri_pause(0.01) && tri_seconds() - before >= 0.01);
    assert_true(tri_thread_seconds() <= tri_process_seconds());
    assert_true(tri_memory_used(&of_files) >= of_files);
    assert_true(tri_host_name(host, sizeof host));
    assert_false(tri_process_is_gone(tri_process()));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_scratch_files_are_distinct),
        cmocka_unit_test(test_scratch_files_never_have_a_name),
        cmocka_unit_test(test_a_scratch_file_in_no_folder_is_an_error),
#ifdef SUPPORT_WRAP
        cmocka_unit_test(test_lack_of_memory_is_reported),
#endif
        cmocka_unit_test(test_bytes_stay_while_a_file_grows),
        cmocka_unit_test(test_appended_bytes_are_mapped),
        cmocka_unit_test(test_a_file_that_cannot_grow_is_unchanged),
        cmocka_unit_test(test_reading_and_writing_at_an_offset),
        cmocka_unit_test(test_asynchronous_writes_arrive),
        cmocka_unit_test(test_files_are_linked_and_renamed),
        cmocka_unit_test(test_links_are_resolved),
        cmocka_unit_test(test_folder_of_a_path),
        cmocka_unit_test(test_files_get_names_when_complete),
        cmocka_unit_test(test_threads_receive_only_their_own_faults),
        cmocka_unit_test(test_threads_meet_in_a_monitor),
        cmocka_unit_test(test_facts_about_the_machine_are_plausible),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
