#include "trials.h"

#include "triangle/refine/place.h"
#include "triangle/size/lengths.h"

static double total_area(const struct tri_mesh *mesh)
{
    double sum = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++)
        sum += 0.5 * tri_shape_of(mesh->xy, mesh->tri[t].v).area2;
    return sum * mesh->unit * mesh->unit;
}

/* Lengths that give about the target number of triangles over a mesh. */
static struct tri_lengths *lengths_for(const struct tri_mesh *mesh, double target)
{
    const double h = 0.55 * sqrt(total_area(mesh) / (TRI_EQUILATERAL * target)), value[] = {h, 3 * h, h, 3 * h};
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++) {
        double at[2];
        tri_mesh_place(mesh, v, at);
        for (int k = 0; k < 2; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    const struct tri_size_field field = {.kind = TRI_SIZE_RASTER, .values = {value, 2, 2, 2},
                                         .origin = {low[0], low[1]}, .step = {high[0] - low[0], high[1] - low[1]}};
    const struct tri_sizes sizes = {.fields = &field, .n = 1, .gradation = HUGE_VAL};
    struct tri_lengths *lengths;
    assert_int_equal(tri_lengths_new(&lengths, &sizes, mesh, NULL, NULL), TRI_OK);
    return lengths;
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
    if (trial->target < 0)
        start.options.quality.lengths = lengths_for(&mesh, -trial->target);
    start.options.quality.front = true;
    if (trial->target > 0)
        start.options.quality.max_area = total_area(&mesh) / (0.65 * trial->target);
    tri_mesh_free(&mesh);
    return start;
}

void trials_free(struct start *start)
{
    tri_lengths_free((struct tri_lengths *)start->options.quality.lengths); /* only this file owns the lengths; all
                                                                               other files borrow them */
    tri_pslg_free(&start->pslg);
}
