/* ptriangle: the mesh generator on all cores. It has the command line, files and printed lines of Triangle, and long
 * options. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/joint_files.h"
#include "drivers/mesh/launch.h"
#include "drivers/mesh/long_options.h"
#include "drivers/mesh/plan.h"
#include "drivers/mesh/progress.h"
#include "drivers/mesh/report_json.h"
#include "drivers/mesh/restart.h"
#include "drivers/mesh/stages.h"
#include "drivers/mesh/streams.h"
#include "drivers/mesh/summary.h"
#include "drivers/start.h"
#include "sched/ranks/relay.h"
#include "sched/schedule/partition.h"
#include "sched/schedule/schedule.h"
#include "sched/schedule/threads.h"
#include "sched/tiles/park.h"
#include "sched/tiles/queue.h"
#include "triangle/base/size_text.h"
#include "triangle/base/system.h"
#include "triangle/refine/census.h"
#include "triangle/text/decimal.h"
#include "triangle/text/formats.h"
#include "triangle/text/names.h"
#include "triangle/text/write.h"

static const char PROGRAM[] = PTRIANGLE_NAME;

/* The program, from its arguments to its files; initially all 0. */
struct program {
    struct run run;               /* from files to files; begins after the arguments have been read */
    struct long_options options;
    char *scratch;                /* folder for data that do not fit in memory, malloc'ed: options.scratch */
    struct progress progress;
    struct restart restart;
    struct launch launch;
    struct streams streams;
    struct joint_files joint;     /* on several ranks */
    struct par_team team;
    struct tri_executor executor; /* executor of the team */
    struct par_park *park;        /* files of the mesh, which live as long as it; NULL: the mesh is in memory, or
                                     swept */
    int32_t n_before;             /* number of vertices before refinement */
    bool refined;                 /* refinement has run, and its report is filled */
    struct par_report schedule;
    struct rank_report ranks;     /* n_ranks is 0: there is a single process */
};

/* Returns a setting for tests from the environment: the triangles of a cell, or a sweep of a mesh that fits in memory.
 * 0: not set. */
static double test_setting(const char *name)
{
#ifdef PTRIANGLE_TESTS
    const char *text = getenv(name);
    return text ? fmax(strtod(text, NULL), 0) : 0;
#else
    (void)name;
    return 0;
#endif
}

/* --- refinement */

/* A rank knows only the triangles of its own part. */
static void report_reached(const struct program *p, int64_t triangles)
{
    const bool in_parts = p->run.settings.n_ranks > 1;
    interrupt_reached(triangles, in_parts ? " triangles in the part of the first task" : " triangles");
}

static void follow_progress(void *user, const struct par_place *place)
{
    struct program *p = user;
    interrupt_stage(place->phase == PAR_NUMBERING ? "numbering" : "refining");
    if (place->phase != PAR_NUMBERING)
        report_reached(p, place->triangles);
    progress_step(&p->progress, place);
}

static struct par_options options_of(struct program *p)
{
    const struct run *run = &p->run;
    const struct tri_switches *s = &run->arguments->switches;
    struct par_options options = par_defaults();
    options.team = &p->team;
    options.by_block = p->options.by_block;
    options.cell_triangles = test_setting("PTRIANGLE_TEST_BLOCK");
    options.progress = follow_progress;
    options.progress_user = p;
    options.figure = &run->input.pslg;
    options.region_column = tri_switches_grid(s, &run->mesh, &run->input.pslg, &run->input.elements).regions;
    options.sweep = run->plan.swept;
    bool bounded = p->options.memory > 0 || (run->plan.swept && !p->launch.carrier);
    if (bounded && run->plan.memory < HUGE_VAL)
        options.memory = (int64_t)run->plan.memory;
    options.count_remaining = !s->quiet || p->options.report;
    options.scratch = p->scratch;
    options.checkpoint = p->restart.wanted ? &p->restart.checkpoint : NULL;
    return options;
}

/* Returns how many vertices, triangles or segments (0, 1, 2) all ranks have handed out. */
static int64_t handed_out(const struct program *p, int which)
{
    return p->joint.together ? p->joint.total[which] : p->streams.taken[which];
}

