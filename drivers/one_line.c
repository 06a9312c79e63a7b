/* Control characters are escaped when the text is complete. */
#include "drivers/one_line.h"

#include <string.h>

enum { LENGTH = 1 << 14 };

void one_line_put(FILE *stream, const char *text)
{
    for (const char *at = text; *at; at++)
        if (*at == '\n')
            fputs("\\n", stream);
        else if ((unsigned char)*at < 0x20 || *at == 0x7f)
            fprintf(stream, "\\x%02x", (unsigned)*at);
        else
            fputc(*at, stream);
}

void one_line_print(FILE *stream, const char *format, va_list arguments)
{
    if (!strstr(format, "%s")) {
        vfprintf(stream, format, arguments);
        return;
    }
    const size_t length = strlen(format), before = strspn(format, "\n");
    size_t after = 0;
    while (after < length - before && format[length - after - 1] == '\n')
        after++;
    char text[LENGTH];
    vsnprintf(text, sizeof text, format, arguments);
    if (strlen(text) + 1 < sizeof text)
        text[strlen(text) - after] = 0;
    fprintf(stream, "%.*s", (int)before, format);
    one_line_put(stream, text + before);
    fputs(format + length - after, stream);
}

void one_line_error(FILE *stream, const char *before, const struct tri_error *error)
{
    fputs(before, stream);
    if (error->file[0])
        one_line_put(stream, error->file);
    if (error->file[0] && error->line > 0)
        fprintf(stream, ":%ld: ", error->line);
    else if (error->file[0])
        fputs(": ", stream);
    one_line_put(stream, error->text);
    fputc('\n', stream);
}
