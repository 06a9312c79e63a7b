/* Printing to people and to scripts that search for lines. */
#include "drivers/mesh/console.h"

#include <errno.h>
#include <fcntl.h>
#include <inttypes.h>
#include <poll.h>
#include <stdarg.h>
#include <stdio.h>
#include <sys/stat.h>
#include <unistd.h>

#include "drivers/one_line.h"

void console_open(void)
{
    for (int file = 0; file <= STDERR_FILENO; file++)
        if (fcntl(file, F_GETFD) < 0 && errno == EBADF)
            (void)!open("/dev/null", O_RDWR); /* takes the lowest number that is free */
    setvbuf(stdout, NULL, _IOLBF, 0); /* whoever reads it from a pipe or a log sees each line at once */
}

void console_print(const struct console *console, const char *before, const char *format, ...)
{
    if (console->quiet)
        return;
    va_list arguments;
    va_start(arguments, format);
    fputs(before, stdout);
    one_line_print(stdout, format, arguments);
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

/* An error has been told, or that standard output is lost: nothing more is said of that. */
static bool told;

static bool are_one_place(int a, int b)
{
    struct stat at_a, at_b;
    return fstat(a, &at_a) == 0 && fstat(b, &at_b) == 0 && at_a.st_dev == at_b.st_dev && at_a.st_ino == at_b.st_ino;
}

void console_error(const struct console *console, const struct tri_error *error)
{
    one_line_error(stdout, "Error:  ", error);
    fflush(stdout);
    told = true;
    if (are_one_place(STDOUT_FILENO, STDERR_FILENO))
        return;
    if (!error->file[0])
        fprintf(stderr, "%s: ", console->program);
    one_line_error(stderr, "", error);
}

/* Has the reader of standard output closed the pipe? */
static bool reader_is_gone(void)
{
    struct pollfd output = {STDOUT_FILENO, POLLOUT, 0};
    return poll(&output, 1, 0) == 1 && (output.revents & POLLERR);
}

enum tri_status console_flush(struct tri_error *error)
{
    bool written = fflush(stdout) == 0 && !ferror(stdout);
    return written || reader_is_gone()
               ? TRI_OK
               : tri_fail(error, TRI_CANNOT_WRITE, NULL, 0, "cannot write to standard output");
}

bool console_close(const struct console *console)
{
    if (console_flush(NULL) == TRI_OK)
        return true;
    if (!told)
        fprintf(stderr, "%s: cannot write to standard output\n", console->program);
    told = true;
    return false;
}
