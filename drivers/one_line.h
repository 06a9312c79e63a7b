/* What names of files and words of the command line, which may hold anything, look like where they are printed. */
#ifndef DRIVERS_ONE_LINE_H
#define DRIVERS_ONE_LINE_H

#include <stdarg.h>
#include <stdio.h>

#include "triangle/base/status.h"

/* Control characters are printed as \n or \x1b. */
void one_line_put(FILE *stream, const char *text);

/* As vfprintf; but where the format takes a text (%s), line breaks are those at its beginning and end alone: all other
 * control characters come out of texts. What is longer than several names is cut. */
void one_line_print(FILE *stream, const char *format, va_list arguments);

/* Some words, the place of an error, and its text. */
void one_line_error(FILE *stream, const char *before, const struct tri_error *error);

#endif
