/* Writing: layouts are compared with printf and with expected bytes, tables are written in any order, and a failure
   leaves no file. */
#include "triangle/text/write.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <setjmp.h>
#include <signal.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cmocka.h>

#include "tests/array_grid.h"
#include "triangle/text/read.h"

#define LENGTH(array) (sizeof(array) / sizeof *(array))

static char directory[64];

static int set_up(void **state)
{
    (void)state;
    strcpy(directory, "/tmp/test_write_XXXXXX");
    return mkdtemp(directory) ? 0 : -1;
}

/* Empties the directory. Returns the number of its entries. */
static int empty_directory(void)
{
    DIR *const entries = opendir(directory);
    assert_non_null(entries);
    int n = 0;
    for (struct dirent *entry = readdir(entries); entry; entry = readdir(entries)) {
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        char path[400];
        snprintf(path, sizeof path, "%s/%s", directory, entry->d_name);
        assert_int_equal(remove(path), 0);
        n++;
    }
    closedir(entries);
    return n;
}

static int remove_directory(void **state)
{
    (void)state;
    empty_directory();
    return rmdir(directory);
}

static const char *in_directory(const char *name)
{
    static char paths[4][128];
    static int next;
    char *const path = paths[next++ % 4];
    snprintf(path, sizeof paths[0], "%s/%s", directory, name);
    return path;
}

/* The whole file, allocated with malloc, with a final 0. */
static char *contents(const char *path)
{
    FILE *const file = fopen(path, "rb");
    assert_non_null(file);
    fseek(file, 0, SEEK_END);
    const long size = ftell(file);
    rewind(file);
    char *const text = malloc((size_t)size + 1);
    assert_non_null(text);
    assert_int_equal(fread(text, 1, (size_t)size, file), size);
    text[size] = 0;
    fclose(file);
    return text;
}

static void assert_contents(const char *path, const char *expected)
{
    char *const text = contents(path);
    assert_string_equal(text, expected);
    free(text);
}

static void make_file(const char *path, const char *text)
{
    FILE *const file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void run_backwards(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    *(size_t *)self += n_tasks;
    while (n_tasks > 0)
        task(context, --n_tasks);
}

/* A set with one file. */
static struct tri_output *open_one(struct tri_output_set *set, const char *path)
{
    struct tri_output *output;
    tri_outputs_begin(set);
    assert_int_equal(tri_output_open(set, path, &output, NULL), TRI_OK);
    return output;
}

static void put_text(struct tri_output *output, const char *text)
{
    assert_int_equal(tri_output_write(output, text, strlen(text), NULL), TRI_OK);
}

/* --- layouts */

static const double square[] = {0, 0, 10, 0, 0.1, 1e-7, -1.5, 123456.75};
static const int32_t two_triangles[] = {0, 1, 2, 0, 2, 3}, markers[] = {1, 0, -3, 12345};

static void put_grid(struct tri_output *output, tri_write_call *write, struct array_grid arrays)
{
    assert_int_equal(write(output, array_grid(&arrays), NULL, NULL), TRI_OK);
}

static void layout_node(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.node"));
    const double attributes[] = {1, 2, 3, .5, 5, 6, 7, 8};
    put_grid(output, tri_write_node,
             (struct array_grid){.points = square, .attributes = attributes, .markers = markers,
                                 .grid = {.base = 1, .n_points = 4, .n_attributes = 2, .has_markers = true}});
    put_grid(output, tri_write_node, array_grid_of_points(0, 2, square));
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a.node"), "4  2  2  1\n"
                                            "   1    0  0  1  2    1\n"
                                            "   2    10  0  3  0.5    0\n"
                                            "   3    0.10000000000000001  9.9999999999999995e-08  5  6    -3\n"
                                            "   4    -1.5  123456.75  7  8    12345\n"
                                            "2  2  0  0\n"
                                            "   0    0  0\n"
                                            "   1    10  0\n");
}

static void layout_ele(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.ele"));
    const int32_t six[] = {0, 1, 2, 3, 4, 12345};
    const double attribute = 3;
    put_grid(output, tri_write_ele,
             (struct array_grid){.nodes = two_triangles, .grid = {.base = 1, .n_triangles = 2, .n_nodes = 3}});
    put_grid(output, tri_write_ele, (struct array_grid){.nodes = six, .columns = &attribute,
                                                        .grid = {.n_triangles = 1, .n_nodes = 6, .n_columns = 1}});
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a.ele"), "2  3  0\n"
                                           "   1       1     2     3\n"
                                           "   2       1     3     4\n"
                                           "1  6  1\n"
                                           "   0       0     1     2     3     4  12345  3\n");
}

