/* A table of two whole numbers a row. */
#include "drivers/mesh/blocks_file.h"

#include "drivers/interrupt.h"
#include "triangle/text/decimal.h"
#include "triangle/text/write.h"

enum { ROW_BYTES = 48 };

struct source {
    const struct par_report *report;
    const struct tri_mesh *mesh;
};

static char *format_row(void *user, size_t i, char *at)
{
    const struct source *source = user;
    int phase;
    int32_t block = par_block_of(source->report, source->mesh, (int32_t)i, &phase);
    at = tri_print_integer(at, block, 0);
    *at++ = ' ';
    at = tri_print_integer(at, phase, 0);
    *at++ = '\n';
    return at;
}

enum tri_status blocks_write(const char *path, struct tri_output_set *set, const struct par_report *report,
                             const struct tri_mesh *mesh, struct tri_error *error)
{
    struct source source = {report, mesh};
    struct tri_output *output;
    enum tri_status status = interrupt_open(set, path, &output, error);
    return status ? status
                  : tri_write_table(output, (size_t)mesh->n_triangles, ROW_BYTES, format_row, &source, NULL, error);
}
