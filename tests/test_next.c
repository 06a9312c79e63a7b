/* The steps of a run: runs take only the steps listed in next.h, and together they take every listed step. */
#include "sched/schedule/next.h"

#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fake_ranks.h"
#include "sched/checkpoint/checkpoint.h"
#include "sched/schedule/schedule.h"
#include "trials.h"

enum { STEPS = PAR_END + 1 };

static const char *const name[STEPS] = {
    [PAR_SIZES] = "PAR_SIZES", [PAR_SIZES_PHASE] = "PAR_SIZES_PHASE", [PAR_SIZES_REST] = "PAR_SIZES_REST",
    [PAR_BOUNDS] = "PAR_BOUNDS", [PAR_BOUNDS_WHOLE] = "PAR_BOUNDS_WHOLE", [PAR_COLUMN] = "PAR_COLUMN",
    [PAR_COLUMN_PHASE] = "PAR_COLUMN_PHASE", [PAR_BOUNDS_PHASE] = "PAR_BOUNDS_PHASE",
    [PAR_BOUNDS_REST] = "PAR_BOUNDS_REST", [PAR_HAND_OUT] = "PAR_HAND_OUT", [PAR_END] = "PAR_END"};

struct steps {
    bool made[STEPS][STEPS];
    int last;               /* the last step; -1: none */
    bool is_torn;           /* a step did not begin where the previous step ended */
    int kill_from, kill_to; /* range of steps at which the process ends; -1: at none */
    int n_before_kill;      /* number of times that step is taken before the process ends */
    int64_t n_triangles;    /* triangles that the sink has received */
};

static const struct steps NO_STEPS = {.last = -1, .kill_from = -1, .kill_to = -1};

/* --- steps listed in next.h */

static int step_named(const char *word, size_t length)
{
    for (int step = 0; step < STEPS; step++)
        if (strlen(name[step]) == length && memcmp(name[step], word, length) == 0)
            return step;
    fail_msg("next.h lists %.*s, which is no step", (int)length, word);
    return -1;
}

/* The steps named in one row of the table. Where a row lists several, the first is the step at which they begin. */
static void read_line(const char *line, struct steps *listed)
{
    int from = -1;
    for (const char *word = strstr(line, "PAR_"); word; word = strstr(word, "PAR_")) {
        const size_t length = strspn(word, "ABCDEFGHIJKLMNOPQRSTUVWXYZ_");
        const int step = step_named(word, length);
        if (from >= 0)
            listed->made[from][step] = true;
        from = from < 0 ? step : from;
        word += length;
    }
}

static struct steps read_table(void)
{
    struct steps listed = NO_STEPS;
    char line[256];
    bool inside = false;
    FILE *file = fopen(PTRIANGLE_DATA_DIR "/../sched/schedule/next.h", "r");
    assert_non_null(file);
    while (fgets(line, sizeof line, file) && !(inside && strcmp(line, " *\n") == 0)) {
        if (inside)
            read_line(line, &listed);
        inside = inside || strncmp(line, " *     from ", 12) == 0;
    }
    fclose(file);
    assert_true(inside);
    return listed;
}

/* --- steps that runs take */

static void note_step(void *user, int from, int to)
{
    struct steps *steps = user;
    assert_true(from >= 0 && from < STEPS && to >= 0 && to < STEPS);
    steps->is_torn = steps->is_torn || (steps->last >= 0 && steps->last != from);
    steps->made[from][to] = true;
    steps->last = to;
    if (from == steps->kill_from && to == steps->kill_to && steps->n_before_kill-- == 0)
        _exit(0);
}

static enum tri_status count_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct steps *steps = user;
    (void)error;
    steps->n_triangles += tile->n_triangles;
    return TRI_OK;
}

static enum tri_status begin_again(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct steps *steps = user;
    (void)stream, (void)error;
    steps->n_triangles = 0;
    return TRI_OK;
}

static const struct tri_sink counting = {NULL, begin_again, count_tile, NULL}; /* counts the steps of the run */