static void layout_poly(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.poly"));
    int32_t segments[] = {0, 1, 1, 2}, segment_markers[] = {5, -1};
    double holes[] = {.5, .25}, regions[] = {1, 2, 3, -1};
    struct tri_pslg figure = {.n_holes = 1, .holes = holes};
    struct array_grid arrays = {
        .segments = segments, .segment_markers = segment_markers,
        .grid = {.base = 1, .n_attributes = 1, .n_segments = 2, .has_markers = true, .figure = &figure}};
    put_grid(output, tri_write_poly, arrays);
    figure = (struct tri_pslg){.n_regions = 1, .regions = regions};
    arrays.grid.base = 0;
    arrays.grid.has_markers = false;
    put_grid(output, tri_write_poly, arrays);
    arrays.grid.has_markers = true;
    arrays.segment_markers = NULL;
    arrays.grid.figure = NULL;
    put_grid(output, tri_write_poly, arrays);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a.poly"), "0  2  1  1\n2  1\n"
                                            "   1       1     2       5\n"
                                            "   2       2     3      -1\n"
                                            "1\n   1   0.5  0.25\n"
                                            "0  2  1  0\n2  0\n"
                                            "   0       0     1\n"
                                            "   1       1     2\n"
                                            "0\n1\n   0   1  2  3  -1\n"
                                            "0  2  1  1\n2  1\n"
                                            "   0       0     1       0\n"
                                            "   1       1     2       0\n"
                                            "0\n");
}

static void layout_edge_and_neighbors(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.edge"));
    const int32_t ends[] = {0, 1, 1, 12344}, neighbors[] = {-1, 1, -1, 0, -1, -1};
    struct array_grid arrays = {.ends = ends, .markers = markers, .neighbors = neighbors,
                                .grid = {.base = 1, .n_edges = 2, .n_triangles = 2, .has_markers = true}};
    put_grid(output, tri_write_edge, arrays);
    put_grid(output, tri_write_neigh, arrays);
    arrays.grid.base = 0;
    arrays.grid.n_edges = 1;
    arrays.grid.has_markers = false;
    put_grid(output, tri_write_edge, arrays);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a.edge"), "2  1\n   1   1  2  1\n   2   2  12345  0\n"
                                            "2  3\n   1    -1  2  -1\n   2    1  -1  -1\n"
                                            "1  0\n   0   0  1\n");
}

static void layout_voronoi_and_off(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.v.edge"));
    const int32_t ends[] = {0, 1, 1, -1};
    const double directions[] = {0, 0, -2.5, 1};
    put_grid(output, tri_write_v_edge,
             (struct array_grid){.ends = ends, .directions = directions, .grid = {.base = 1, .n_edges = 2}});
    put_grid(output, tri_write_off,
             (struct array_grid){.points = square, .nodes = two_triangles,
                                 .grid = {.base = 1, .n_points = 2, .n_triangles = 2, .n_nodes = 3, .n_edges = 5}});
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a.v.edge"), "2  0\n   1   1  2\n   2   2  -1   -2.5  1\n"
                                              "OFF\n2 2 5\n 0  0  0\n 10  0  0\n"
                                              " 3      0     1     2\n 3      0     2     3\n");
}

