#include "trials.h"

#include "triangle/refine/place.h"

static double total_area(const struct tri_mesh *mesh)
{
    double sum = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        sum += 0.5 * tri_shape_of(mesh->xy, mesh->tri[t].v).area2;
    return sum * mesh->unit * mesh->unit;
}

struct tri_mesh trials_coarse_mesh(const struct start *start)
{
    struct tri_options options = start->options;
    options.refine = false;
    return support_generate(&start->pslg, &options, NULL);
}

struct start trials_start_of(const struct trial *trial)
{
    struct start start = {.options = support_quality(trial->angle, 0)};
    if (!support_read(trial->file, &start.pslg))
        fail_msg("cannot read %s", trial->file);
    support_add_heights(&start.pslg, 2, 1);
    start.options.keep_hull = start.pslg.n_segments == 0;
    start.options.spread_regions = start.options.quality.region_areas = trial->regions;
    start.options.quality.conforming = trial->conforming;
    start.options.quality.protect = trial->protect;
    struct tri_mesh mesh = trials_coarse_mesh(&start);
    if (trial->target > 0)
        start.options.quality.max_area = total_area(&mesh) / (0.65 * trial->target);
    tri_mesh_free(&mesh);
    return start;
}
