#include "drivers/mesh/export.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"

struct export export_of(const char *name, int n_parts)
{
    const struct tri_format *format = tri_format_of(name);
    return (struct export){.format = format, .n_parts = format->write_parts ? n_parts : 0};
}

int export_files(const struct export *export) { return export->n_parts > 0 ? export->n_parts : 1; }

char *export_name(const struct export *export, const char *name, int file)
{
    const size_t room = strlen(name) + 16;
    const int stem = (int)(strlen(name) - strlen(export->format->suffix));
    char *text = malloc(room);
    if (text && export->n_parts == 0)
        snprintf(text, room, "%s", name);
    else if (text)
        snprintf(text, room, "%.*s_%d%s", stem, name, file + 1, name + stem);
    return text;
}

enum tri_status export_open(struct export *export, const char *name, struct tri_output_set *set,
                            struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; i < export_files(export) && !status; i++) {
        char *path = export_name(export, name, i);
        status = path ? interrupt_open(set, path, &export->output[i], error)
                      : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
        free(path);
    }
    return status;
}

enum tri_status export_write(const struct export *export, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error)
{
    if (export->n_parts > 0)
        return export->format->write_parts(export->output, export->n_parts, grid, executor, error);
    return export->format->write(export->output[0], grid, executor, error);
}
