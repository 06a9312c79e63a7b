/* triangle: the mesh generator on one core, with the command line, the files and the printed lines of Triangle. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/stages.h"
#include "drivers/mesh/summary.h"
#include "triangle/base/system.h"

static const char PROGRAM[] = PTRIANGLE_NAME;

/* Triangle has no long options. It would read the letters of --min-angle as switches, which is never intended. */
static bool is_long(const char *word) { return strncmp(word, "--", 2) == 0 && isalpha((unsigned char)word[2]); }

static int take_long(const char *word)
{
    const struct console console = {.program = PROGRAM};
    struct tri_error error = {0};
    int code = EXIT_SUCCESS;
    if (strcmp(word, "--version") == 0) {
        printf("%s %s\n", PROGRAM, PTRIANGLE_VERSION);
    } else if (strcmp(word, "--help") == 0) {
        help_full(PROGRAM, "on one core", NULL);
    } else {
        tri_fail(&error, TRI_BAD_INPUT, NULL, 0, "%.60s: no such option; ptriangle has more long options", word);
        console_error(&console, &error);
        code = EXIT_FAILURE;
    }
    return console_close(&console) ? code : EXIT_FAILURE;
}

static enum tri_status refine(void *user, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report, struct tri_error *error)
{
    struct run *run = user;
    enum tri_status status = run_refine_begin(run);
    (void)quality; /* unchanged since the lengths were made */
    return status ? status : run_refine_end(run, tri_refine(mesh, &run->options.quality, report, error));
}

static enum tri_status write_output(struct run *run)
{
    run_write_begin(run);
    enum tri_status status = run_write_mesh(run);
    status = status ? status : run_print_statistics(run);
    if (!status && run->arguments->switches.check)
        status = self_check(run, 0);
    status = status ? status : console_flush(run->error);
    return run_commit(run, status);
}

/* Makes the mesh, from the input file to the output files. */
static int make_mesh(const struct arguments *arguments)
{
    static const struct long_options none;
    struct tri_error error = {0};
    struct run run = run_new(PROGRAM, arguments, &error);
    run.settings.options = &none;
    run.options.refine_call = refine;
    run.options.refine_user = &run;
    enum tri_status status = run_begin(&run);
    status = status ? status : run_read(&run);
    status = status ? status : run_make(&run);
    status = status ? status : write_output(&run);
    return run_end(&run, status);
}

static int carry_out(const struct arguments *arguments)
{
    const struct console console = {.program = PROGRAM};
    if (arguments->file && !arguments->switches.help)
        return make_mesh(arguments);
    if (arguments->switches.help)
        help_full(PROGRAM, "on one core", NULL);
    else
        help_usage(PROGRAM);
    return console_close(&console) ? EXIT_SUCCESS : EXIT_FAILURE;
}

int main(int argc, char **given)
{
    char **argv = tri_arguments(argc, given);
    struct arguments arguments = arguments_begin(argc, argv);
    struct tri_error error = {0};
    int code = EXIT_FAILURE;
    console_open();
    for (int i = 1; !error.status && i < argc; i++) {
        if (size_options_take(&arguments.sizes, &arguments.switches, argc, argv, &i, &error))
            continue;
        if (is_long(argv[i]))
            return take_long(argv[i]);
        arguments_word(&arguments, argv[i]);
    }
    if (error.status || size_options_end(&arguments.sizes, &arguments.switches, &error) ||
        arguments_end(&arguments, &error))
        console_error(&(struct console){.program = PROGRAM}, &error);
    else
        code = carry_out(&arguments);
    arguments_free(&arguments);
    return code;
}
