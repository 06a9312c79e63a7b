/* Reads options, numbers and sizes on the command line. Prints arguments and file names, which may contain any
 * character. */
#ifndef DRIVERS_WORDS_H
#define DRIVERS_WORDS_H

#include <getopt.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "triangle/base/status.h"

/* --- printing */

/* Prints a text. Control characters become \n or \x1b. */
void one_line_put(FILE *stream, const char *text);

/* Prints like vfprintf. If the format has a text (%s), line breaks are printed only at the beginning and end of the
 * format; all other control characters are escaped. Output longer than several file names is cut. */
void one_line_print(FILE *stream, const char *format, va_list arguments);

/* Prints `before`, the place of an error, and its text. */
void one_line_error(FILE *stream, const char *before, const struct tri_error *error);

/* --- reading */

/* Reads a number, optionally followed by a letter that stands for a factor. The product must lie between low and high.
 * Returns false, and changes nothing, if the text is invalid. */
bool words_take_real(const char *text, const char *letters, const double *factor, double low, double high,
                     double *value);

/* Reads a size in bytes (500M), at least `least`, or a share (60%). The other result becomes 0. */
bool words_take_size(const char *text, double least, double *bytes, double *share);

/* --- programs that read one mesh: options in the form of getopt_long, and one argument, the mesh */

struct program_words {
    const char *program;                   /* name of the program, for errors */
    const char *version;                   /* one line */
    const char *usage, *help;              /* complete lines; --help prints usage, then help */
    const char *letters;                   /* options of one letter after "-:", as for getopt_long */
    const struct option *options;          /* long options, as for getopt_long */
    int version_option, help_option;
    bool (*apply)(void *settings, int option); /* applies an option with value optarg; false: the value is invalid */
    const char *more;                      /* printed after help; NULL: nothing. C guarantees 4095 characters a text */
};

enum words_end {
    WORDS_TAKEN,
    WORDS_ANSWERED, /* help or version was printed on standard output */
    WORDS_MISUSED   /* an error was printed on standard error, with usage unless only a value is invalid */
};

/* Reads all arguments. *mesh becomes the one argument that is no option, borrowed from argv. */
enum words_end words_take_all(const struct program_words *words, int argc, char **argv, void *settings,
                              char **mesh);

#endif
