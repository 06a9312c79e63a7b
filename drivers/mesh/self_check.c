/* The mesh as the judge reads it, the judgement, and its lines. */
#include "drivers/mesh/self_check.h"

#include <inttypes.h>
#include <math.h>

#include "triangle/check/check.h"
#include "triangle/api/generate.h"

static enum tri_status read_mesh(void *user, enum tri_check_array array, int64_t first, int64_t n, void *out,
                                 struct tri_error *error)
{
    const struct tri_mesh *mesh = user;
    double(*points)[2] = out;
    int64_t *number = out;
    (void)error;
    for (int64_t i = first; i < first + n; i++) {
        if (array == TRI_CHECK_POINTS) {
            points[i - first][0] = mesh->xy[i].x;
            points[i - first][1] = mesh->xy[i].y;
        }
        for (int k = 0; array == TRI_CHECK_CORNERS && k < 3; k++)
            *number++ = mesh->tri[i].v[k];
        for (int k = 0; array == TRI_CHECK_SEGMENT_ENDS && k < 2; k++)
            *number++ = mesh->sub[i].v[k];
    }
    return TRI_OK;
}

static struct tri_check_source source_of(const struct tri_mesh *mesh)
{
    return (struct tri_check_source){.n_points = mesh->n_vertices, .n_triangles = mesh->n_triangles,
                                     .n_segments = mesh->n_subs, .n_nodes = mesh->n_vertices,
                                     .given = 1u << TRI_CHECK_POINTS | 1u << TRI_CHECK_CORNERS |
                                              1u << TRI_CHECK_SEGMENT_ENDS,
                                     .read = read_mesh, .user = (void *)mesh};
}

/* Bytes for parts that are worth it. */
static const double PARTS = 4e6;

/* What the judge must be told at least. */
static double least_bytes(const struct tri_check_source *source)
{
    return tri_check_least_bytes(source, NULL) / TRI_CHECK_SHARE + PARTS;
}

double self_check_least_bytes(const struct tri_mesh *mesh)
{
    const struct tri_check_source source = source_of(mesh);
    return least_bytes(&source);
}

static void tell(const struct console *console, const struct tri_check_report *report, bool conforming)
{
    int64_t faults = 0;
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &report->item[k];
        if (item->state != TRI_CHECK_FAILED)
            continue;
        faults += item->count;
        console_say(console, "  !! !! %s: %" PRId64 ", first: %s\n", tri_check_name((enum tri_check_kind)k),
                    item->count, item->text);
    }
    if (faults > 0) {
        console_say(console, "  The mesh has %" PRId64 " faults.\n", faults);
        return;
    }
    console_say(console, "  Topology: consistent, every triangle counter-clockwise.\n");
    console_say(console, "  Delaunay property: %s.\n", conforming ? "conforming Delaunay" : "constrained Delaunay");
}

enum tri_status self_check(const struct run *run, double memory)
{
    const bool conforming = run->arguments->switches.conforming;
    struct tri_check_report report;
    const struct tri_check_options options = {
        .max_bad = INT64_MAX, .ignore_lost = true, .base = run->base,
        .delaunay = conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED};
    struct tri_check_source source = source_of(&run->mesh);
    source.memory = memory > 0 ? fmax(memory, least_bytes(&source)) : 0;
    source.scratch = run->hooks->options->scratch;
    console_say(&run->console, "Checking the mesh.\n");
    enum tri_status status = tri_check_from(&source, NULL, &options, &report, run->error);
    if (!status)
        tell(&run->console, &report, conforming);
    return status;
}