static bool never_stop(void *user)
{
    (void)user;
    return false;
}

static enum tri_status refine(const struct trial *trial, struct par_options options, struct steps *steps)
{
    struct start start = trials_start_of(trial);
    struct tri_mesh mesh = trials_coarse_mesh(&start);
    struct par_report report;
    struct tri_error error = {0};
    struct tri_sink sink = counting;
    sink.user = steps;
    options.sink = options.sink ? &sink : NULL;
    options.cell_triangles = trial->block;
    options.threads = 1;
    options.on_step = note_step;
    options.on_step_user = steps;
    steps->last = -1;
    mesh.stop = &(struct tri_stop){never_stop, NULL};
    enum tri_status status = par_refine(&mesh, &start.options.quality, &options, &report, &error);
    if (status && status != TRI_STOPPED)
        fail_msg("%s: %s", trial->file, error.text);
    par_report_free(&report);
    tri_mesh_free(&mesh);
    tri_pslg_free(&start.pslg);
    return status;
}

static void run_whole(const struct trial *trial, struct steps *steps)
{
    assert_int_equal(refine(trial, par_defaults(), steps), TRI_OK);
    assert_int_equal(steps->last, PAR_END);
}

static struct par_options swept(void)
{
    struct par_options options = par_defaults();
    options.sweep = true;
    options.sink = &counting;
    options.scratch = ".";
    return options;
}

static void run_swept(const struct trial *trial, struct steps *steps)
{
    assert_int_equal(refine(trial, swept(), steps), TRI_OK);
    assert_int_equal(steps->last, PAR_END);
}

static const char DIRECTORY[] = "next_state";

/* A process that writes a checkpoint at each border is killed at a step, after taking that step a given number of
   times. */
static void kill_at(const struct trial *trial, struct par_options options, struct steps at, bool resume)
{
    struct par_checkpoint c;
    int how = 1;
    fflush(NULL);
    const pid_t child = fork();
    if (child == 0) {
        assert_int_equal(par_checkpoint_open(&c, DIRECTORY, resume, 7, NULL), TRI_OK);
        c.seconds = 0;
        options.checkpoint = &c;
        refine(trial, options, &at);
        _exit(2); /* the run did not reach the step */
    }
    assert_true(waitpid(child, &how, 0) == child && WIFEXITED(how));
    assert_int_equal(WEXITSTATUS(how), 0);
}

/* Another process continues to the end. */
static void resume_run(const struct trial *trial, struct par_options options, struct steps *steps)
{
    struct par_checkpoint c;
    assert_int_equal(par_checkpoint_open(&c, DIRECTORY, true, 7, NULL), TRI_OK);
    c.seconds = 1e9;
    options.checkpoint = &c;
    assert_int_equal(refine(trial, options, steps), TRI_OK);
    assert_int_equal(steps->last, PAR_END);
    assert_null(c.stop); /* the error may have been the run's own */
    par_checkpoint_close(&c, true);
}

static void run_killed(const struct trial *trial, struct par_options options, int from, int to, struct steps *steps)
{
    struct steps at = NO_STEPS;
    at.kill_from = from;
    at.kill_to = to;
    support_remove_directory(DIRECTORY);
    kill_at(trial, options, at, false);
    resume_run(trial, options, steps);
}

/* --- on ranks */

struct member {
    const struct trial *trial;
    struct par_carrier carrier;
    struct steps steps;
};

static void *run_rank(void *user)
{
    struct member *m = user;
    struct par_options options = par_defaults();
    options.carrier = &m->carrier;
    options.sink = &counting;
    enum tri_status status = refine(m->trial, options, &m->steps);
    assert_int_equal(par_agree(&m->carrier, status, NULL), TRI_OK);
    return NULL;
}

