/* Errors, each of which is one line. */
#include "drivers/one_line.h"

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

void one_line_complain(const char *program, const char *format, va_list arguments)
{
    enum { LENGTH = 1 << 14 };
    char text[LENGTH];
    vsnprintf(text, sizeof text, format, arguments);
    fprintf(stderr, "%s: ", program);
    one_line_put(stderr, text);
    fputc('\n', stderr);
}