static enum tri_status refine_with(struct program *p, const struct par_options *options)
{
    p->n_before = p->run.mesh.n_vertices;
    progress_begin(&p->progress, p->run.mesh.n_triangles, p->run.plan.triangles, p->run.settings.threads);
    enum tri_status status = par_refine(&p->run.mesh, &p->run.options.quality, options, &p->schedule, p->run.error);
    if (status)
        progress_drop(&p->progress);
    else
        progress_end(&p->progress, options->sweep ? handed_out(p, 1) : p->run.mesh.n_triangles,
                     options->sweep ? 0 : p->schedule.seconds_number);
    p->refined = true;
    if (status == TRI_STOPPED && p->restart.wanted && p->restart.checkpoint.saved > 0)
        interrupt_reached(p->restart.checkpoint.manifest.triangles, " triangles"); /* triangles of all ranks */
    else if (status == TRI_STOPPED && !options->sweep)
        report_reached(p, p->run.mesh.n_triangles);
    return status;
}

/* Refinement keeps the number of holes and components, so vertices - edges + triangles does not change. Every boundary
 * edge is a subsegment. */
static void count_streamed(struct program *p, const struct tri_counts *before)
{
    struct tri_counts *c = &p->run.counts;
    c->vertices = handed_out(p, 0) - p->run.unused.n;
    c->triangles = handed_out(p, 1);
    c->subsegments = handed_out(p, 2);
    c->edges = c->vertices + c->triangles - (before->vertices - before->edges + before->triangles);
    c->exterior = 2 * c->edges - 3 * c->triangles;
    c->interior = c->subsegments - c->exterior;
}

/* Returns the bytes of tiles that may wait for the disk. */
static int64_t waiting_bytes(const struct program *p)
{
    return (int64_t)fmin(fmax(p->run.plan.memory / 32, 0x1p20), 0x1p26);
}

/* Shows the first rank's files, which only that rank knows. */
static void share_streams(struct program *p)
{
    struct joint_files *joint = &p->joint;
    joint->text_options = p->streams.text_options;
    joint->text = p->streams.text ? p->streams.sink[p->streams.n] : joint->text;
    for (int i = 0; i < p->streams.n; i++) {
        const struct stream *s = &p->streams.stream[i];
        joint->h5[i] = (struct joint_h5){.writer = s->writer, .sink = p->streams.sink[i], .output = s->options.file};
    }
}

/* Finds out whether all ranks write the files. They do not if a format needs the whole mesh. Collective. */
static enum tri_status join_files(struct program *p, enum tri_status status)
{
    const bool ends_at_once = !p->options.write_partial && !long_options_state(&p->options);
    p->joint = (struct joint_files){.carrier = p->launch.carrier, .scratch = p->scratch,
                                    .no_sync = p->options.no_sync, .orphans = p->run.unused,
                                    .stop = ends_at_once ? interrupt_stop() : NULL,
                                    .text_options = {.base = p->run.input.base, .figure = &p->run.input.pslg,
                                                     .markers = !p->run.arguments->switches.no_markers}};
    if (!status && p->launch.rank == 0)
        share_streams(p);
    const bool wanted = p->streams.n_exports == 0 && p->launch.carrier->n_ranks > 1;
    return joint_files_open(&p->joint, wanted, status, p->run.error);
}

static enum tri_status refine_into(struct program *p, const struct tri_sink *sink)
{
    struct par_options options = options_of(p);
    options.carrier = p->launch.carrier;
    options.sink = sink;
    return refine_with(p, &options);
}

/* Refines on several ranks, with all tiles sent to the sink of the first. A queue before that sink lets it receive
 * tiles without waiting for the disk. to: the sink, on that rank. */
static enum tri_status refine_through_first(struct program *p, const struct tri_sink *to)
{
    struct par_queue queue;
    struct tri_sink queued;
    struct par_relay relay = {.carrier = p->launch.carrier};
    if (to && !par_queue_begin(&queue, to, waiting_bytes(p)))
        return tri_fail(p->run.error, TRI_NO_MEMORY, NULL, 0, "out of memory for a queue of tiles");
    if (to)
        queued = par_queue_sink(&queue);
    relay.to = to ? &queued : NULL;
    if (p->options.memory > 0)
        relay.room = relay.most_bytes = (size_t)waiting_bytes(p);
    const struct tri_sink relayed = par_relay_sink(&relay);
    enum tri_status status = par_relay_finish(&relay, refine_into(p, &relayed), p->run.error);
    if (to)
        par_queue_free(&queue);
    return status;
}

