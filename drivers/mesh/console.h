/* All that the executables say. Lines, warnings and errors go to standard output, as Triangle's do; errors also to
 * standard error, once more and with file and line in front, unless that is the same place. */
#ifndef DRIVERS_MESH_CONSOLE_H
#define DRIVERS_MESH_CONSOLE_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/status.h"

struct console {
    const char *program; /* name, for errors */
    bool quiet;          /* errors alone are printed */
    int verbosity;
};

enum { CONSOLE_SERIES_LINES = 10 }; /* of the warnings of one kind only the first few are worth a line */

#if defined(__GNUC__)
#define CONSOLE_FORMAT(text, first) __attribute__((format(printf, text, first)))
#else
#define CONSOLE_FORMAT(text, first)
#endif

/* Opens /dev/null in place of standard input, output or error where the caller left them closed: else the first file
 * that is opened would receive what is printed. To be called before anything else. */
void console_open(void);

/* A line or a part of one behind some words, unless quiet; the caller ends the line. */
void console_print(const struct console *console, const char *before, const char *format, ...) CONSOLE_FORMAT(3, 4);
#define console_say(console, ...) console_print(console, "", __VA_ARGS__)
#define console_warn(console, ...) console_print(console, "Warning:  ", __VA_ARGS__)

/* Of n warnings of a kind: a last line that tells how many were not said. */
void console_series_end(const struct console *console, int64_t n, const char *what);

/* A remark on standard error, also if quiet. */
void console_remark(const struct console *console, const char *format, ...) CONSOLE_FORMAT(2, 3);

void console_error(const struct console *console, const struct tri_error *error);

/* Flushes standard output. TRI_CANNOT_WRITE: some of it could not be written. A reader who went away before the end is
 * no error: he has seen what he wanted to see. */
enum tri_status console_flush(struct tri_error *error);

/* The same as the last act of the program. False, after a word on standard error: output could not be written. */
bool console_close(const struct console *console);

#endif
