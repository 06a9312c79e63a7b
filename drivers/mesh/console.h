/* All output of the programs. Lines, warnings and errors go to standard output, as in Triangle. Errors also go to
 * standard error, with file and line in front, unless both are the same place. */
#ifndef DRIVERS_MESH_CONSOLE_H
#define DRIVERS_MESH_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/status.h"

struct console {
    const char *program; /* name of the program, for errors */
    bool quiet;          /* print errors only */
    int verbosity;
};

enum { CONSOLE_SERIES_LINES = 10 }; /* number of warnings of one kind that are printed */

#if defined(__GNUC__)
#define CONSOLE_FORMAT(text, first) __attribute__((format(printf, text, first)))
#else
#define CONSOLE_FORMAT(text, first)
#endif

/* Opens /dev/null for standard input, output or error if the caller has closed them. Otherwise the first opened file
 * would receive the output. To be called first. */
void console_open(void);

/* Prints `before` and a line, or a part of one, unless quiet. The caller ends the line. */
void console_print(const struct console *console, const char *before, const char *format, ...) CONSOLE_FORMAT(3, 4);
#define console_say(console, ...) console_print(console, "", __VA_ARGS__)
#define console_warn(console, ...) console_print(console, "Warning:  ", __VA_ARGS__)

/* Prints how many of n warnings of a kind were not printed. */
void console_series_end(const struct console *console, int64_t n, const char *what);

/* Prints a remark on standard error, also if quiet. */
void console_remark(const struct console *console, const char *format, ...) CONSOLE_FORMAT(2, 3);

void console_error(const struct console *console, const struct tri_error *error);

/* Flushes standard output. TRI_CANNOT_WRITE: a part could not be written. It is no error if the reader has closed the
 * pipe. */
enum tri_status console_flush(struct tri_error *error);

/* Flushes standard output as the last action of the program. Returns false, after a message on standard error, if a
 * part could not be written. */
bool console_close(const struct console *console);

#endif