/* Refines on several ranks. to: the sink of rank 0 for all tiles, if not all ranks write. */
static enum tri_status refine_on_ranks(struct program *p, const struct tri_sink *to, enum tri_status status)
{
    status = join_files(p, status);
    const struct tri_sink joint = joint_files_sink(&p->joint);
    if (!status)
        status = p->joint.together ? refine_into(p, &joint) : refine_through_first(p, to);
    return joint_files_close(&p->joint, status, p->run.error);
}

/* Reports data that did not fit in memory, or a mesh that could not be swept. */
static void report_parking(const struct program *p)
{
    if (p->schedule.parked > 0)
        console_say(&p->run.console, "%s parked in %s: %s.\n",
                    p->schedule.way == PAR_SWEPT ? "What did not fit in memory was" : "The mesh was not swept, and was",
                    p->scratch, tri_size_text((double)p->schedule.parked).text);
}

/* Refines, and writes finished tiles at the same time. */
static enum tri_status sweep(struct program *p)
{
    struct run *run = &p->run;
    struct tri_counts before;
    const struct tri_sink streams = streams_sink(&p->streams);
    enum tri_status status = tri_count_mesh(&before, &run->mesh, NULL, run->error);
    status = status ? status : streams_open(&p->streams, run);
    if (p->launch.carrier)
        status = refine_on_ranks(p, &streams, status);
    else if (!status)
        status = refine_into(p, &streams);
    streams_close(&p->streams);
    report_parking(p);
    if (!status)
        count_streamed(p, &before);
    run->remain_known = !status && p->schedule.remain_known;
    memcpy(run->remain, p->schedule.remain, sizeof run->remain);
    return status;
}

/* A stop is no failure for other ranks if the current mesh will be written. */
static enum tri_status report_ranks(struct program *p, enum tri_status status)
{
    const bool is_kept = status == TRI_STOPPED && p->options.write_partial;
    enum tri_status shared = rank_report_gather(&p->ranks, p->launch.carrier, &p->schedule, is_kept ? TRI_OK : status,
                                                p->run.error);
    return shared ? shared : status;
}

/* Refines according to the plan. user is the struct program; only user and report are used. */
static enum tri_status refine(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report, struct tri_error *error)
{
    struct program *p = user;
    struct run *run = &p->run;
    enum tri_status status = run_refine_begin(run);
    (void)quality, (void)error;
    if (status)
        return status;
    if (run->plan.swept) {
        status = p->launch.rank > 0 ? refine_on_ranks(p, NULL, TRI_OK) : sweep(p);
        tri_mesh_free(mesh); /* the rest is no valid mesh */
    } else if (p->launch.rank == 0) { /* makes the whole mesh, and writes checkpoints like a single task */
        struct par_options options = options_of(p);
        options.park = run->plan.filed ? &p->park : NULL;
        status = refine_with(p, &options);
        report_parking(p);
        if (!status)
            progress_stage(&p->progress, "writing");
    }
    *report = p->schedule.total;
    return run_refine_end(run, p->launch.carrier ? report_ranks(p, status) : status);
}

/* --- output */

/* Makes room for this number of bytes beside a mesh that was not swept: moves parts of the mesh to files if
 * necessary. */
static enum tri_status make_room(struct program *p, double bytes)
{
    const enum tri_status status = par_park_expect(p->park, &p->run.mesh, (size_t)bytes, p->run.error);
    if (!p->park)
        return status;
    p->schedule.parked = par_park_bytes(p->park);
    if (p->schedule.parked > 0 && p->schedule.way == PAR_IN_MEMORY) {
        p->schedule.way = PAR_PARKED;
        report_parking(p);
    }
    return status;
}

