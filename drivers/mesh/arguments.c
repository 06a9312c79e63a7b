/* The command line, word by word, and the rules of file names. */
#include "drivers/mesh/arguments.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/text/names.h"

char *next_iteration(const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(slash ? slash : name, '.'), *digits = dot ? dot + 1 : name;
    size_t n = dot ? strspn(digits, "0123456789") : 0;
    if (n == 0 || digits[n] != 0)
        return tri_joined(name, ".1");
    for (; n > 1 && *digits == '0'; n--)
        digits++;
    size_t kept = n; /* but for nines at the end, which become zeros */
    while (kept > 0 && digits[kept - 1] == '9')
        kept--;
    char *next = malloc(strlen(name) + 2), *at = next;
    if (!next)
        return NULL;
    at = (char *)memcpy(at, name, (size_t)(dot + 1 - name)) + (dot + 1 - name);
    memcpy(at, kept > 0 ? digits : "0", kept > 0 ? kept : 1);
    at += kept > 0 ? kept : 1;
    at[-1]++;
    memset(at, '0', n - kept);
    at[n - kept] = 0;
    return next;
}

struct arguments arguments_begin(int argc, char **argv)
{
    return (struct arguments){argc, argv, tri_switches_none(), NULL, NULL, NULL, NULL, NULL};
}

void arguments_word(struct arguments *arguments, const char *word)
{
    if (word[0] == '-')
        tri_switches_add(&arguments->switches, word);
    else if (arguments->file)
        arguments->further = word;
    else
        arguments->file = word;
}

static bool cut_suffix(char *name, const char *suffix)
{
    size_t n = strlen(name), m = strlen(suffix);
    if (n < m || strcmp(name + n - m, suffix) != 0)
        return false;
    name[n - m] = 0;
    return true;
}

/* A suffix says what the input is; mesh.14, if there is no such file, is a base. */
static void apply_suffix(struct arguments *arguments)
{
    char *name = arguments->input;
    struct tri_switches *switches = &arguments->switches;
    const struct tri_format *format = tri_format_of(name);
    if (format && (tri_path_allows(name, TRI_THERE) || !tri_name_ends(name, ".14"))) {
        arguments->format = format;
        name[strlen(name) - strlen(format->suffix)] = 0;
        switches->mesh = switches->segments = true;
    }
    if (cut_suffix(name, ".node"))
        return;
    if (cut_suffix(name, ".poly"))
        switches->segments = true;
    else if (cut_suffix(name, ".ele"))
        switches->mesh = true;
    else if (cut_suffix(name, ".area"))
        switches->mesh = switches->area_lists = true;
}

enum tri_status arguments_end(struct arguments *arguments, struct tri_error *error)
{
    if (!arguments->file)
        return TRI_OK;
    if (arguments->further)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "one input file at a time, not both %.80s and %.80s; a number "
                        "follows its switch in one word: -q30", arguments->file, arguments->further);
    arguments->input = tri_joined(arguments->file, "");
    if (arguments->input) {
        apply_suffix(arguments);
        arguments->output = arguments->switches.no_iteration ? tri_joined(arguments->input, "")
                                                             : next_iteration(arguments->input);
    }
    return arguments->output ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
}

void arguments_free(struct arguments *arguments)
{
    free(arguments->input);
    free(arguments->output);
    arguments->input = arguments->output = NULL;
}
