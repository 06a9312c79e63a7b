/* The stages in their order. */
#include "triangle/tri.h"

#include "triangle/delaunay.h"

struct tri_options tri_defaults(void) { return (struct tri_options){.quality = tri_refine_defaults()}; }

static void announce(const struct tri_options *options, enum tri_stage stage)
{
    if (options->stage)
        options->stage(options->stage_user, stage);
}

static enum tri_status triangulate(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                   const struct tri_options *options, struct tri_report *report,
                                   struct tri_error *error)
{
    enum tri_status status = tri_mesh_take_points(mesh, pslg, error);
    announce(options, TRI_STAGE_DELAUNAY);
    status = status ? status : tri_delaunay(mesh, error);
    for (int32_t v = 0; !status && mesh->twin && v < mesh->n_input; v++)
        report->duplicates += mesh->twin[v] != v;
    announce(options, TRI_STAGE_SEGMENTS);
    if (!status && options->use_segments)
        status = tri_constrain(mesh, pslg, &report->constrain, error);
    announce(options, TRI_STAGE_HOLES);
    if (!status && options->use_segments) {
        struct tri_carve_options carve = {options->keep_hull, options->ignore_holes, options->spread_regions};
        status = tri_carve(mesh, pslg, &carve, error);
    }
    return status;
}

enum tri_status tri_generate(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                             struct tri_report *report, struct tri_error *error)
{
    *mesh = (struct tri_mesh){0};
    *report = (struct tri_report){0};
    enum tri_status status = tri_pslg_check(pslg, error);
    status = status ? status : tri_mesh_init(mesh, error);
    status = status ? status : triangulate(mesh, pslg, options, report, error);
    if (!status) {
        tri_mark_boundary(mesh);
        status = tri_refine_prepare(mesh, error);
    }
    if (status) {
        tri_mesh_free(mesh);
        return status;
    }
    if (options->refine) {
        announce(options, TRI_STAGE_QUALITY);
        status = tri_refine(mesh, &options->quality, &report->quality, error);
    }
    announce(options, TRI_STAGE_DONE);
    return status;
}
