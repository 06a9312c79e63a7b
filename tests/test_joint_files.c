/* Files written jointly by ranks, which are threads here. They have the same bytes as those of one process. If one rank
 * does not see the files, no rank writes them directly. A failed write on one rank fails on all ranks. */
#include "fake_ranks.h"
#include "full.h"
#include "support.h"
#include "trials.h"

#include <fcntl.h>
#include <stdio.h>
#include <unistd.h>

#include "drivers/mesh/joint_files.h"
#include "sched/schedule/schedule.h"
#include "tests/files.h"

static const struct trial trials[] = {
    {"section.poly", 28, 20000, 400, false, true, 0},
    {"square_random1000.poly", 20, 20000, 700, false, false, 0},
    {"letter.poly", 30, 20000, 500, false, false, 1},
    {"section.poly", 35, 10000, 500, true, true, 0}, /* rank 0 owns all tiles */
};

enum { N_TRIALS = sizeof trials / sizeof *trials, MOST_RANKS = 6, FILES = 5 };

static const char *const names[FILES] = {"x.node", "x.ele", "x.poly", "x.h5", "x.xdmf"};

/* Faults of one rank. */
enum mishap { NONE, SEES_ANOTHER_FILE, CANNOT_WRITE };

/* --- the files of rank 0 */

struct opened {
    struct tri_output_set set;
    struct tri_text_options text;
    struct tri_text_stream *text_stream;
    struct tri_sink to_text;
    struct tri_h5_options h5;
    struct tri_h5_writer *writer;
    struct tri_sink to_h5;
};

static enum tri_status open_all(struct opened *o, const struct tri_text_options *text, struct tri_error *error)
{
    struct tri_output **const outputs[FILES] = {&o->text.node, &o->text.ele, &o->text.poly, &o->h5.file, &o->h5.xdmf};
    enum tri_status status = TRI_OK;
    *o = (struct opened){.text = *text, .h5 = {.program = "test", .name = "x.h5", .markers = true}};
    tri_outputs_begin(&o->set);
    for (int i = 0; i < (tri_h5_is_available() ? FILES : 3) && !status; i++)
        status = tri_output_open(&o->set, names[i], outputs[i], error);
    status = status ? status : tri_text_stream_new(&o->text_stream, &o->text, &o->to_text, error);
    if (!status && tri_h5_is_available())
        status = tri_h5_writer_new(&o->writer, &o->h5, &o->to_h5, error);
    return status;
}

static enum tri_status close_all(struct opened *o, enum tri_status status, struct tri_error *error)
{
    tri_text_stream_free(o->text_stream);
    tri_h5_writer_free(o->writer);
    if (!status)
        return tri_outputs_commit(&o->set, error);
    tri_outputs_abort(&o->set);
    return status;
}

/* --- one rank */

struct member {
    const struct start *start;
    struct par_options options;
    struct par_carrier carrier;
    struct tri_mesh mesh;
    struct opened opened; /* copied from rank 0 */
    enum mishap mishap;
    bool together; /* the ranks write jointly */
    enum tri_status status;
    struct tri_error error;
};

static struct tri_text_options text_options(const struct member *m)
{
    return (struct tri_text_options){.base = 1, .markers = true, .figure = &m->start->pslg};
}

/* Simulates a rank on another machine, where the same name is another file. */
static bool spread_other_file(void *self, void *bytes, size_t n)
{
    struct par_carrier carrier = fake_carrier(((struct fake_rank *)self)->world, ((struct fake_rank *)self)->self);
    const bool spread = carrier.spread(self, bytes, n);
    struct tri_ticket *ticket = bytes;
    if (n == JOINT_FILES * sizeof *ticket)
        ticket[1].inode++;
    return spread;
}

static void refine_to(struct member *m, const struct tri_sink *sink)
{
    struct par_report report;
    m->options.sink = sink;
    m->options.figure = &m->start->pslg;
    m->options.region_column = true;
    m->status = par_refine(&m->mesh, &m->start->options.quality, &m->options, &report, &m->error);
    par_report_free(&report);
}

/* Makes the file read-only. */
static void lose_permission(struct joint_files *joint)
{
    const int file = open(joint->ticket[2].temporary, O_RDONLY);
    dup2(file, joint->file[2].file);
    close(file);
}

static void write_together(struct member *m, struct joint_files *joint)
{
    const struct tri_sink sink = joint_files_sink(joint);
    if (m->mishap == CANNOT_WRITE)
        lose_permission(joint);
    refine_to(m, &sink);
}

static void *run_rank(void *user)
{
    struct member *m = user;
    struct joint_files joint = {.carrier = &m->carrier, .scratch = ".", .text_options = text_options(m)};
    if (m->mishap == SEES_ANOTHER_FILE)
        m->carrier.spread = spread_other_file;
    if (m->carrier.rank == 0) {
        m->status = open_all(&m->opened, &joint.text_options, &m->error);
        joint.text_options = m->opened.text;
        joint.text = m->opened.to_text;
        joint.h5[0] = (struct joint_h5){.writer = m->opened.writer, .sink = m->opened.to_h5,
                                        .output = m->opened.h5.file};
    }
    m->status = joint_files_open(&joint, true, m->status, &m->error);
    m->together = joint.together;
    if (!m->status && m->together)
        write_together(m, &joint);
    m->status = joint_files_close(&joint, m->status, &m->error);
    if (m->carrier.rank == 0)
        m->status = close_all(&m->opened, m->status, &m->error);
    return NULL;
}

