/* triangle: the mesh generator on one core, with the command line, the files and the printed lines of Triangle. */
#include <ctype.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/stages.h"

static const char PROGRAM[] = PTRIANGLE_NAME;

/* Triangle has no long options, and would take the letters of --min-angle for switches, which nobody means. */
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
        tri_fail(&error, TRI_BAD_INPUT, NULL, 0, "%.60s: no such option; it is ptriangle that has long ones", word);
        console_error(&console, &error);
        code = EXIT_FAILURE;
    }
    return console_close(&console) ? code : EXIT_FAILURE;
}

int main(int argc, char **argv)
{
    static const struct long_options none;
    const struct run_hooks hooks = {.program = PROGRAM, .options = &none};
    struct arguments arguments = arguments_begin(argc, argv);
    struct tri_error error = {0};
    int code = EXIT_FAILURE;
    console_open();
    for (int i = 1; i < argc; i++) {
        if (is_long(argv[i]))
            return take_long(argv[i]);
        arguments_word(&arguments, argv[i]);
    }
    if (arguments_end(&arguments, &error))
        console_error(&(struct console){.program = PROGRAM}, &error);
    else
        code = run_arguments(&arguments, &hooks);
    arguments_free(&arguments);
    return code;
}
