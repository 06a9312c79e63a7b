/* The schedule on ranks, which are threads here: the tiles equal those of one process for any number of ranks and any
   shares of the columns. An error on any rank is returned by all ranks. */
#include "fake_ranks.h"
#include "full.h"
#include "support.h"
#include "trials.h"

#include <stdio.h>

#include "sched/ranks/ranks.h"
#include "sched/ranks/relay.h"
#include "sched/schedule/schedule.h"
#include "sched/checkpoint/checkpoint.h"

static const struct trial trials[] = {
    {"letter.poly", 30, 20000, 500, false, false, 0},
    {"square_random1000.poly", 20, 20000, 700, false, false, 0},
    {"section.poly", 28, 20000, 400, false, true, 0},
    {"gear.poly", 30, 10000, 256, false, false, 0},
    {"coast/norway_sea.poly", 25, 0, 2000, false, false, 0},
    {"koch_lake.poly", 30, 0, 600, false, false, 0},
    {"coast/borders.poly", 20, 30000, 1500, false, false, 0},
    {"perforated.poly", 30, 25000, 1000, true, false, 0},
    {"cracked_plate.poly", 28, 15000, 400, false, false, 1},
    {"box_hole.poly", 0, 10000, 256, false, false, 0},
    {"nasty/dense_parallel.poly", 20, 5000, 256, false, false, 2},
    {"nasty/aspect_1e8.poly", 20, 10000, 256, false, false, 0},
    {"nasty/huge_scale.poly", 30, 10000, 256, false, false, 0},
    {"nasty/needle_1e-9.poly", 20, 4000, 256, false, false, 0},
    {"square_random1000.poly", 33, 10000, 256, false, false, 0}, /* needs two schedules */
    {"section.poly", 32, 20000, 300, true, true, 0},
    {"coast/norway_sea.poly", 34, 30000, 400, false, false, 0},
    {"letter.poly", 34, 20000, 500, false, false, 1},
    {"section.poly", 35, 10000, 500, true, true, 0},             /* followed by a sequential call */
    {"section.poly", 25, -15000, 300, false, true, 0},
    {"letter.poly", 25, -20000, 300, false, false, 0}, /* coarse vertices are erased, also at borders between ranks */
};

enum { N_TRIALS = sizeof trials / sizeof *trials, MOST_RANKS = 9 };

/* --- tiles handed out */

/* What one sink has received. Asserts of cmocka may only run on the main thread. */
struct stream {
    struct par_bytes bytes;
    bool first_rank, lost;
    int32_t n_attributes;
    int64_t end[3];        /* numbers of vertices, triangles and segments so far; -1: no tile yet */
    int64_t begin[3];
    int32_t fail_at;       /* number of the call of take that fails; 0: none */
};

static void append(struct stream *s, const void *bytes, int64_t n, size_t item)
{
    s->lost = s->lost || !par_bytes_add(&s->bytes, bytes, (size_t)n * item);
}

static enum tri_status begin_stream(void *user, const struct tri_stream *told, struct tri_error *error)
{
    struct stream *s = user;
    (void)error;
    s->n_attributes = told->n_attributes;
    if (s->first_rank)
        append(s, told->regions, (int64_t)told->n_regions * told->n_columns, sizeof *told->regions);
    return TRI_OK;
}

static enum tri_status take_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct stream *s = user;
    const int64_t first[3] = {tile->first_vertex, tile->first_triangle, tile->first_segment};
    const int32_t n[3] = {tile->n_vertices, tile->n_triangles, tile->n_segments};
    if (s->fail_at > 0 && --s->fail_at == 0)
        return tri_fail(error, TRI_CANNOT_WRITE, "mesh.ele", 0, "no space left");
    for (int k = 0; k < 3; k++) {
        if (s->end[k] < 0)
            s->begin[k] = s->end[k] = first[k];
        s->lost = s->lost || s->end[k] != first[k];
        s->end[k] += n[k];
    }
    append(s, &tile->column, 1, sizeof tile->column);
    append(s, &tile->row, 1, sizeof tile->row);
    append(s, first, 3, sizeof *first);
    append(s, tile->points, tile->n_vertices, sizeof *tile->points);
    append(s, tile->point_markers, tile->n_vertices, sizeof *tile->point_markers);
    append(s, tile->attributes, (int64_t)tile->n_vertices * s->n_attributes, sizeof *tile->attributes);
    append(s, tile->corners, tile->n_triangles, sizeof *tile->corners);
    append(s, tile->regions, tile->n_triangles, sizeof *tile->regions);
    append(s, tile->ends, tile->n_segments, sizeof *tile->ends);
    append(s, tile->segment_markers, tile->n_segments, sizeof *tile->segment_markers);
    return TRI_OK;
}

