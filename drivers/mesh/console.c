/* Prints for people, and for scripts that search for lines. */
#include "drivers/mesh/console.h"

#include <inttypes.h>
#include <stdarg.h>
#include <stdio.h>

#include "drivers/words.h"
#include "triangle/base/system.h"

void console_open(void)
{
    tri_standard_open();
}

void console_print(const struct console *console, const char *before, const char *format, ...)
{
    if (console->quiet)
        return;
    va_list arguments;
    va_start(arguments, format);
    fputs(before, stdout);
    one_line_print(stdout, format, arguments);
    fflush(stdout); /* readers of a pipe or a log see each line at once */
    va_end(arguments);
}

void console_series_end(const struct console *console, int64_t n, const char *what)
{
    if (n > CONSOLE_SERIES_LINES)
        console_warn(console, "and %" PRId64 " more %s.\n", n - CONSOLE_SERIES_LINES, what);
}

void console_remark(const struct console *console, const char *format, ...)
{
    va_list arguments;
    va_start(arguments, format);
    fflush(stdout);
    fprintf(stderr, "%s: ", console->program);
    one_line_print(stderr, format, arguments);
    va_end(arguments);
}

/* An error has been printed, or the loss of standard output: no further message about output follows. */
static bool error_is_printed;

void console_error(const struct console *console, const struct tri_error *error)
{
    one_line_error(stdout, "Error:  ", error);
    fflush(stdout);
    error_is_printed = true;
    if (tri_standard_is_same_file())
        return;
    if (!error->file[0])
        fprintf(stderr, "%s: ", console->program);
    one_line_error(stderr, "", error);
}

enum tri_status console_flush(struct tri_error *error)
{
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    return written || tri_standard_reader_is_gone()
               ? TRI_OK
               : tri_fail(error, TRI_CANNOT_WRITE, NULL, 0, "cannot write to standard output");
}

bool console_close(const struct console *console)
{
    if (console_flush(NULL) == TRI_OK)
        return true;
    if (!error_is_printed)
        fprintf(stderr, "%s: cannot write to standard output\n", console->program);
    error_is_printed = true;
    return false;
}