static struct par_options small_blocks(const struct trial *trial)
{
    struct par_options options = par_defaults();
    options.cell_triangles = trial->block;
    options.threads = 1;
    return options;
}

/* unlucky: the rank with the fault. */
static void run_ranks(struct member *member, const struct trial *trial, const struct start *start, int n_ranks,
                      int unlucky, enum mishap mishap)
{
    struct fake_world world;
    fake_world_init(&world, n_ranks);
    for (int p = 0; p < n_ranks; p++) {
        member[p] = (struct member){.start = start, .options = small_blocks(trial), .mesh = trials_coarse_mesh(start),
                                    .carrier = fake_carrier(&world, p), .mishap = p == unlucky ? mishap : NONE};
        member[p].options.carrier = &member[p].carrier;
    }
    fake_run(&world, run_rank, member, sizeof *member);
    for (int p = 0; p < n_ranks; p++)
        tri_mesh_free(&member[p].mesh);
    fake_world_free(&world);
}

/* --- one process */

struct both {
    struct opened *opened;
};

static enum tri_status begin_both(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct opened *o = ((struct both *)user)->opened;
    enum tri_status status = o->to_text.begin(o->to_text.user, stream, error);
    return status || !o->writer ? status : o->to_h5.begin(o->to_h5.user, stream, error);
}

static enum tri_status hand_out_both(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct opened *o = ((struct both *)user)->opened;
    enum tri_status status = o->to_text.take(o->to_text.user, tile, error);
    return status || !o->writer ? status : o->to_h5.take(o->to_h5.user, tile, error);
}

static enum tri_status end_both(void *user, struct tri_error *error)
{
    struct opened *o = ((struct both *)user)->opened;
    enum tri_status status = o->to_text.end(o->to_text.user, error);
    return status || !o->writer ? status : o->to_h5.end(o->to_h5.user, error);
}

static void write_alone(const struct trial *trial, const struct start *start)
{
    struct member m = {.start = start, .options = small_blocks(trial), .mesh = trials_coarse_mesh(start)};
    struct both both = {&m.opened};
    const struct tri_sink sink = {&both, begin_both, hand_out_both, end_both};
    const struct tri_text_options text = text_options(&m);
    assert_int_equal(open_all(&m.opened, &text, &m.error), TRI_OK);
    refine_to(&m, &sink);
    assert_int_equal(close_all(&m.opened, m.status, &m.error), TRI_OK);
    tri_mesh_free(&m.mesh);
}

/* --- tests */

static int remove_files(void **state)
{
    (void)state;
    for (int i = 0; i < FILES; i++)
        remove(names[i]);
    assert_int_equal(files_here(), 0);
    return 0;
}

static void take_files(char *bytes[FILES], size_t n[FILES])
{
    for (int i = 0; i < (tri_h5_is_available() ? FILES : 3); i++) {
        bytes[i] = file_bytes(names[i], &n[i]);
        remove(names[i]);
    }
}

static void test_bytes_equal_those_of_one_process(void **state)
{
    (void)state;
    struct member member[MOST_RANKS];
    for (int i = 0; i < N_TRIALS; i += every(3))
        for (int n_ranks = 3 - is_full(); n_ranks <= MOST_RANKS; n_ranks += 4) {
            struct start start = trials_start_of(&trials[i]);
            char *alone[FILES] = {0}, *together[FILES] = {0};
            size_t n[FILES] = {0}, m[FILES] = {0};
            write_alone(&trials[i], &start);
            take_files(alone, n);
            run_ranks(member, &trials[i], &start, n_ranks, -1, NONE);
            for (int p = 0; p < n_ranks; p++) {
                assert_int_equal(member[p].status, TRI_OK);
                assert_true(member[p].together);
            }
            take_files(together, m);
            for (int k = 0; k < FILES; k++) {
                assert_int_equal(n[k], m[k]);
                assert_true(n[k] == 0 || memcmp(alone[k], together[k], n[k]) == 0);
                free(alone[k]);
                free(together[k]);
            }
            tri_pslg_free(&start.pslg);
        }
}

static void test_ranks_that_see_different_files_do_not_write_them(void **state)
{
    (void)state;
    struct member member[4];
    struct start start = trials_start_of(&trials[1]);
    run_ranks(member, &trials[1], &start, 4, 2, SEES_ANOTHER_FILE);
    for (int p = 0; p < 4; p++) {
        assert_int_equal(member[p].status, TRI_OK);
        assert_false(member[p].together);
    }
    tri_pslg_free(&start.pslg);
}

static void test_a_failed_write_fails_on_all_ranks(void **state)
{
    (void)state;
    struct member member[3];
    struct start start = trials_start_of(&trials[1]);
    for (int unlucky = 1; unlucky < 3; unlucky++) {
        run_ranks(member, &trials[1], &start, 3, unlucky, CANNOT_WRITE);
        for (int p = 0; p < 3; p++) {
            assert_int_equal(member[p].status, TRI_CANNOT_WRITE);
            assert_string_equal(member[p].error.file, "x.poly");
            assert_string_equal(member[p].error.text, member[0].error.text);
        }
        assert_int_equal(files_here(), 0);
    }
    tri_pslg_free(&start.pslg);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_teardown(test_bytes_equal_those_of_one_process, remove_files),
        cmocka_unit_test_teardown(test_ranks_that_see_different_files_do_not_write_them, remove_files),
        cmocka_unit_test_teardown(test_a_failed_write_fails_on_all_ranks, remove_files),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