static struct stream new_stream(bool first_rank)
{
    return (struct stream){.first_rank = first_rank, .end = {-1, -1, -1}};
}

/* --- one rank */

struct member {
    const struct start *start;
    struct par_options options;
    struct par_carrier carrier;
    struct tri_mesh mesh;
    struct stream stream;
    struct par_report report;
    enum tri_status status;
    struct tri_error error;
    bool relayed;
    struct par_checkpoint checkpoint; /* open on rank 0 if the run has a checkpoint */
};

static void refine_to(struct member *m)
{
    const struct tri_sink sink = {&m->stream, begin_stream, take_tile, NULL};
    m->options.sink = &sink;
    m->options.figure = &m->start->pslg;
    m->options.region_column = true;
    m->status = par_refine(&m->mesh, &m->start->options.quality, &m->options, &m->report, &m->error);
}

/* Sends all tiles to the sink of rank 0. */
static void refine_and_relay(struct member *m)
{
    const struct tri_sink to = {&m->stream, begin_stream, take_tile, NULL};
    struct par_relay relay = {.carrier = &m->carrier, .to = &to, .most_bytes = 10000,
                              .room = m->carrier.n_ranks % 2 ? 30000 : 0};
    const struct tri_sink sink = par_relay_sink(&relay);
    m->options.sink = &sink;
    m->options.figure = &m->start->pslg;
    m->options.region_column = true;
    m->status = par_refine(&m->mesh, &m->start->options.quality, &m->options, &m->report, &m->error);
    m->status = par_relay_finish(&relay, m->status, &m->error);
}

static void *run_rank(void *user)
{
    struct member *m = user;
    if (m->relayed)
        refine_and_relay(m);
    else
        refine_to(m);
    m->status = par_agree(&m->carrier, m->status, &m->error);
    return NULL;
}

static void free_member(struct member *m)
{
    free(m->stream.bytes.at);
    par_report_free(&m->report);
    tri_mesh_free(&m->mesh);
}

static struct par_options small_blocks(const struct trial *trial, int threads)
{
    struct par_options options = par_defaults();
    options.cell_triangles = trial->block;
    options.threads = threads;
    return options;
}

static struct member new_member(const struct start *start, const struct par_options *options)
{
    struct tri_mesh mesh = trials_coarse_mesh(start);
    return (struct member){.start = start, .options = *options, .mesh = mesh, .stream = new_stream(true)};
}

/* Random shares, some of them empty. */
static void draw_shares(double share[MOST_RANKS + 1], int n_ranks, struct support_random *random)
{
    share[0] = 0;
    for (int p = 1; p < n_ranks; p++) {
        double cut = support_unit(random) * 1.2 - 0.1;
        cut = cut < 0 ? 0 : cut > 1 ? 1 : cut;
        int k = p;
        for (; k > 1 && share[k - 1] > cut; k--)
            share[k] = share[k - 1];
        share[k] = cut;
    }
    share[n_ranks] = 1;
}