/* Writes the tiles of a mesh that is complete. */
static enum tri_status write_streams(struct program *p)
{
    struct run *run = &p->run;
    if (p->options.n_streams == 0)
        return TRI_OK;
    enum tri_status status = make_room(p, estimate_streams(run, run->mesh.n_triangles));
    if (!status && !run->unused.kept)
        status = run_find_unused(run);
    status = status ? status : streams_open(&p->streams, run);
    const int32_t n_before = p->refined ? p->n_before : run->mesh.n_vertices;
    status = status ? status : streams_hand_out(&p->streams, &run->mesh, n_before);
    streams_close(&p->streams);
    return status;
}

/* --- blocks and report */

enum { BLOCK_ROW_BYTES = 48 };

struct blocks {
    const struct par_report *report;
    const struct tri_mesh *mesh;
};

static char *block_row(const void *user, int64_t i, char *at)
{
    const struct blocks *blocks = user;
    int phase;
    int32_t block = par_block_of(blocks->report, blocks->mesh, (int32_t)i, &phase);
    at = tri_print_integer(at, block, 0);
    *at++ = ' ';
    at = tri_print_integer(at, phase, 0);
    *at++ = '\n';
    return at;
}

/* Writes a line "block phase" for each triangle in the order of the .ele file: par_block_of, phases from 0; -1 -1:
 * none. */
static enum tri_status write_blocks(const struct program *p)
{
    const struct run *run = &p->run;
    struct blocks blocks = {&p->schedule, &run->mesh};
    struct tri_output *output;
    enum tri_status status = interrupt_open(run->outputs, p->options.blocks, &output, run->error);
    return status ? status : tri_write_table(output, 0, run->mesh.n_triangles, BLOCK_ROW_BYTES, block_row, &blocks,
                                             NULL, run->error);
}

/* Counts the triangles that violate the bounds, for the report. */
static void count_remaining(struct program *p)
{
    const struct run *run = &p->run;
    if (!p->refined || p->schedule.remain_known || run->plan.swept)
        return;
    if (run->remain_known)
        memcpy(p->schedule.remain, run->remain, sizeof run->remain);
    else
        tri_count_bad(&run->mesh, &run->options.quality, &run->report.quality, run->settings.executor,
                      p->schedule.remain);
    p->schedule.remain_known = true;
}

/* Writes all requested output except the mesh. */
static enum tri_status write_further(struct program *p)
{
    const struct run *run = &p->run;
    char text[96];
    snprintf(text, sizeof text, "done in %.2f s", run->time.total);
    progress_stage(&p->progress, text);
    enum tri_status status = run->plan.swept ? TRI_OK : write_streams(p);
    if (!status && p->options.blocks)
        status = write_blocks(p);
    if (status || !p->options.report)
        return status;
    count_remaining(p);
    return report_write(run, p->refined ? &p->schedule : NULL, &p->ranks);
}

/* Checks the mesh (-C). The checker must keep to the rest of a memory bound; pages of a mesh in files need a part of
 * it. */
static enum tri_status check(struct program *p)
{
    const double OF_FILES = 0.75;
    const struct run *run = &p->run;
    enum tri_status status = make_room(p, self_check_least_bytes(&run->mesh));
    const double left = run->mesh.storage ? OF_FILES * plan_memory_left(run) : plan_memory_left(run);
    return status ? status : self_check(run, p->options.memory > 0 ? fmax(left, 1) : 0);
}

static enum tri_status write_all(struct program *p)
{
    struct run *run = &p->run;
    run_write_begin(run);
    enum tri_status status = run->plan.swept ? TRI_OK : make_room(p, run_write_bytes(run));
    status = status ? status : run_write_mesh(run);
    status = status ? status : run_print_statistics(run);
    if (!status && run->arguments->switches.check)
        status = check(p);
    status = status ? status : write_further(p);
    return status ? status : console_flush(run->error);
}

/* --- the run */

/* Makes all ranks return the same status with the same error. */
static enum tri_status agree_on_status(struct program *p, enum tri_status status)
{
    return p->launch.carrier ? par_agree(p->launch.carrier, status, p->run.error) : status;
}

/* Reads the input, on one of several ranks. */
static enum tri_status read_input(struct program *p)
{
    const enum tri_status status = run_read(&p->run);
    return p->launch.carrier ? shared_input(p->launch.carrier, &p->run, status, p->run.error) : status;
}

