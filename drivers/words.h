/* Words of the command line: options, numbers and sizes in them; and how these and names of files, which may hold
 * anything, are printed. */
#ifndef DRIVERS_WORDS_H
#define DRIVERS_WORDS_H

#include <getopt.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>

#include "triangle/base/status.h"

/* --- printed */

/* Control characters are printed as \n or \x1b. */
void one_line_put(FILE *stream, const char *text);

/* As vfprintf; but where the format takes a text (%s), line breaks are those at its beginning and end alone: all other
 * control characters come out of texts. What is longer than several names is cut. */
void one_line_print(FILE *stream, const char *format, va_list arguments);

/* Some words, the place of an error, and its text. */
void one_line_error(FILE *stream, const char *before, const struct tri_error *error);

/* --- taken */

/* From the command line, a number, and maybe a letter that stands for a factor; the product is from low to high. False:
 * it is none, and nothing has changed. */
bool words_take_real(const char *text, const char *letters, const double *factor, double low, double high,
                     double *value);

/* Bytes, at least so many: 500M; or a share: 60%. The other one becomes 0. */
bool words_take_size(const char *text, double least, double *bytes, double *share);

/* --- of a program that takes a mesh: options, as getopt_long knows them, and one word, the mesh */

struct program_words {
    const char *program;                   /* its name, for errors */
    const char *version;                   /* a line */
    const char *usage, *help;              /* lines; what --help prints below usage */
    const char *letters;                   /* options of one letter behind "-:", and .. */
    const struct option *options;          /* .. of a word: both as getopt_long takes them */
    int version_option, help_option;
    bool (*apply)(void *settings, int option); /* with optarg; false: that is no value for it */
};

enum words_end {
    WORDS_TAKEN,
    WORDS_ANSWERED, /* help or version, on standard output */
    WORDS_MISUSED   /* and what is wrong, and usage unless it is a value, has been printed on standard error */
};

/* *mesh becomes the one word that is no option, borrowed from argv. */
enum words_end words_take_all(const struct program_words *words, int argc, char **argv, void *settings,
                              char **mesh);

#endif