static void new_members(struct member *member, const struct start *start, const struct par_options *options,
                        struct fake_world *world, const double *share, int fails, bool relayed)
{
    for (int p = 0; p < world->n_ranks; p++) {
        member[p] = new_member(start, options);
        member[p].carrier = fake_carrier(world, p);
        member[p].carrier.share = share;
        member[p].options.carrier = &member[p].carrier;
        member[p].options.threads = 1 + p % 2;
        member[p].stream.first_rank = p == 0;
        member[p].stream.fail_at = p == fails ? relayed ? 8 : 2 : 0;
        member[p].relayed = relayed;
        if (relayed && p % 2 == 0) { /* all of its mesh is removed from memory at once */
            member[p].options.memory = 1;
            member[p].options.scratch = ".";
        }
    }
}

static void run_ranks(struct member *member, const struct start *start, const struct par_options *options, int n_ranks,
                      const double *share, int fails, bool relayed)
{
    struct fake_world world;
    fake_world_init(&world, n_ranks);
    new_members(member, start, options, &world, share, fails, relayed);
    fake_run(&world, run_rank, member, sizeof *member);
    fake_world_free(&world);
}

/* One process, then each number of ranks in turn, gives the same bytes. */
static void compare(const struct member *alone, const struct member *member, int n_ranks)
{
    size_t at = 0;
    for (int p = 0; p < n_ranks; p++) {
        const struct stream *s = &member[p].stream;
        if (member[p].status)
            fail_msg("rank %d of %d: %s", p, n_ranks, member[p].error.text);
        assert_false(s->lost);
        if (s->bytes.n == 0)
            continue;
        if (at + s->bytes.n > alone->stream.bytes.n || memcmp(alone->stream.bytes.at + at, s->bytes.at, s->bytes.n))
            fail_msg("rank %d of %d hands out something else", p, n_ranks);
        at += s->bytes.n;
    }
    assert_int_equal(at, alone->stream.bytes.n);
}

static int64_t sent(const struct member *member, int n_ranks, enum par_move move)
{
    int64_t bytes = 0;
    for (int p = 0; p < n_ranks; p++)
        bytes += member[p].carrier.traffic[move].bytes;
    return bytes;
}

static void test_ranks_hand_out_the_tiles_of_one_process(void **state)
{
    (void)state;
    struct support_random random = {7};
    for (int i = 0; i < N_TRIALS; i += every(5)) {
        struct start start = trials_start_of(&trials[i]);
        struct par_options options = small_blocks(&trials[i], 2);
        struct member alone = new_member(&start, &options), member[MOST_RANKS];
        refine_to(&alone);
        assert_int_equal(alone.status, TRI_OK);
        for (int round = is_full() ? 0 : i % 2; round < 2; round += every(2)) {
            int n_ranks = i == round ? 2 : 1 + support_below(&random, MOST_RANKS);
            double share[MOST_RANKS + 1];
            draw_shares(share, n_ranks, &random);
            run_ranks(member, &start, &options, n_ranks, round == 1 ? share : NULL, -1, (i + round) % 3 == 0);
            compare(&alone, member, n_ranks);
            assert_int_equal(member[0].report.deferred, alone.report.deferred);
            print_message("  %-28s %7lld triangles, %d columns, rounds %d, left over %lld, %d ranks: bytes a triangle"
                          " %.2f strips, %.2f back, %.2f left over, %.2f numbers\n",
                          trials[i].file, (long long)alone.stream.end[1], (int)alone.report.columns,
                          alone.report.rounds, (long long)alone.report.left_over, n_ranks,
                          (double)sent(member, n_ranks, PAR_MOVE_BORDERS) / (double)alone.stream.end[1],
                          (double)sent(member, n_ranks, PAR_MOVE_BACK) / (double)alone.stream.end[1],
                          (double)sent(member, n_ranks, PAR_MOVE_LEFT_OVER) / (double)alone.stream.end[1],
                          (double)sent(member, n_ranks, PAR_MOVE_NUMBERS) / (double)alone.stream.end[1]);
            for (int p = 0; p < n_ranks; p++)
                free_member(&member[p]);
        }
        free_member(&alone);
        trials_free(&start);
    }
}

/* A block leaves a triangle beside a subsegment with a corner outside its box, in an area of a rank that lends it no
   triangles. */
