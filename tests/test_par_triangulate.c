/* triangulate() of libptriangle.a uses the parallel schedule, gives the same mesh for any number of threads, and calls
   size tests on one thread unless they are known to be thread-safe. */
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "sched/schedule/schedule.h"
#define REAL TRI_REAL
#include "triangle/dropin/triangle.h"

static REAL xy[] = {0, 0, 1, 0, 1, 1, 0, 1};
static int ends[] = {0, 1, 1, 2, 2, 3, 3, 0};

static struct triangulateio mesh_square(const char *switches, const struct triangulate_options *options)
{
    struct triangulateio in = {.pointlist = xy, .numberofpoints = 4, .segmentlist = ends, .numberofsegments = 4};
    struct triangulateio out = {0};
    assert_int_equal(triangulate_with(switches, &in, &out, NULL, options), TRIANGULATE_OK);
    return out;
}

static void release(struct triangulateio *out)
{
    trifree(out->pointlist);
    trifree(out->pointmarkerlist);
    trifree(out->trianglelist);
    trifree(out->segmentlist);
    trifree(out->segmentmarkerlist);
}

static void assert_same(const struct triangulateio *a, const struct triangulateio *b)
{
    assert_int_equal(a->numberofpoints, b->numberofpoints);
    assert_int_equal(a->numberoftriangles, b->numberoftriangles);
    assert_memory_equal(a->pointlist, b->pointlist, 2 * (size_t)a->numberofpoints * sizeof(REAL));
    assert_memory_equal(a->trianglelist, b->trianglelist, 3 * (size_t)a->numberoftriangles * sizeof(int));
}

static void test_any_number_of_threads_gives_the_same_mesh(void **state)
{
    (void)state;
    struct triangulateio first = mesh_square("pqa0.00001zQ", NULL);
    for (int threads = 1; threads <= 8; threads += threads == 1 ? 2 : 5) {
        struct triangulate_options options = {.threads = threads};
        struct triangulateio out = mesh_square("pqa0.00001zQ", &options);
        assert_same(&first, &out);
        release(&out);
    }
    release(&first);
}

/* The schedule makes a different mesh than one sequential call, so the mesh shows which library was linked. */
static void test_the_parallel_schedule_is_used(void **state)
{
    (void)state;
    struct tri_pslg pslg = {.n_points = 4, .points = xy, .n_segments = 4, .segments = ends};
    struct tri_options how = tri_defaults();
    how.use_segments = true;
    struct triangulateio out = mesh_square("pqa0.00001zQ", NULL);
    struct tri_mesh mesh;
    struct tri_report report;
    assert_int_equal(tri_generate(&mesh, &pslg, &how, &report, NULL), TRI_OK);
    how.quality.min_angle = 20;
    how.quality.max_area = 0.00001;
    how.quality.lattice = true;
    struct par_options options = par_defaults();
    struct par_report schedule;
    assert_int_equal(par_refine(&mesh, &how.quality, &options, &schedule, NULL), TRI_OK);
    assert_true(schedule.levels > 0);
    tri_mesh_compact(&mesh);
    assert_int_equal(out.numberofpoints, mesh.n_vertices);
    assert_memory_equal(out.pointlist, mesh.xy, sizeof *mesh.xy * (size_t)mesh.n_vertices);
    par_report_free(&schedule);
    tri_mesh_free(&mesh);
    release(&out);
}

struct crowd {
    atomic_int inside, calls;
    atomic_bool met; /* two calls ran at the same time */
};

static int ask_slowly(void *user, const REAL *a, const REAL *b, const REAL *c, REAL area)
{
    struct crowd *crowd = user;
    (void)a, (void)b, (void)c;
    if (atomic_fetch_add(&crowd->inside, 1) > 0)
        crowd->met = true;
    atomic_fetch_add(&crowd->calls, 1);
    atomic_fetch_sub(&crowd->inside, 1);
    return area > 0.00001;
}

static void test_size_tests_are_called_one_at_a_time(void **state)
{
    (void)state;
    struct crowd crowd = {0};
    struct triangulate_options options = {.unsuitable = ask_slowly, .unsuitable_user = &crowd, .threads = 8};
    struct triangulateio serial = mesh_square("pqua0.00002zQ", &options);
    assert_true(crowd.calls > serial.numberoftriangles);
    assert_false(crowd.met);
    options.unsuitable_in_parallel = 1;
    struct triangulateio parallel = mesh_square("pqua0.00002zQ", &options);
    assert_int_not_equal(serial.numberofpoints, parallel.numberofpoints); /* different, so the schedule was used */
    options.threads = 1;
    struct triangulateio again = mesh_square("pqua0.00002zQ", &options);
    assert_same(&parallel, &again);
    release(&serial);
    release(&parallel);
    release(&again);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_any_number_of_threads_gives_the_same_mesh),
        cmocka_unit_test(test_the_parallel_schedule_is_used),
        cmocka_unit_test(test_size_tests_are_called_one_at_a_time),
    };
    return cmocka_run_group_tests_name("par_triangulate", tests, NULL, NULL);
}