static void comment_names_the_command(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a"));
    char program[] = "./triangle", word[] = "-pq", name[] = "two\nlines";
    char *const argv[] = {program, word, name, NULL};
    assert_int_equal(tri_write_comment(output, 3, argv, NULL), TRI_OK);
    assert_int_equal(tri_write_comment(output, 0, argv, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a"), "# Generated by ./triangle -pq two lines\n# Generated by\n");
}

/* Numbers of every width, and the longest ones, compared with printf using the templates of the formats. */
static void rows_equal_those_of_printf(void **state)
{
    (void)state;
    const int32_t values[] = {0, 7, 42, 999, 1000, 9999, 10000, 123456789, INT32_MAX};
    for (size_t i = 0; i < LENGTH(values); i++) {
        struct tri_output_set set;
        struct tri_output *const output = open_one(&set, in_directory("a"));
        const int32_t v = values[i], nodes[] = {v, v / 3, INT32_MAX}, marker = v == INT32_MAX ? INT32_MIN : -v;
        const double xy[] = {v / 7.0, v * -1.2345678901234567e-308};
        const long long a = v + 1LL, b = v / 3 + 1; /* also if a long has 32 bits */
        char expected[1024];
        const struct array_grid arrays = {
            .points = xy, .attributes = xy, .markers = &marker, .nodes = nodes, .columns = xy, .neighbors = nodes,
            .segments = nodes, .segment_markers = &marker, .ends = nodes, .directions = xy,
            .grid = {.base = 1, .n_points = 1, .n_attributes = 2, .n_triangles = 1, .n_nodes = 3, .n_columns = 2,
                     .n_segments = 1, .n_edges = 1, .has_markers = true}};
        tri_write_call *const calls[] = {tri_write_node, tri_write_ele, tri_write_edge, tri_write_neigh,
                                         tri_write_poly};
        for (size_t k = 0; k < LENGTH(calls); k++)
            put_grid(output, calls[k], arrays);
        assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
        snprintf(expected, sizeof expected,
                 "1  2  2  1\n%4d    %.17g  %.17g  %.17g  %.17g    %d\n"
                 "1  3  2\n%4d    %4lld  %4lld  2147483648  %.17g  %.17g\n"
                 "1  1\n%4d   %lld  %lld  %d\n"
                 "1  3\n%4d    %lld  %lld  2147483648\n"
                 "0  2  2  1\n1  1\n%4d    %4lld  %4lld    %4d\n0\n",
                 1, xy[0], xy[1], xy[0], xy[1], marker, 1, a, b, xy[0], xy[1], 1, a, b, marker, 1, a, b, 1, a, b,
                 marker);
        assert_contents(in_directory("a"), expected);
    }
}

/* --- tables */

static char *row_of_words(const void *user, int64_t i, char *at)
{
    const size_t max_bytes = *(const size_t *)user;
    const size_t n = (size_t)i % max_bytes;
    memset(at, 'a' + (int)(i % 26), n);
    at[n] = '\n';
    return at + n + 1;
}

static void tables_are_written_in_any_order(void **state)
{
    (void)state;
    const struct {
        int64_t n_rows;
        size_t max_bytes;
    } cases[] = {{0, 8},          {1, 8},            {32767, 8},         {32768, 8},     {32769, 8},
                 {32768 * 15, 8}, {32768 * 15 + 1, 8}, {32768 * 64, 8}, {32768 * 64 + 1, 8},
                 {100000, 300},   {3, 400000},       {70, 300000}};
    for (size_t i = 0; i < LENGTH(cases); i++) {
        size_t max_bytes = cases[i].max_bytes, n_tasks = 0;
        const struct tri_executor backwards = {run_backwards, &n_tasks};
        struct tri_output_set set;
        struct tri_output *a, *b;
        tri_outputs_begin(&set);
        assert_int_equal(tri_output_open(&set, in_directory("a"), &a, NULL), TRI_OK);
        assert_int_equal(tri_output_open(&set, in_directory("b"), &b, NULL), TRI_OK);
        assert_int_equal(tri_write_table(a, 0, cases[i].n_rows, max_bytes, row_of_words, &max_bytes, NULL, NULL),
                         TRI_OK);
        assert_int_equal(tri_write_table(b, 0, cases[i].n_rows, max_bytes, row_of_words, &max_bytes, &backwards,
                                         NULL),
                         TRI_OK);
        assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
        size_t rows = max_bytes < 262144 ? 262144 / max_bytes : 1, chunks = ((size_t)cases[i].n_rows + rows - 1) / rows;
        assert_int_equal(n_tasks >= chunks, chunks >= 16 || chunks == 0); /* for few chunks, no threads are woken */
        assert_true(chunks >= 16 || n_tasks == 0);
        char *const text = contents(in_directory("a")), *const other = contents(in_directory("b"));
        assert_string_equal(text, other);
        const char *at = text;
        for (int64_t row = 0; row < cases[i].n_rows; row++, at++) {
            assert_true(*at == '\n' || *at == 'a' + (int)(row % 26));
            at += strcspn(at, "\n");
        }
        assert_int_equal(*at, 0);
        free(text);
        free(other);
    }
}

/* Written numbers are read back exactly. */
static void written_numbers_are_read_exactly(void **state)
{
    (void)state;
    enum { N = 5000 };
    double points[2 * N], attributes[N];
    int32_t point_markers[N];
    for (int i = 0; i < N; i++) {
        points[2 * i] = 1.0 / (i + 1) - .5;
        points[2 * i + 1] = i * 1e300 / 7;
        attributes[i] = -i / 3e200;
        point_markers[i] = i * 429496 - 1000000;
    }
    struct tri_output_set set;
    struct tri_output *const output = open_one(&set, in_directory("a.node"));
    put_grid(output, tri_write_node,
             (struct array_grid){.points = points, .attributes = attributes, .markers = point_markers,
                                 .grid = {.n_points = N, .n_attributes = 1, .has_markers = true}});
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    struct tri_pslg pslg;
    int32_t base;
    const struct tri_read_options options = {.default_base = 1};
    assert_int_equal(tri_read_node(in_directory("a.node"), &options, &pslg, &base, NULL), TRI_OK);
    assert_int_equal(base, 0);
    assert_memory_equal(pslg.points, points, sizeof points);
    assert_memory_equal(pslg.attributes, attributes, sizeof attributes);
    assert_memory_equal(pslg.markers, point_markers, sizeof point_markers);
    tri_pslg_free(&pslg);
}

/* --- outputs */

static void names_appear_at_commit(void **state)
{
    (void)state;
    empty_directory();
    make_file(in_directory("a"), "old");
    assert_int_equal(chmod(in_directory("a"), 0640), 0);
    struct tri_output_set set;
    struct tri_output *a, *b;
    tri_outputs_begin(&set);
    assert_int_equal(tri_output_open(&set, in_directory("a"), &a, NULL), TRI_OK);
    assert_int_equal(tri_output_open(&set, in_directory("b"), &b, NULL), TRI_OK);
    put_text(a, "new a");
    put_text(b, "new b");
    assert_contents(in_directory("a"), "old");
    assert_int_equal(access(in_directory("b"), F_OK), -1);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_contents(in_directory("a"), "new a");
    assert_contents(in_directory("b"), "new b");
    struct stat status;
    assert_int_equal(stat(in_directory("a"), &status), 0);
    assert_int_equal(status.st_mode & 0777, 0640);
    assert_int_equal(stat(in_directory("b"), &status), 0);
    const mode_t mask = umask(0);
    umask(mask);
    assert_int_equal(status.st_mode & 0777, 0666 & ~mask);
    assert_int_equal(empty_directory(), 2);
}

static void abort_leaves_nothing(void **state)
{
    (void)state;
    empty_directory();
    make_file(in_directory("a"), "old");
    struct tri_output_set set;
    struct tri_output *output = open_one(&set, in_directory("a"));
    put_text(output, "new");
    assert_int_equal(tri_output_open(&set, in_directory("b"), &output, NULL), TRI_OK);
    tri_outputs_abort(&set);
    tri_outputs_abort(&set);
    assert_contents(in_directory("a"), "old");
    assert_int_equal(empty_directory(), 1);
}

/* Two sets, as of two processes, write the same name. The last commit wins, and its file is complete. */
static void two_writers_of_one_name(void **state)
{
    (void)state;
    empty_directory();
    struct tri_output_set first, second;
    put_text(open_one(&first, in_directory("a")), "first");
    put_text(open_one(&second, in_directory("a")), "second");
    assert_int_equal(tri_outputs_commit(&second, NULL), TRI_OK);
    assert_contents(in_directory("a"), "second");
    assert_int_equal(tri_outputs_commit(&first, NULL), TRI_OK);
    assert_contents(in_directory("a"), "first");
    assert_int_equal(empty_directory(), 1);
}

static void links_stay_links(void **state)
{
    (void)state;
    empty_directory();
    assert_int_equal(symlink("target", in_directory("link")), 0); /* the link is dangling at first */
    assert_int_equal(symlink(in_directory("link"), in_directory("chain")), 0);
    for (int i = 0; i < 2; i++) {
        struct tri_output_set set;
        put_text(open_one(&set, in_directory("chain")), i ? "second" : "first");
        assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
        assert_contents(in_directory("target"), i ? "second" : "first");
        struct stat status;
        assert_int_equal(lstat(in_directory("link"), &status), 0);
        assert_true(S_ISLNK(status.st_mode));
    }
    assert_int_equal(empty_directory(), 3);
}

/* Only the system's administrator can change the owner of links. */
static void links_of_others_are_refused(void **state)
{
    (void)state;
    if (geteuid() != 0)
        skip();
    empty_directory();
    make_file(in_directory("precious"), "x");
    assert_int_equal(symlink("precious", in_directory("link")), 0);
    assert_int_equal(symlink("link", in_directory("own")), 0);
    assert_int_equal(lchown(in_directory("link"), 1234, 1234), 0);
    for (int i = 0; i < 2; i++) {
        struct tri_output_set set;
        struct tri_output *output;
        struct tri_error error;
        tri_outputs_begin(&set);
        assert_int_equal(tri_output_open(&set, in_directory(i ? "own" : "link"), &output, &error), TRI_CANNOT_WRITE);
        assert_non_null(strstr(error.text, "another user"));
        assert_int_equal(set.n, 0);
    }
    assert_contents(in_directory("precious"), "x");
    assert_int_equal(empty_directory(), 3);
}

static void unusable_outputs_are_refused_before_any_work(void **state)
{
    (void)state;
    empty_directory();
    make_file(in_directory("file"), "x");
    assert_int_equal(mkdir(in_directory("sub"), 0700), 0);
    assert_int_equal(symlink("loop", in_directory("loop")), 0);
    char long_name[400];
    memset(long_name, 'x', sizeof long_name - 1);
    long_name[sizeof long_name - 1] = 0;
    const char *const names[] = {"", "sub", "sub/", "none/a", "file/a", "loop", long_name};
    for (size_t i = 0; i < LENGTH(names); i++) {
        char path[512];
        snprintf(path, sizeof path, "%s/%s", directory, names[i]);
        struct tri_output_set set;
        struct tri_output *output;
        struct tri_error error = {.status = TRI_OK};
        tri_outputs_begin(&set);
        const enum tri_status status = tri_output_open(&set, path, &output, &error);
        if (status == TRI_OK) /* the system checks the length of a name, last of all */
            assert_int_equal(tri_outputs_commit(&set, &error), TRI_CANNOT_WRITE);
        else
            assert_int_equal(status, TRI_CANNOT_WRITE);
        assert_int_equal(error.status, TRI_CANNOT_WRITE);
        assert_non_null(strstr(error.text, "cannot create: "));
        assert_string_equal(error.file, path);
        assert_int_equal(set.n, 0);
    }
    assert_int_equal(empty_directory(), 3);
}

static void devices_are_written_in_place(void **state)
{
    (void)state;
    struct tri_output_set set;
    struct tri_error error;
    put_text(open_one(&set, "/dev/null"), "nothing");
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    struct stat status;
    assert_int_equal(stat("/dev/null", &status), 0);
    assert_true(S_ISCHR(status.st_mode));
    if (access("/dev/full", W_OK) != 0)
        return;
    struct tri_output *const output = open_one(&set, "/dev/full");
    struct array_grid arrays = array_grid_of_points(0, 4, square);
    assert_int_equal(tri_write_node(output, array_grid(&arrays), NULL, &error), TRI_CANNOT_WRITE);
    assert_string_equal(error.file, "/dev/full");
    assert_int_equal(tri_outputs_commit(&set, &error), TRI_CANNOT_WRITE);
    assert_int_equal(access("/dev/full", W_OK), 0);
}

/* A limit on the size of files simulates a full disk. Neither name appears, and the old file is kept. */
static void full_disk_leaves_old_files(void **state)
{
    (void)state;
    empty_directory();
    make_file(in_directory("a"), "old");
    struct rlimit before, limit;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    limit = before;
    limit.rlim_cur = 1 << 20;
    struct sigaction ignore = {.sa_handler = SIG_IGN}, old_action;
    sigaction(SIGXFSZ, &ignore, &old_action);
    struct tri_output_set set;
    struct tri_output *a, *b;
    struct tri_error error;
    size_t max_bytes = 300, n_tasks = 0;
    const struct tri_executor backwards = {run_backwards, &n_tasks};
    tri_outputs_begin(&set);
    assert_int_equal(tri_output_open(&set, in_directory("b"), &b, NULL), TRI_OK);
    assert_int_equal(tri_output_open(&set, in_directory("a"), &a, NULL), TRI_OK);
    put_text(b, "complete");
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &limit), 0);
    assert_int_equal(tri_write_table(a, 0, 1000000, max_bytes, row_of_words, &max_bytes, &backwards, &error),
                     TRI_CANNOT_WRITE);
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &before), 0);
    sigaction(SIGXFSZ, &old_action, NULL);
    assert_string_equal(error.file, in_directory("a"));
    assert_true(n_tasks < 1000); /* formatting stopped soon after the failure */
    assert_int_equal(tri_outputs_commit(&set, &error), TRI_CANNOT_WRITE);
    assert_contents(in_directory("a"), "old");
    assert_int_equal(empty_directory(), 1);
}

