/* The functions that report failures. */
#include "triangle/base/status.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

enum tri_status tri_fail(struct tri_error *error, enum tri_status status, const char *file, int64_t line,
                         const char *format, ...)
{
    if (error) {
        va_list arguments;
        va_start(arguments, format);
        error->status = status;
        error->line = line;
        snprintf(error->file, sizeof error->file, "%s", file ? file : "");
        vsnprintf(error->text, sizeof error->text, format, arguments);
        va_end(arguments);
    }
    return status;
}

enum tri_status tri_fail_system(struct tri_error *error, enum tri_status status, const char *file, const char *what,
                                int error_number)
{
    return tri_fail(error, status, file, 0, "%s: %s", what, strerror(error_number));
}
