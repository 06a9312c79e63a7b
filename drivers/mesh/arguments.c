/* The command line, word by word, and the rules of file names. */
#include "drivers/mesh/arguments.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/text/names.h"

/* Adds 1 to the decimal number in text[0 .. n), n > 0, which has no leading zeros; text has room for one more digit. */
static void increment(char *text, size_t n)
{
    size_t i = n;
    while (i > 0 && text[i - 1] == '9')
        text[--i] = '0';
    if (i > 0) {
        text[i - 1]++;
        return;
    }
    memmove(text + 1, text, n + 1);
    text[0] = '1';
}

char *next_iteration(const char *name)
{
    const char *slash = strrchr(name, '/'), *dot = strrchr(slash ? slash : name, '.');
    size_t digits = dot ? strspn(dot + 1, "0123456789") : 0;
    if (digits == 0 || dot[1 + digits] != 0)
        return tri_joined(name, ".1");
    char *next = tri_joined(name, "0"); /* one digit more than there was */
    if (!next)
        return NULL;
    char *number = next + (dot + 1 - name);
    while (digits > 1 && *number == '0') {
        memmove(number, number + 1, digits + 1);
        digits--;
    }
    number[digits] = 0;
    increment(number, digits);
    return next;
}

struct arguments arguments_begin(int argc, char **argv)
{
    return (struct arguments){argc, argv, tri_switches_none(), NULL, NULL, NULL};
}

void arguments_word(struct arguments *arguments, const char *word)
{
    if (word[0] == '-')
        tri_switches_add(&arguments->switches, word);
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

/* A suffix says what the input is. */
static void apply_suffix(char *name, struct tri_switches *switches)
{
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
    arguments->input = tri_joined(arguments->file, "");
    if (arguments->input) {
        apply_suffix(arguments->input, &arguments->switches);
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
