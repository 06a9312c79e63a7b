/* Stopped work: for a stop at any query in any stage, the result is TRI_STOPPED, nothing leaks, and a mesh that exists
   is valid and can be refined further. */
#include <stdatomic.h>
#include <stdio.h>
#include <unistd.h>

#include "sched/schedule/schedule.h"
#include "tests/array_grid.h"
#include "support.h"
#include "triangle/text/output.h"
#include "triangle/refine/place.h"
#include "triangle/text/read.h"
#include "triangle/dropin/triangle.h"
#include "triangle/text/write.h"

/* Returns true from query number `after` on. Any thread may call it. */
struct trigger {
    atomic_int asked;
    int after;
};

static bool is_asked(void *user)
{
    struct trigger *trigger = user;
    return atomic_fetch_add(&trigger->asked, 1) >= trigger->after;
}

static void assert_legal(const struct tri_mesh *mesh, const struct tri_pslg *pslg)
{
    struct tri_check_options check = {.max_bad = INT64_MAX, .ignore_lost = true};
    support_judge(mesh, pslg, &check, false, NULL);
}

/* The stage that was reported last, and the stage in which the first true was returned. */
struct stages {
    struct trigger trigger;
    enum tri_stage now, stopped_in;
    bool stopped;
};

static void enter(void *user, enum tri_stage stage) { ((struct stages *)user)->now = stage; }

static bool is_asked_in_stage(void *user)
{
    struct stages *s = user;
    bool yes = is_asked(&s->trigger);
    if (yes && !s->stopped)
        s->stopped_in = s->now;
    s->stopped = s->stopped || yes;
    return yes;
}

/* After a stop in one stage, the next stage is not reported. (After refinement a mesh exists, and that stage is
   reported.) */
static void test_no_stage_begins_after_a_stop(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 300, 60, 1);
    struct tri_options options = support_quality(25, 0);
    struct stages stages = {.now = TRI_STAGE_DELAUNAY};
    bool in_segments = false;
    for (int after = 0; stages.stopped_in != TRI_STAGE_QUALITY && after < 1000; after++) {
        stages = (struct stages){.trigger = {.after = after}};
        const struct tri_stop stop = {is_asked_in_stage, &stages};
        struct tri_mesh mesh;
        struct tri_report report;
        options.stop = &stop;
        options.stage = enter;
        options.stage_user = &stages;
        assert_int_equal(tri_generate(&mesh, &pslg, &options, &report, NULL), TRI_STOPPED);
        assert_true(stages.now == stages.stopped_in || stages.stopped_in == TRI_STAGE_QUALITY);
        in_segments = in_segments || stages.stopped_in == TRI_STAGE_SEGMENTS;
        tri_mesh_free(&mesh);
    }
    assert_true(in_segments && stages.stopped_in == TRI_STAGE_QUALITY);
    tri_pslg_free(&pslg);
}

static void test_generation_stops_anywhere(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_tangle(SUPPORT_RANDOM, 600, 30, 1);
    struct tri_options options = support_quality(25, 2e-3);
    options.keep_hull = true;
    bool refining_stopped = false;
    enum tri_status status = TRI_STOPPED;
    for (int after = 0; status != TRI_OK; after++) {
        struct trigger trigger = {.after = after};
        const struct tri_stop stop = {is_asked, &trigger};
        struct tri_mesh mesh;
        struct tri_report report;
        struct tri_error error = {0};
        options.stop = &stop;
        status = tri_generate(&mesh, &pslg, &options, &report, &error);
        if (status != TRI_OK) {
            assert_int_equal(status, TRI_STOPPED);
            assert_int_equal(error.status, TRI_STOPPED);
        }
        if (status == TRI_STOPPED && mesh.n_triangles > 0) {
            refining_stopped = true;
            assert_legal(&mesh, &pslg);
            mesh.stop = NULL;
            assert_int_equal(tri_refine(&mesh, &options.quality, &report.quality, &error), TRI_OK);
            assert_legal(&mesh, &pslg);
        }
        tri_mesh_free(&mesh);
        assert_true(after < 10000);
    }
    assert_true(refining_stopped);
    tri_pslg_free(&pslg);
}

static void test_the_schedule_stops_anywhere(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 40, 2);
    struct tri_options options = support_quality(28, 1e-3);
    struct par_options how = par_defaults();
    how.cell_triangles = 64;
    options.keep_hull = true;
    options.refine = false;
    int stopped = 0;
    for (int threads = 1; threads <= 3; threads += 2) {
        enum tri_status status = TRI_STOPPED;
        for (int after = 0; status != TRI_OK; after += 1 + after / 8) {
            struct trigger trigger = {.after = after};
            const struct tri_stop stop = {is_asked, &trigger};
            struct tri_mesh mesh = support_generate(&pslg, &options, NULL);
            struct par_report report;
            struct tri_error error = {0};
            how.threads = threads;
            mesh.stop = &stop;
            status = par_refine(&mesh, &options.quality, &how, &report, &error);
            assert_true(status == TRI_OK || (status == TRI_STOPPED && error.status == TRI_STOPPED));
            stopped += status == TRI_STOPPED;
            assert_legal(&mesh, &pslg);
            par_report_free(&report);
            mesh.stop = NULL;
            assert_int_equal(par_refine(&mesh, &options.quality, &how, &report, &error), TRI_OK);
            assert_legal(&mesh, &pslg);
            par_report_free(&report);
            tri_mesh_free(&mesh);
        }
    }
    assert_true(stopped > 10);
    tri_pslg_free(&pslg);
}