static void test_a_block_leaves_triangles_beyond_its_box(void **state)
{
    (void)state;
    static const struct trial trial = {"section.poly", 25, 0, 60, true, false, 0};
    struct start start = trials_start_of(&trial);
    struct par_options options = small_blocks(&trial, 1);
    struct member alone = new_member(&start, &options), member[MOST_RANKS];
    refine_to(&alone);
    for (int n_ranks = 5; n_ranks <= MOST_RANKS; n_ranks += 2) {
        run_ranks(member, &start, &options, n_ranks, NULL, -1, false);
        compare(&alone, member, n_ranks);
        for (int p = 0; p < n_ranks; p++)
            free_member(&member[p]);
    }
    free_member(&alone);
    trials_free(&start);
}

/* The disk is full on one rank: all ranks return the error with the same message. */
static void test_an_error_on_one_rank_is_returned_by_all(void **state)
{
    (void)state;
    for (int fails = 0; fails < 4; fails++) { /* 3: rank 0, for tiles received from others */
        static const struct trial trial = {"gear.poly", 30, 10000, 128, false, false, 0};
        struct start start = trials_start_of(&trial);
        struct par_options options = small_blocks(&trial, 1);
        struct member member[3];
        run_ranks(member, &start, &options, 3, NULL, fails < 3 ? fails : 0, fails == 3);
        for (int p = 0; p < 3; p++) {
            assert_int_equal(member[p].status, TRI_CANNOT_WRITE);
            assert_string_equal(member[p].error.file, "mesh.ele");
            assert_string_equal(member[p].error.text, "no space left");
            free_member(&member[p]);
        }
        trials_free(&start);
    }
}

/* --- checkpoints */

static const char DIRECTORY[] = "ranks-state";

/* Rank 0 requests the end as soon as there is a checkpoint to resume from and it has been reported. */
static bool has_kept(void *user)
{
    const struct par_checkpoint *c = user;
    return par_checkpoint_has_state(c) && c->last > 0;
}

/* Runs from one checkpoint to the next, with a given number of ranks and their shares. */
static void run_a_step(struct member *member, const struct start *start, const struct par_options *options,
                       int n_ranks, const double *share, bool resume)
{
    struct fake_world world;
    fake_world_init(&world, n_ranks);
    new_members(member, start, options, &world, share, -1, false);
    assert_int_equal(par_checkpoint_open(&member[0].checkpoint, DIRECTORY, resume, 7, NULL), TRI_OK);
    const struct tri_stop stop = {has_kept, &member[0].checkpoint};
    for (int p = 0; p < n_ranks; p++) {
        member[p].checkpoint.directory = DIRECTORY;
        member[p].checkpoint.seconds = 0;
        member[p].options.checkpoint = &member[p].checkpoint;
    }
    member[0].mesh.stop = &stop;
    fake_run(&world, run_rank, member, sizeof *member);
    fake_world_free(&world);
    for (int p = 0; p < n_ranks; p++)
        assert_int_equal(member[p].status, member[0].status);
}

static void remove_checkpoint(void)
{
    support_remove_directory(DIRECTORY);
}

/* Each step is done by a different number of ranks with different shares. Returns the number of runs. */
static int run_in_steps(const struct member *alone, const struct start *start, const struct par_options *options,
                        struct support_random *random)
{
    enum tri_status status = TRI_STOPPED;
    int runs = 0;
    remove_checkpoint();
    while (status == TRI_STOPPED && runs < 400) {
        struct member member[MOST_RANKS];
        double share[MOST_RANKS + 1];
        int n_ranks = 1 + support_below(random, runs < 2 ? MOST_RANKS : 5);
        draw_shares(share, n_ranks, random);
        run_a_step(member, start, options, n_ranks, runs % 2 ? share : NULL, runs > 0);
        runs++;
        status = member[0].status;
        if (status && status != TRI_STOPPED)
            fail_msg("run %d: %s", runs, member[0].error.text);
        if (!status) {
            compare(alone, member, n_ranks);
            assert_int_equal(member[0].report.total.inserted_free, alone->report.total.inserted_free);
            assert_int_equal(member[0].report.left_over > 0, alone->report.left_over > 0); /* ranks may share one */
            assert_int_equal(member[0].report.rounds, alone->report.rounds);
        }
        par_checkpoint_close(&member[0].checkpoint, !status);
        for (int p = 0; p < n_ranks; p++)
            free_member(&member[p]);
    }
    assert_int_equal(status, TRI_OK);
    return runs;
}