static void open_most(struct tri_output_set *set)
{
    struct tri_output *output;
    tri_outputs_begin(set);
    for (int i = 0; i < TRI_MAX_OUTPUTS; i++) {
        char name[16];
        snprintf(name, sizeof name, "%d", i);
        assert_int_equal(tri_output_open(set, in_directory(name), &output, NULL), TRI_OK);
    }
    assert_int_equal(set->next_name, TRI_MAX_OUTPUTS); /* no name was tried twice */
}

static void too_many_outputs(void **state)
{
    (void)state;
    empty_directory();
    static struct tri_output_set set;
    struct tri_output *output;
    open_most(&set);
    assert_int_equal(tri_output_open(&set, in_directory("a"), &output, NULL), TRI_CANNOT_WRITE);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    open_most(&set);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK); /* which replaces the old ones */
    assert_int_equal(set.next_name, 2 * TRI_MAX_OUTPUTS);
    assert_int_equal(empty_directory(), TRI_MAX_OUTPUTS);
}

/* Events on files, in order: 's' a file is synced, 'd' a folder is synced, 'r' a file gets its name. These functions
   replace those of the C library. */
static char events[64];

static void note_event(char event)
{
    const size_t n = strlen(events);
    if (n + 1 < sizeof events)
        events[n] = event;
}

