/* The command line of Triangle: words of switches, one input file, and what files are called because of them. */
#ifndef DRIVERS_MESH_ARGUMENTS_H
#define DRIVERS_MESH_ARGUMENTS_H

#include "drivers/mesh/size_options.h"
#include "triangle/base/status.h"
#include "triangle/dropin/switches.h"
#include "triangle/text/formats.h"

struct arguments {
    int argc; /* the words as given, for the comment in every file */
    char **argv;
    struct tri_switches switches;
    struct size_options sizes; /* --size and so on; all 0: nothing */
    const char *file, *further; /* the first word that is no switch, and the last of several; NULL: there was none */
    const struct tri_format *format; /* of the file, a mesh that another program reads as well; NULL: Triangle's */
    char *input;      /* file without its suffix; suffixes are appended to this */
    char *output;     /* the same for what is written */
};

struct arguments arguments_begin(int argc, char **argv);

/* Takes one word: switches if it begins with a dash, otherwise the input file. */
void arguments_word(struct arguments *arguments, const char *word);

/* Once all words are in: lets the file's suffix set its switches, and makes the names. TRI_BAD_INPUT: a second file, or
 * a number apart from its switch. TRI_NO_MEMORY. */
enum tri_status arguments_end(struct arguments *arguments, struct tri_error *error);

void arguments_free(struct arguments *arguments);

/* The name of the next iteration, malloc'ed; NULL: no memory. box -> box.1, box.9 -> box.10, d.1/box -> d.1/box.1. */
char *next_iteration(const char *name);

/* --- Print the text of -h (help_full), or the short text for a command line without input file (help_usage). */

void help_usage(const char *program);
/* where: completes "Makes triangle meshes ...", such as "on one core". further: a paragraph about more options, as
 * parts that end with NULL; or NULL if there are none. */
void help_full(const char *program, const char *where, const char *const *further);

#endif
