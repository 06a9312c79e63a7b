/* The command line of Triangle: arguments with switches, one input file, and the names of input and output files. */
#ifndef DRIVERS_MESH_ARGUMENTS_H
#define DRIVERS_MESH_ARGUMENTS_H

#include "drivers/mesh/size_options.h"
#include "triangle/base/status.h"
#include "triangle/dropin/switches.h"
#include "triangle/text/formats.h"

struct arguments {
    int argc; /* all arguments, for the comment in every output file */
    char **argv;
    struct tri_switches switches;
    struct size_options sizes; /* --size and related options; all 0: none */
    const char *file, *further; /* the first argument that is no switch, and the last further one; NULL: none */
    const struct tri_format *format; /* format of the file if other programs use it as well; NULL: Triangle's formats */
    bool is_geojson;  /* the polygons of the file are the input */
    char *input;      /* file without its suffix; suffixes are appended to this */
    char *output;     /* the same for output files */
};

struct arguments arguments_begin(int argc, char **argv);

/* Reads one argument: switches if it begins with a dash, otherwise the input file. */
void arguments_word(struct arguments *arguments, const char *word);

/* Completes the arguments: the suffix of the file sets its switches, and the file names are made. TRI_BAD_INPUT: a
 * second file, a number that is separated from its switch, or --region-polygons beside a GeoJSON file.
 * TRI_NO_MEMORY. */
enum tri_status arguments_end(struct arguments *arguments, struct tri_error *error);

void arguments_free(struct arguments *arguments);

/* Returns the name of the next iteration, malloc'ed; NULL: no memory. box -> box.1, box.9 -> box.10, d.1/box ->
 * d.1/box.1. */
char *next_iteration(const char *name);

/* --- Print the text of -h (help_full), or the short text for a command line without input file (help_usage). */

void help_usage(const char *program);
/* where: completes "Makes triangle meshes ...", such as "on one core". further: a paragraph about more options, as
 * parts that end with NULL; or NULL if there are none. */
void help_full(const char *program, const char *where, const char *const *further);

#endif
