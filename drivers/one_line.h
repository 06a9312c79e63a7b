/* Errors, each of which is one line. */
#ifndef DRIVERS_ONE_LINE_H
#define DRIVERS_ONE_LINE_H

#include <stdarg.h>
#include <stdio.h>

/* Names of files may hold anything: control characters are printed as \n or \x1b. */
void one_line_put(FILE *stream, const char *text);

/* "program: " and the text on standard error; what is longer than several names is cut. */
void one_line_complain(const char *program, const char *format, va_list arguments);

#endif