static void run_on_ranks(const struct trial *trial, struct steps *steps)
{
    enum { N = 3 };
    struct fake_world world;
    struct member member[N];
    fake_world_init(&world, N);
    for (int p = 0; p < N; p++)
        member[p] = (struct member){trial, fake_carrier(&world, p), NO_STEPS};
    fake_run(&world, run_rank, member, sizeof *member);
    fake_world_free(&world);
    for (int p = 0; p < N; p++) {
        assert_memory_equal(member[p].steps.made, member[0].steps.made, sizeof member[0].steps.made);
        assert_int_equal(member[p].steps.last, PAR_END);
    }
    for (int from = 0; from < STEPS; from++)
        for (int to = 0; to < STEPS; to++)
            steps->made[from][to] |= member[0].steps.made[from][to];
}

/* --- listed steps and steps taken */

static const struct trial little = {"letter.poly", 20, 300, 500, false, false, 0};
static const struct trial easy = {"letter.poly", 20, 15000, 500, false, false, 0};
/* Blocks leave some bad triangles. */
static const struct trial stubborn = {"cracked_plate.poly", 20, 5000, 256, false, false, 1};
static const struct trial expensive = {"letter.poly", 33, 15000, 500, false, false, 0};
static const struct trial both = {"cracked_plate.poly", 33, 5000, 256, false, false, 1};
/* Refinement for sizes has no cells of its own. */
static const struct trial few_cells = {"cracked_plate.poly", 36, 15000, 2000, false, false, 1};
static const struct trial no_cells = {"letter.poly", 33, 15000, 1e6, false, false, 0};

static void run_all(struct steps *made)
{
    run_whole(&little, made);
    run_whole(&easy, made);
    run_whole(&stubborn, made);
    run_whole(&expensive, made);
    run_whole(&both, made);
    run_whole(&no_cells, made);
    run_swept(&easy, made);
    run_swept(&stubborn, made);
    run_swept(&few_cells, made);
    run_on_ranks(&easy, made);
    run_on_ranks(&stubborn, made);
    run_on_ranks(&both, made);
    run_killed(&no_cells, par_defaults(), PAR_BOUNDS, PAR_HAND_OUT, made);
    run_killed(&stubborn, swept(), PAR_COLUMN, PAR_BOUNDS_WHOLE, made);
    run_killed(&few_cells, swept(), PAR_COLUMN, PAR_BOUNDS_WHOLE, made);
}

static void test_runs_make_the_steps_that_are_listed(void **state)
{
    (void)state;
    const struct steps listed = read_table();
    struct steps made = NO_STEPS;
    int n = 0, wrong = 0;
    run_all(&made);
    for (int from = 0; from < STEPS; from++)
        for (int to = 0; to < STEPS; to++) {
            n += made.made[from][to];
            if (made.made[from][to] == listed.made[from][to])
                continue;
            print_error("  %s -> %s: %s\n", name[from], name[to], made.made[from][to] ? "not listed" : "never made");
            wrong++;
        }
    print_message("  %d steps\n", n);
    assert_false(made.is_torn);
    assert_int_equal(wrong, 0);
}

/* Sizes are first met by one call, then the mesh is swept. A resumed run repeats that call on its way to the column in
   which it was killed. Columns in the checkpoint are kept and handed out once. */
static void test_a_sweep_is_killed_again_and_again(void **state)
{
    (void)state;
    static const struct trial trial = {"gear.poly", 36, 15000, 2000, false, false, 1};
    struct steps at = NO_STEPS, whole = NO_STEPS, last = NO_STEPS;
    run_swept(&trial, &whole);
    assert_true(whole.made[PAR_SIZES][PAR_BOUNDS] && whole.made[PAR_COLUMN][PAR_END]);
    at.kill_from = PAR_COLUMN;
    at.kill_to = PAR_COLUMN_PHASE;
    at.n_before_kill = 2;
    support_remove_directory(DIRECTORY);
    kill_at(&trial, swept(), at, false);
    at.n_before_kill = 0;
    for (int k = 0; k < 2; k++)
        kill_at(&trial, swept(), at, true);
    resume_run(&trial, swept(), &last);
    assert_true(last.n_triangles == whole.n_triangles && whole.n_triangles > 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_runs_make_the_steps_that_are_listed),
                                       cmocka_unit_test(test_a_sweep_is_killed_again_and_again)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
