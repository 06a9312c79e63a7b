/* Runs the stages of mesh generation in order. */
#include "triangle/api/generate.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/cdt/delaunay.h"

struct tri_options tri_defaults(void) { return (struct tri_options){.quality = tri_quality_defaults()}; }

static void announce(const struct tri_options *options, enum tri_stage stage)
{
    if (options->stage)
        options->stage(options->stage_user, stage);
}

/* Converts the segments of a PSLG to the numbers of its points in the mesh. An end that names no point stays
 * invalid. */
static enum tri_status rename_segments(struct tri_pslg *renamed, const struct tri_pslg *pslg, const int32_t *place,
                                       struct tri_error *error)
{
    size_t n = 2 * (size_t)pslg->n_segments;
    *renamed = *pslg;
    renamed->segments = malloc((n + 1) * sizeof *renamed->segments);
    if (!renamed->segments)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d segments", (int)pslg->n_segments);
    for (size_t i = 0; i < n; i++) {
        tri_vertex_id v = pslg->segments[i];
        renamed->segments[i] = v >= 0 && v < pslg->n_points ? place[v] : TRI_NONE;
    }
    return TRI_OK;
}

static enum tri_status constrain_and_carve(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                           const struct tri_options *options, struct tri_report *report,
                                           struct tri_error *error)
{
    announce(options, TRI_STAGE_SEGMENTS);
    enum tri_status status = TRI_OK;
    if (options->use_segments)
        status = tri_constrain(mesh, pslg, &report->constrain, error);
    assert(status || tri_mesh_is_sound(mesh));
    if (status)
        return status; /* the status of this stage, not of the next one */
    announce(options, TRI_STAGE_HOLES);
    if (options->use_segments) {
        struct tri_carve_options carve = {options->keep_hull, options->ignore_holes, options->spread_regions,
                                          options->even_odd, options->n_open, &report->carve};
        status = tri_carve(mesh, pslg, &carve, error);
        assert(status || tri_mesh_is_sound(mesh));
    }
    return status;
}

static enum tri_status triangulate(struct tri_mesh *mesh, const struct tri_pslg *pslg,
                                   const struct tri_options *options, struct tri_report *report,
                                   struct tri_error *error)
{
    int32_t *place = NULL;
    struct tri_pslg renamed = {0};
    enum tri_status status = tri_mesh_take_points(mesh, pslg, options->executor, error);
    announce(options, TRI_STAGE_DELAUNAY);
    status = status ? status : tri_sort_points(mesh, &place, options->executor, error);
    status = status ? status : tri_delaunay(mesh, options->executor, error);
    assert(status || tri_mesh_is_sound(mesh));
    for (tri_vertex_id v = 0; !status && mesh->twin && v < mesh->n_input; v++)
        report->duplicates += mesh->twin[v] != v;
    status = status ? status : rename_segments(&renamed, pslg, place, error);
    free(place);
    status = status ? status : constrain_and_carve(mesh, &renamed, options, report, error);
    free(renamed.segments);
    if (!status && mesh->n_triangles == 0 && report->carve.why.reason == TRI_EMPTY_NOT)
        report->carve.why.reason = TRI_EMPTY_LINE;
    if (!status)
        tri_notes_make(&report->notes, &report->carve.why, pslg, report->constrain.skipped, options->base);
    return status;
}

static enum tri_status make(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                            struct tri_report *report, struct tri_error *error)
{
    enum tri_status status = tri_pslg_check(pslg, error);
    status = status ? status : tri_mesh_init(mesh, error);
    mesh->stop = options->stop;
    status = status ? status : triangulate(mesh, pslg, options, report, error);
    if (!status)
        tri_mark_boundary(mesh);
    return status;
}

static enum tri_status rebuild(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                               struct tri_report *report, struct tri_error *error)
{
    const struct tri_reconstruct_options how = {.use_segments = options->use_segments, .refine = options->refine,
                                                .stop = options->stop, .executor = options->executor,
                                                .base = options->base, .is_edge = options->is_edge,
                                                .loose = &report->loose};
    announce(options, TRI_STAGE_REBUILD);
    return tri_reconstruct(mesh, pslg, options->elements, &how, error);
}

static enum tri_status refine(struct tri_mesh *mesh, const struct tri_options *options, struct tri_report *report,
                              struct tri_error *error)
{
    announce(options, TRI_STAGE_QUALITY);
    if (!options->refine)
        return TRI_OK;
    return options->refine_call
               ? options->refine_call(options->refine_user, mesh, &options->quality, &report->quality, error)
               : tri_refine(mesh, &options->quality, &report->quality, error);
}

/* Turns subsegments to the direction of their input segments, at the end. */
static void turn_subs(struct tri_mesh *mesh)
{
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->parents[mesh->sub[s].parent].reversed)
            tri_turn_sub(&mesh->sub[s]);
    for (tri_parent_id p = 0; p < mesh->n_parents; p++)
        mesh->parents[p].reversed = false;
}

double tri_generate_bytes(const struct tri_pslg *pslg, const struct tri_elements *elements, bool refine)
{
    static const double POINT = 200, ATTRIBUTE = 20, SURFACE = 110, SEGMENT = 135, REBUILT_POINT = 100, ELEMENT = 48;
    const double surface = refine && pslg->n_attributes > 0 ? SURFACE + 8.0 * pslg->n_attributes : 0;
    const double point = (elements->n > 0 ? REBUILT_POINT : POINT) + ATTRIBUTE * pslg->n_attributes + surface;
    return point * pslg->n_points + SEGMENT * pslg->n_segments + ELEMENT * elements->n;
}

enum tri_status tri_generate(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_options *options,
                             struct tri_report *report, struct tri_error *error)
{
    *mesh = (struct tri_mesh){0};
    *report = (struct tri_report){0};
    enum tri_status status = options->elements ? rebuild(mesh, pslg, options, report, error)
                                               : make(mesh, pslg, options, report, error);
    if (!status && options->refine)
        status = tri_refine_prepare(mesh, options->executor, error);
    if (status) {
        tri_mesh_free(mesh);
        return status;
    }
    assert(tri_mesh_is_sound(mesh));
    status = refine(mesh, options, report, error);
    assert(tri_mesh_is_sound(mesh)); /* the mesh is valid even if refinement failed */
    enum tri_status restored = tri_restore_points(mesh, options->executor, error);
    if (restored) {
        tri_mesh_free(mesh);
        return restored;
    }
    turn_subs(mesh);
    assert(!mesh->origin && tri_mesh_is_sound(mesh));
    announce(options, TRI_STAGE_DONE);
    return status;
}