/* Writes the output. Everything that can fail comes before the commit, including printing and the work of other
 * ranks. */
static enum tri_status write_output(struct program *p)
{
    if (p->launch.rank > 0)
        return agree_on_status(p, TRI_OK);
    return run_commit(&p->run, agree_on_status(p, write_all(p)));
}

/* Makes the mesh, from the input file to the output files. A failed rank joins the agreement at which the others
 * wait. */
static int make_mesh(struct program *p)
{
    struct run *run = &p->run;
    enum tri_status status = run_begin(run);
    status = status ? status : read_input(p);
    status = status ? status : run_make(run);
    if (!status && !p->options.dry_run)
        status = write_output(p);
    return run_end(run, status ? agree_on_status(p, status) : TRI_OK);
}

/* --- arguments */

/* Applies --output, which overrides -I. A suffix of Triangle's files is removed. */
static enum tri_status name_output(struct arguments *arguments, const char *base, struct tri_error *error)
{
    if (!base || !arguments->file)
        return TRI_OK;
    char *output = tri_name(base, tri_format_base(base), "");
    if (!output)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    free(arguments->output);
    arguments->output = output;
    arguments->switches.no_iteration = false;
    return TRI_OK;
}

static enum tri_status refuse_second_order(const char *path, const char *format, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, path, 0, "files of %s cannot hold second-order triangles (-o2)", format);
}

/* Checks that all requested files can hold the requested data. */
static enum tri_status check_formats(const struct long_options *options, const struct tri_switches *switches,
                                     struct tri_error *error)
{
    if (!switches->second_order)
        return TRI_OK;
    if (options->n_streams > 0)
        return refuse_second_order(options->streams[0], "HDF5", error);
    for (int i = 0; i < options->n_exports; i++) {
        const struct tri_format *format = tri_format_of(options->exports[i]);
        if (!format->second_order)
            return refuse_second_order(options->exports[i], format->name, error);
    }
    return TRI_OK;
}

static enum tri_status take_words(struct program *p, struct arguments *arguments, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 1; !status && i < arguments->argc; i++) {
        const char *word = arguments->argv[i];
        if (size_options_take(&arguments->sizes, &arguments->switches, arguments->argc, arguments->argv, &i, error))
            status = error->status;
        else if (strncmp(word, "--", 2) == 0)
            status = long_options_take(&p->options, &arguments->switches, arguments->argc, arguments->argv, &i, error);
        else
            arguments_word(arguments, word);
    }
    if (status || p->options.version || p->options.help || arguments->switches.help)
        return status;
    status = long_options_check(&p->options, error);
    status = status ? status : size_options_end(&arguments->sizes, &arguments->switches, error);
    status = status ? status : arguments_end(arguments, error);
    status = status ? status : check_formats(&p->options, &arguments->switches, error);
    status = status ? status : name_output(arguments, p->options.output, error);
    if (!status && p->options.report && arguments->file)
        status = report_check(error);
    return status;
}

/* --- the whole program */

/* Returns --scratch, TMPDIR, or the folder of the output; malloc'ed. */
static char *scratch_of(const struct long_options *options, const struct arguments *arguments)
{
    const char *asked = options->scratch ? options->scratch : getenv("TMPDIR");
    const char *output = options->n_streams > 0 ? options->streams[0] : arguments->output;
    const size_t folder = output ? tri_path_folder_length(output) : 0;
    if (asked && *asked)
        return tri_joined(asked, "");
    return folder > 0 ? tri_name(output, folder, "") : tri_joined(".", "");
}

/* Converts a share of the memory to bytes. If the memory is unknown, a share is an error. */
static enum tri_status resolve_memory(struct long_options *options, struct tri_error *error)
{
    const double total = options->memory_share > 0 ? tri_memory_total() : 0;
    if (total == HUGE_VAL)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "--memory: the system does not tell how much memory there is; "
                        "give a size such as 4G");
    options->memory = options->memory_share > 0 ? options->memory_share * total : options->memory;
    return TRI_OK;
}