static void test_other_ranks_resume_from_a_checkpoint(void **state)
{
    (void)state;
    static const int chosen[] = {5, 15, 10, 6, 20};
    struct support_random random = {11};
    for (size_t i = 0; i < sizeof chosen / sizeof *chosen; i += (size_t)every(2)) {
        const struct trial *trial = &trials[chosen[i]];
        struct start start = trials_start_of(trial);
        struct par_options options = small_blocks(trial, 2);
        options.cell_triangles /= 4; /* makes phases take several steps */
        struct member alone = new_member(&start, &options);
        refine_to(&alone);
        int runs = run_in_steps(&alone, &start, &options, &random);
        print_message("  %-28s in %d runs\n", trial->file, runs);
        assert_true(runs > 2);
        free_member(&alone);
        trials_free(&start);
    }
}

static void flip_byte(const char *name, long at)
{
    FILE *file = fopen(name, "r+b");
    assert_non_null(file);
    fseek(file, at, SEEK_SET);
    int byte = fgetc(file);
    assert_int_not_equal(byte, EOF);
    fseek(file, at, SEEK_SET);
    fputc(byte ^ 1, file);
    fclose(file);
}

/* Two ranks resume, and both fail. */
static void expect_refusal(const struct start *start, const struct par_options *options, const char *text)
{
    struct member member[2];
    run_a_step(member, start, options, 2, NULL, true);
    for (int p = 0; p < 2; p++) {
        assert_int_equal(member[p].status, TRI_BAD_INPUT);
        assert_non_null(strstr(member[p].error.text, text));
        free_member(&member[p]);
    }
    par_checkpoint_close(&member[0].checkpoint, false);
}

static void test_checkpoints_of_other_runs_are_refused(void **state)
{
    (void)state;
    static const struct {
        const char *name;
        long at;
    } damage[] = {{"piece-1-1", 9}, {"piece-1-0", 40}, {"piece-1-0", 5000}, {"piece-1-1", 4000}, {"state-1", 70}};
    struct start start = trials_start_of(&trials[3]), other = trials_start_of(&trials[0]);
    struct par_options options = small_blocks(&trials[3], 1);
    struct member member[3];
    remove_checkpoint();
    run_a_step(member, &start, &options, 3, NULL, false); /* writes two checkpoints */
    assert_int_equal(member[0].status, TRI_STOPPED);
    par_checkpoint_close(&member[0].checkpoint, false);
    for (int p = 0; p < 3; p++)
        free_member(&member[p]);
    for (size_t i = 0; i < sizeof damage / sizeof *damage; i++) {
        char path[64];
        snprintf(path, sizeof path, "%s/%s", DIRECTORY, damage[i].name);
        flip_byte(path, damage[i].at);
        expect_refusal(&start, &options, "damaged");
        flip_byte(path, damage[i].at);
    }
    expect_refusal(&other, &options, "of another run");
    remove_checkpoint();
    trials_free(&start);
    tri_pslg_free(&other.pslg);
}

/* --- data of the first rank */

struct listener {
    struct par_carrier carrier;
    char text[8];
    bool fails;
    enum tri_status status;
};

static void *listen(void *user)
{
    struct listener *l = user;
    struct tri_error error = {0};
    enum tri_status own = l->fails ? tri_fail(&error, TRI_NO_MEMORY, NULL, 0, "no room") : TRI_OK;
    l->status = par_spread(&l->carrier, PAR_MOVE_INPUT, l->text, sizeof l->text, own, &error);
    l->status = par_spread(&l->carrier, PAR_MOVE_INPUT, NULL, 0, l->status, &error);
    return NULL;
}

