/* Readers, writers and the checker when each of their allocations fails: they return TRI_NO_MEMORY with a message and
   an empty output, leave no file, and leak nothing. For the mesher see test_generate.c, test_reconstruct.c,
   test_schedule.c, test_triangulate.c.
   This program is linked with --wrap for malloc, calloc, realloc and free: see allocations.h. */
#include "allocations.h"

#include <stdio.h>
#include <unistd.h>

#include "tests/array_grid.h"
#include "support.h"
#include "triangle/text/output.h"
#include "triangle/text/read.h"
#include "triangle/text/write.h"

/* One attempt, which frees what it allocates. Returns true if it succeeded. */
typedef enum tri_status attempt(struct tri_error *error);

/* Lets the k-th allocation fail, alone or with all later ones, for increasing k, until an attempt needs fewer
   allocations. */
static void fail_each(attempt *try, int64_t least)
{
    for (int ever_after = 0; ever_after < 2; ever_after++) {
        int64_t k = 1;
        for (bool reached = true; reached; k++) {
            struct tri_error error = {0};
            long long before = support_held;
            support_calls = 0;
            support_fail_ever_after = ever_after;
            support_fail_at = k;
            enum tri_status status = try(&error);
            reached = support_calls >= k;
            support_fail_at = INT64_MAX;
            assert_int_equal(support_held, before);
            assert_int_equal(status, reached ? TRI_NO_MEMORY : TRI_OK);
            assert_int_equal(error.status, status);
            assert_int_equal(error.text[0] != 0, reached);
        }
        assert_true(k > least);
    }
}

static struct tri_pslg square;

static const struct tri_read_options from_zero;

static enum tri_status read_poly(struct tri_error *error)
{
    struct tri_pslg pslg;
    int32_t base;
    bool in_poly;
    enum tri_status status = tri_read_poly("memory.poly", "memory.node", &from_zero, &pslg, &base, &in_poly, error);
    assert_int_equal(pslg.n_points, status ? 0 : 24);
    tri_pslg_free(&pslg);
    return status;
}

static enum tri_status read_elements(struct tri_error *error)
{
    struct tri_elements elements;
    enum tri_status status = tri_read_ele("memory.ele", &from_zero, 0, 24, &elements, error);
    status = status ? status : tri_read_area("memory.area", &from_zero, 0, &elements, error);
    tri_elements_free(&elements);
    return status;
}

static enum tri_status write_files(struct tri_error *error)
{
    static const int32_t triangles[] = {0, 1, 2, 0, 2, 3};
    struct array_grid arrays = {.points = square.points, .nodes = triangles, .segments = square.segments,
                                .grid = {.n_points = 24, .n_triangles = 2, .n_nodes = 3, .has_markers = true,
                                         .n_segments = square.n_segments, .figure = &square}};
    const struct tri_grid *grid = array_grid(&arrays);
    struct tri_output_set set;
    struct tri_output *node, *poly, *ele = NULL;
    tri_outputs_begin(&set);
    enum tri_status status = tri_output_open(&set, "memory.node", &node, error);
    status = status ? status : tri_output_open(&set, "memory.poly", &poly, error);
    status = status ? status : tri_output_open(&set, "memory.ele", &ele, error);
    status = status ? status : tri_write_node(node, grid, NULL, error);
    status = status ? status : tri_write_poly(poly, grid, NULL, error);
    status = status ? status : tri_write_ele(ele, grid, NULL, error);
    if (!status)
        return tri_outputs_commit(&set, error);
    tri_outputs_abort(&set);
    assert_int_equal(access("memory.node", F_OK), -1);
    assert_int_equal(access("memory.ele", F_OK), -1);
    return status;
}

static void remove_files(void)
{
    unlink("memory.node");
    unlink("memory.poly");
    unlink("memory.ele");
    unlink("memory.area");
}

static void test_writers_report_lack_of_memory(void **state)
{
    (void)state;
    remove_files();
    for (int64_t k = 1, reached = 1; reached; k++) { /* some allocations happen only once, so the attempts differ */
        struct tri_error error = {0};
        long long before = support_held;
        support_calls = 0;
        support_fail_ever_after = k % 2;
        support_fail_at = k;
        enum tri_status status = write_files(&error);
        reached = support_calls >= k;
        support_fail_at = INT64_MAX;
        assert_int_equal(support_held, before);
        assert_true(status == TRI_OK || (reached && status == TRI_NO_MEMORY && error.text[0]));
        assert_int_equal(access("memory.node", F_OK) == 0, status == TRI_OK);
        remove_files();
        assert_true(k < 1000 && (reached || k > 10));
    }
}

static void test_readers_report_lack_of_memory(void **state)
{
    (void)state;
    struct tri_error error;
    remove_files();
    assert_int_equal(write_files(&error), TRI_OK);
    FILE *file = fopen("memory.area", "w");
    assert_non_null(file);
    fputs("2\n0 0.5\n1 0.25\n", file);
    fclose(file);
    fail_each(read_poly, 5);
    fail_each(read_elements, 5);
    remove_files();
}

static struct support_copy copy;

static enum tri_status check(struct tri_error *error)
{
    const struct tri_check_options options = {.max_bad = INT64_MAX, .min_angle = 20, .convex = true};
    struct tri_check_report report;
    return tri_check(&copy.mesh, &square, &options, &report, error);
}

static void test_the_checker_reports_lack_of_memory(void **state)
{
    (void)state;
    struct tri_options options = tri_defaults();
    options.use_segments = true;
    struct tri_mesh mesh = support_generate(&square, &options, NULL);
    copy = support_copy(&mesh);
    fail_each(check, 8);
    support_copy_free(&copy);
    tri_mesh_free(&mesh);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_writers_report_lack_of_memory),
        cmocka_unit_test(test_readers_report_lack_of_memory),
        cmocka_unit_test(test_the_checker_reports_lack_of_memory),
    };
    square = support_square(1, 20, 5);
    int failed = cmocka_run_group_tests(tests, NULL, NULL);
    tri_pslg_free(&square);
    return failed;
}