static void test_reconstruction_stops_anywhere(void **state)
{
    (void)state;
    struct tri_pslg pslg = support_square(1, 500, 3);
    struct tri_options options = tri_defaults();
    struct tri_mesh mesh = support_generate(&pslg, &options, NULL), again;
    struct support_copy copy = support_copy(&mesh);
    struct tri_elements elements = {.n = (int32_t)copy.mesh.n_triangles, .corners = copy.triangles, .n_nodes = 3};
    for (int after = 0; after < 2; after++) { /* before the first stage, and before the flips */
        struct trigger trigger = {.after = after};
        const struct tri_stop stop = {is_asked, &trigger};
        struct tri_reconstruct_options how = {.refine = true, .stop = &stop};
        assert_int_equal(tri_reconstruct(&again, &pslg, &elements, &how, NULL), TRI_STOPPED);
        assert_int_equal(again.n_triangles, 0);
    }
    support_copy_free(&copy);
    tri_mesh_free(&mesh);
    tri_pslg_free(&pslg);
}

/* Reading a file makes this many queries. Each may be the last. */
static void test_reading_and_writing_stop_anywhere(void **state)
{
    (void)state;
    char name[] = "stop.node";
    struct tri_pslg pslg = support_square(1, 2000, 4), read;
    enum tri_status status = TRI_STOPPED;
    int32_t base;
    int stopped = 0;
    for (int after = 0; status != TRI_OK; after++) {
        struct trigger trigger = {.after = after};
        const struct tri_stop stop = {is_asked, &trigger};
        struct array_grid arrays = array_grid_of_points(0, pslg.n_points, pslg.points);
        struct tri_output_set set;
        struct tri_output *output;
        tri_outputs_begin(&set);
        set.stop = &stop;
        assert_int_equal(tri_output_open(&set, name, &output, NULL), TRI_OK);
        status = tri_write_node(output, array_grid(&arrays), NULL, NULL);
        if (status == TRI_OK)
            assert_int_equal(tri_outputs_commit(&set, NULL), TRI_OK);
        else
            assert_int_equal(status, TRI_STOPPED);
        tri_outputs_abort(&set);
        assert_int_equal(access(name, F_OK) == 0, status == TRI_OK);
        stopped += status == TRI_STOPPED;
    }
    assert_true(stopped >= 2);
    status = TRI_STOPPED;
    for (int after = 0; status != TRI_OK; after++) {
        struct trigger trigger = {.after = after};
        const struct tri_stop stop = {is_asked, &trigger};
        const struct tri_read_options how = {.chunk_bytes = 20000, .stop = &stop};
        status = tri_read_node(name, &how, &read, &base, NULL);
        assert_true(status == TRI_STOPPED || status == TRI_OK);
        assert_int_equal(read.n_points, status == TRI_OK ? pslg.n_points : 0);
        stopped += status == TRI_STOPPED;
        tri_pslg_free(&read);
    }
    assert_true(stopped >= 8);
    unlink(name);
    tri_pslg_free(&pslg);
}

static int stop_when_triggered(void *user)
{
    struct trigger *trigger = user;
    return is_asked(trigger);
}

static void test_triangulate_stops(void **state)
{
    (void)state;
    double corners[] = {0, 0, 1, 0, 1, 1, 0, 1};
    int status = TRIANGULATE_STOPPED, stopped = 0;
    for (int after = 0; status != TRIANGULATE_OK; after++) {
        struct trigger trigger = {.after = after};
        struct triangulateio in = {0}, out = {0};
        struct triangulate_options options = {.stop = stop_when_triggered, .stop_user = &trigger, .threads = 1};
        in.pointlist = corners;
        in.numberofpoints = 4;
        status = triangulate_with("Qq33a0.0001", &in, &out, NULL, &options);
        assert_true(status == TRIANGULATE_OK || status == TRIANGULATE_STOPPED);
        assert_int_equal(out.pointlist != NULL, status == TRIANGULATE_OK);
        stopped += status == TRIANGULATE_STOPPED;
        trifree(out.pointlist);
        trifree(out.trianglelist);
        trifree(out.pointmarkerlist);
    }
    assert_true(stopped > 5);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_no_stage_begins_after_a_stop),      cmocka_unit_test(test_generation_stops_anywhere),
        cmocka_unit_test(test_the_schedule_stops_anywhere),       cmocka_unit_test(test_reconstruction_stops_anywhere),
        cmocka_unit_test(test_reading_and_writing_stop_anywhere), cmocka_unit_test(test_triangulate_stops),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