static void test_all_ranks_get_the_data_of_the_first(void **state)
{
    (void)state;
    for (int fails = -1; fails < 3; fails++) {
        struct fake_world world;
        struct listener l[3];
        fake_world_init(&world, 3);
        for (int p = 0; p < 3; p++) {
            l[p] = (struct listener){.carrier = fake_carrier(&world, p), .fails = p == fails};
            strcpy(l[p].text, p == 0 ? "said" : "unsaid");
        }
        fake_run(&world, listen, l, sizeof *l);
        fake_world_free(&world);
        for (int p = 0; p < 3; p++) {
            assert_int_equal(l[p].status, fails < 0 ? TRI_OK : TRI_NO_MEMORY);
            assert_string_equal(l[p].text, p == 0 || fails < 0 ? "said" : "unsaid");
            assert_int_equal(l[p].carrier.traffic[PAR_MOVE_INPUT].bytes, p == 0 && fails < 0 ? 16 : 0);
        }
    }
}

/* --- inconsistent calls */

struct caller {
    struct par_carrier carrier;
    double corner, area;
    bool has_sink;
    enum tri_status status;
    struct tri_error error;
};

static enum tri_status discard_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    (void)user, (void)tile, (void)error;
    return TRI_OK;
}

static void *call(void *user)
{
    struct caller *c = user;
    const double points[] = {0, 0, 1, 0, c->corner, 1, 0, 1};
    struct tri_figure figure = tri_no_figure();
    struct tri_settings settings = tri_no_settings();
    const struct tri_sink sink = {.take = c->has_sink ? discard_tile : NULL};
    figure.points = (struct tri_reals){.at = points, .n = 4, .width = 2, .stride = 2};
    settings.min_angle = 25;
    settings.max_area = c->area;
    settings.threads = 1;
    c->status = par_stream_over(&c->carrier, &figure, &settings, &sink, &c->error);
    return NULL;
}

/* No rank waits: all ranks return the same status. */
static void test_inconsistent_calls_on_ranks_are_refused(void **state)
{
    static const struct {
        double corner, area;
        bool has_sink;
        const char *text; /* NULL: the same call as on the other ranks */
    } one[] = {
        {1, 1e-5, true, NULL},
        {1, 2e-5, true, "the ranks were given different inputs or settings"},
        {1, 0.4, true, "the ranks were given different inputs or settings"}, /* too small to be distributed */
        {2, 1e-5, true, "the ranks were given different inputs or settings"},
        {1, -1, true, "settings: max_area is -1"},
        {1, 1e-5, false, "a stream needs a sink with a take function"},
    };
    (void)state;
    for (size_t i = 0; i < sizeof one / sizeof *one; i++) {
        struct fake_world world;
        struct caller c[3];
        fake_world_init(&world, 3);
        for (int p = 0; p < 3; p++)
            c[p] = (struct caller){.carrier = fake_carrier(&world, p), .corner = 1, .area = 1e-5, .has_sink = true};
        c[1].corner = one[i].corner;
        c[1].area = one[i].area;
        c[1].has_sink = one[i].has_sink;
        fake_run(&world, call, c, sizeof *c);
        fake_world_free(&world);
        for (int p = 0; p < 3; p++) {
            assert_int_equal(c[p].status, one[i].text ? TRI_BAD_INPUT : TRI_OK);
            assert_string_equal(c[p].error.text, one[i].text ? one[i].text : "");
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_all_ranks_get_the_data_of_the_first),
        cmocka_unit_test(test_ranks_hand_out_the_tiles_of_one_process),
        cmocka_unit_test(test_a_block_leaves_triangles_beyond_its_box),
        cmocka_unit_test(test_an_error_on_one_rank_is_returned_by_all),
        cmocka_unit_test(test_other_ranks_resume_from_a_checkpoint),
        cmocka_unit_test(test_checkpoints_of_other_runs_are_refused),
        cmocka_unit_test(test_inconsistent_calls_on_ranks_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