int fsync(int file)
{
    struct stat status;
    note_event(fstat(file, &status) == 0 && S_ISDIR(status.st_mode) ? 'd' : 's');
    return 0;
}

int rename(const char *from, const char *to)
{
    note_event('r');
    return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

/* Two files; the first has the given number of bytes. */
static const char *events_of(uint64_t bytes, bool sync)
{
    struct tri_output_set set;
    struct tri_output *output = open_one(&set, in_directory("a"));
    put_text(output, "a");
    assert_int_equal(ftruncate(output->file, (off_t)bytes), 0);
    assert_int_equal(tri_output_open(&set, in_directory("b"), &output, NULL), TRI_OK);
    put_text(output, "b");
    memset(events, 0, sizeof events);
    if (sync)
        assert_int_equal(tri_outputs_sync(&set, NULL), TRI_OK);
    assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
    assert_int_equal(empty_directory(), 2);
    return events;
}

/* If requested, a file gets its name only after it is on the disk, unless the files are small. */
static void files_are_synced_before_they_get_their_names(void **state)
{
    (void)state;
    assert_string_equal(events_of(TRI_SYNC_BYTES, true), "ssrrd");
    assert_string_equal(events_of(TRI_SYNC_BYTES, false), "rr");
    assert_string_equal(events_of(1000, true), "rr");
}

static bool always(void *user)
{
    (void)user;
    return true;
}

/* After a request to end, the call does not wait for the disk. */
static void syncing_is_stopped(void **state)
{
    (void)state;
    const struct tri_stop stop = {always, NULL};
    struct tri_output_set set;
    struct tri_output *output = open_one(&set, in_directory("a"));
    assert_int_equal(ftruncate(output->file, TRI_SYNC_BYTES), 0);
    output->stop = &stop;
    memset(events, 0, sizeof events);
    assert_int_equal(tri_outputs_sync(&set, NULL), TRI_STOPPED);
    assert_string_equal(events, "");
    tri_outputs_abort(&set);
    assert_int_equal(empty_directory(), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(layout_node),
        cmocka_unit_test(layout_ele),
        cmocka_unit_test(layout_poly),
        cmocka_unit_test(layout_edge_and_neighbors),
        cmocka_unit_test(layout_voronoi_and_off),
        cmocka_unit_test(comment_names_the_command),
        cmocka_unit_test(rows_equal_those_of_printf),
        cmocka_unit_test(tables_are_written_in_any_order),
        cmocka_unit_test(written_numbers_are_read_exactly),
        cmocka_unit_test(names_appear_at_commit),
        cmocka_unit_test(abort_leaves_nothing),
        cmocka_unit_test(two_writers_of_one_name),
        cmocka_unit_test(links_stay_links),
        cmocka_unit_test(links_of_others_are_refused),
        cmocka_unit_test(unusable_outputs_are_refused_before_any_work),
        cmocka_unit_test(devices_are_written_in_place),
        cmocka_unit_test(full_disk_leaves_old_files),
        cmocka_unit_test(too_many_outputs),
        cmocka_unit_test(files_are_synced_before_they_get_their_names),
        cmocka_unit_test(syncing_is_stopped),
    };
    return cmocka_run_group_tests(tests, set_up, remove_directory);
}
