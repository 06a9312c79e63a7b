/* ptriangle: the mesh generator on all cores, with the command line, the files and the printed lines of Triangle, and
 * long options. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/blocks_file.h"
#include "drivers/console.h"
#include "drivers/help.h"
#include "drivers/interrupt.h"
#include "drivers/long_options.h"
#include "drivers/progress.h"
#include "drivers/report_json.h"
#include "drivers/resources.h"
#include "drivers/run.h"
#include "sched/schedule.h"
#include "sched/threads.h"
#include "triangle/estimate.h"
#include "triangle/text/write.h"

static const char PROGRAM[] = PTRIANGLE_NAME;

/* What the hooks share. */
struct program {
    struct long_options options;
    int threads;
    struct progress progress;
    bool refined;              /* the schedule has run: its report is filled */
    struct par_report schedule;
};

/* Tests run the schedule on small inputs: a build with tests takes the triangles in a cell from the environment. */
static double cell_for_tests(void)
{
#ifdef PTRIANGLE_TESTS
    const char *text = getenv("PTRIANGLE_TEST_BLOCK");
    long triangles = text ? strtol(text, NULL, 10) : 0;
    return triangles > 0 ? (double)triangles : 0;
#else
    return 0;
#endif
}

/* --- hooks */

static void follow(void *user, int round, int phase, int64_t triangles)
{
    struct program *p = user;
    interrupt_stage(phase == PAR_NUMBERING ? "numbering" : "refining");
    progress_step(&p->progress, round, phase, triangles);
}

static enum tri_status refine(void *user, const struct run_plan *plan, struct tri_mesh *mesh,
                              const struct tri_refine_options *quality, struct tri_refine_report *report,
                              struct tri_error *error)
{
    struct program *p = user;
    (void)plan;
    struct par_options options = par_defaults();
    options.threads = p->threads;
    options.by_block = p->options.by_block;
    options.cell_triangles = cell_for_tests();
    options.progress = follow;
    options.progress_user = p;
    progress_begin(&p->progress, mesh->n_triangles, p->threads);
    enum tri_status status = par_refine(mesh, quality, &options, &p->schedule, error);
    progress_end(&p->progress, mesh->n_triangles, p->schedule.seconds_number);
    if (!status)
        progress_stage(&p->progress, "writing");
    *report = p->schedule.total;
    p->refined = true;
    return status;
}

static double estimate(void *user, const struct tri_mesh *mesh, const struct tri_refine_options *quality)
{
    (void)user;
    return tri_estimate(mesh, quality);
}

static enum tri_status write_further(void *user, const struct run *run, struct tri_output_set *set,
                                     struct tri_error *error)
{
    struct program *p = user;
    char text[96];
    snprintf(text, sizeof text, "done in %.2f s", run->total_seconds);
    progress_stage(&p->progress, text);
    enum tri_status status = TRI_OK;
    if (p->options.blocks)
        status = blocks_write(p->options.blocks, set, &p->schedule, &run->mesh, error);
    if (status || !p->options.report)
        return status;
    return report_write(p->options.report, set, run, p->refined ? &p->schedule : NULL, p->threads, error);
}

/* --- arguments */

/* --output names the files whatever -I says. */
static enum tri_status name_output(struct arguments *arguments, const char *base, struct tri_error *error)
{
    if (!base || !arguments->file)
        return TRI_OK;
    char *output = joined(base, "");
    if (!output)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    free(arguments->output);
    arguments->output = output;
    arguments->switches.no_iteration = false;
    return TRI_OK;
}

static enum tri_status take_words(struct program *p, struct arguments *arguments, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 1; !status && i < arguments->argc; i++) {
        const char *word = arguments->argv[i];
        if (strncmp(word, "--", 2) == 0)
            status = long_options_take(&p->options, &arguments->switches, arguments->argc, arguments->argv, &i, error);
        else
            arguments_word(arguments, word);
    }
    if (status || p->options.version || p->options.help || arguments->switches.help)
        return status;
    status = arguments_end(arguments, error);
    status = status ? status : name_output(arguments, p->options.output, error);
    if (!status && p->options.report && arguments->file)
        status = report_check(error);
    return status;
}

/* --- all together */

static void add_further(struct file_names *names, const char *name)
{
    if (name)
        names->name[names->n++] = name;
}

/* Bytes that the process may take; 0: whatever there is. */
static double memory_of(const struct long_options *options)
{
    double total = options->memory_share > 0 ? resources_memory_total() : 0;
    return options->memory_share > 0 ? options->memory_share * (total < HUGE_VAL ? total : 0) : options->memory;
}

static int run_program(struct program *p, const struct arguments *arguments)
{
    p->threads = par_threads(long_options_threads(&p->options), true);
    p->progress = progress_start(PROGRAM, p->options.progress, arguments->switches.quiet);
    const struct tri_executor executor = par_executor(&p->threads);
    const struct long_options *o = &p->options;
    struct run_hooks hooks = {.program = PROGRAM, .executor = &executor, .refine = refine, .estimate = estimate,
                              .threads = p->threads, .write = write_further, .user = p,
                              .limits = {o->time_limit, o->write_partial, o->dry_run, memory_of(o), o->scratch}};
    for (int i = 0; i < o->n_exports; i++)
        add_further(&hooks.exports, o->exports[i]);
    hooks.exports_alone = o->n_exports > 0 && !o->output;
    add_further(&hooks.further, o->report && !report_is_printed(o->report) ? o->report : NULL);
    add_further(&hooks.further, o->blocks);
    if (arguments->file)
        progress_stage(&p->progress, "reading and triangulating");
    int code = run_arguments(arguments, &hooks);
    if (!arguments->file)
        puts("  --threads N  --max-area X  --min-angle X  --output BASE|FILE.vtu|...  --report FILE  --blocks FILE"
             "  --numbering curve|blocks\n"
             "  --dry-run  --time-limit T  --write-partial  --progress  --help");
    par_report_free(&p->schedule);
    return code;
}

int main(int argc, char **argv)
{
    struct program program = {0};
    struct tri_error error = {0};
    const struct console console = {.program = PROGRAM};
    console_open();
    struct arguments arguments = arguments_begin(argc, argv);
    int code = EXIT_SUCCESS;
    if (take_words(&program, &arguments, &error)) {
        console_error(&console, &error);
        code = EXIT_FAILURE;
    } else if (program.options.version) {
        printf("%s %s\n", PROGRAM, PTRIANGLE_VERSION);
    } else if (program.options.help || arguments.switches.help) {
        help_full(PROGRAM, "on all cores", long_options_help);
    } else {
        code = run_program(&program, &arguments);
    }
    arguments_free(&arguments);
    return console_close(&console) ? code : EXIT_FAILURE;
}