static struct run_settings settings_of(const struct program *p)
{
    const struct par_carrier *carrier = p->launch.carrier;
    const bool goes_on = p->restart.wanted && par_checkpoint_has_sweep(&p->restart.checkpoint);
    return (struct run_settings){.options = &p->options, .executor = &p->executor, .threads = p->team.threads,
                                 .schedule_needs = schedule_needs, .n_ranks = carrier ? carrier->n_ranks : 0,
                                 .written_elsewhere = p->launch.rank > 0,
                                 .always_sweep = goes_on || carrier || test_setting("PTRIANGLE_TEST_SWEEP") > 0};
}

static int run_program(struct program *p, const struct arguments *arguments, struct tri_error *error)
{
    struct tri_error own = {0};
    p->team = (struct par_team){.threads = par_threads(long_options_threads(&p->options), true)};
    p->executor = par_executor(&p->team);
    p->progress = progress_start(PROGRAM, p->options.progress, arguments->switches.quiet);
    p->options.scratch = p->scratch = scratch_of(&p->options, arguments);
    if (!p->scratch) {
        tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
        console_error(&(struct console){.program = PROGRAM}, error);
        return EXIT_FAILURE;
    }
    if (arguments->file) {
        progress_stage(&p->progress, "reading and triangulating");
        p->run = run_new(PROGRAM, arguments, &own);
        p->run.settings = settings_of(p);
        p->run.options.refine_call = refine;
        p->run.options.refine_user = p;
        return make_mesh(p);
    }
    help_usage(PROGRAM);
    puts("  --threads N  --max-area X  --min-angle X  --output BASE|FILE.h5|...  --report FILE  --blocks FILE"
         "  --numbering curve|blocks"
         "  --placement lattice|front|classic\n"
         "  --size H|FILE  --size-near MARKER:H[,GROWTH]  --gradation G  --min-size H  --max-size H\n"
         "  --elements-across N  --per-circle N  --optimise N\n"
         "  --dry-run  --memory SIZE  --checkpoint DIR  --resume DIR  --time-limit T  --write-partial  --progress"
         "  --help");
    return EXIT_SUCCESS;
}

static void free_program(struct program *p)
{
    par_park_close(p->park, NULL); /* the mesh was freed with its run */
    par_team_end(&p->team);
    par_report_free(&p->schedule);
    free(p->scratch);
    free(p->ranks.number);
}

/* Runs the program after the arguments have been read. */
static int run_options(struct program *p, const struct arguments *arguments, struct tri_error *error)
{
    if (p->options.version) {
        printf("%s %s\n", PROGRAM, PTRIANGLE_VERSION);
        return EXIT_SUCCESS;
    }
    if (p->options.help || arguments->switches.help) {
        help_full(PROGRAM, "on all cores", long_options_help);
        return EXIT_SUCCESS;
    }
    if (!resolve_memory(&p->options, error) && arguments->file)
        restart_open(&p->restart, &p->options, PROGRAM, arguments, p->launch.carrier, error);
    if (error->status) {
        console_error(&(struct console){.program = PROGRAM}, error);
        return EXIT_FAILURE;
    }
    /* a single task resumes a run of several */
    const bool alone = !p->launch.carrier && p->restart.wanted && par_checkpoint_has_ranks(&p->restart.checkpoint);
    int64_t room[PAR_ROOM];
    struct par_carrier one = par_carrier_alone(room);
    p->launch.carrier = alone ? &one : p->launch.carrier;
    int code = launch_agree(&p->launch, run_program(p, arguments, error), error);
    p->launch.carrier = alone ? NULL : p->launch.carrier;
    restart_close(&p->restart, code);
    return code;
}

const int program_trouble = EXIT_FAILURE;
const char program_version[] = PTRIANGLE_VERSION;

int program_main(int argc, char **argv)
{
    static struct program program;
    struct tri_error error = {0};
    const struct console console = {.program = PROGRAM};
    console_open();
    struct arguments arguments = arguments_begin(argc, argv);
    int code = EXIT_FAILURE;
    bool joined = !launch_join(&program.launch, &error);
    if (!joined || take_words(&program, &arguments, &error))
        console_error(&console, &error);
    else
        code = run_options(&program, &arguments, &error);
    free_program(&program);
    arguments_free(&arguments);
    code = console_close(&console) ? code : EXIT_FAILURE;
    return joined ? launch_leave(&program.launch, code, &error) : code;
}
