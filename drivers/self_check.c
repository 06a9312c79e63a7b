/* Plain arrays out of the mesh, the judgement, and its lines. */
#include "drivers/self_check.h"

#include <inttypes.h>
#include <stdlib.h>

#include "triangle/check/check.h"
#include "triangle/generate.h"

struct arrays {
    double *points;
    int32_t *triangles, *segments;
};

static bool copy_mesh(struct arrays *arrays, const struct tri_mesh *mesh)
{
    arrays->points = malloc(((size_t)mesh->n_vertices + 1) * 2 * sizeof *arrays->points);
    arrays->triangles = malloc(((size_t)mesh->n_triangles + 1) * 3 * sizeof *arrays->triangles);
    arrays->segments = malloc(((size_t)mesh->n_subs + 1) * 2 * sizeof *arrays->segments);
    if (!arrays->points || !arrays->triangles || !arrays->segments)
        return false;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        arrays->points[2 * (size_t)v] = mesh->xy[v].x;
        arrays->points[2 * (size_t)v + 1] = mesh->xy[v].y;
    }
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        for (size_t k = 0; k < 3; k++)
            arrays->triangles[3 * (size_t)t + k] = mesh->tri[t].v[k];
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (size_t k = 0; k < 2; k++)
            arrays->segments[2 * (size_t)s + k] = mesh->sub[s].v[k];
    return true;
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

enum tri_status self_check(const struct console *console, const struct tri_switches *switches,
                           const struct tri_mesh *mesh, int32_t base, struct tri_error *error)
{
    struct arrays arrays = {0};
    struct tri_check_report report;
    struct tri_check_options options = {.max_bad = INT64_MAX, .ignore_lost = true, .base = base};
    options.delaunay = switches->conforming ? TRI_CHECK_CONFORMING : TRI_CHECK_CONSTRAINED;
    enum tri_status status = TRI_OK;
    if (!copy_mesh(&arrays, mesh))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory to check %d triangles", (int)mesh->n_triangles);
    struct tri_check_mesh trial = {.n_points = mesh->n_vertices, .points = arrays.points,
                                   .n_triangles = mesh->n_triangles,
                                   .triangles = arrays.triangles, .n_segments = mesh->n_subs,
                                   .segments = arrays.segments};
    console_say(console, "Checking the mesh.\n");
    status = status ? status : tri_check(&trial, NULL, &options, &report, error);
    if (!status)
        tell(console, &report, switches->conforming);
    free(arrays.points);
    free(arrays.triangles);
    free(arrays.segments);
    return status;
}
