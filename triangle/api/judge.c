/* The public interface of the mesh checker, triangle/check/check.h. */
#include "ptriangle/check.h"

#include <stdio.h>

#include "triangle/api/figure.h"
#include "triangle/check/check.h"

_Static_assert((int)TRI_DELAUNAY_CONSTRAINED == (int)TRI_CHECK_CONSTRAINED &&
                   (int)TRI_DELAUNAY_CONFORMING == (int)TRI_CHECK_CONFORMING &&
                   (int)TRI_DELAUNAY_NOT == (int)TRI_CHECK_NOT_DELAUNAY,
               "the kinds of the header are those of the library");

static struct tri_check_mesh mesh_of(const struct tri_api_figure *figure)
{
    const struct tri_pslg *pslg = &figure->pslg;
    return (struct tri_check_mesh){.n_points = pslg->n_points, .points = pslg->points,
                                   .n_triangles = figure->elements.n, .triangles = figure->elements.corners,
                                   .n_segments = pslg->n_segments, .segments = pslg->segments,
                                   .segment_markers = pslg->segment_markers,
                                   .n_attributes = figure->elements.n_attributes,
                                   .attributes = figure->elements.attributes};
}

static struct tri_check_options options_of(const struct tri_demands *demands, const struct tri_api_figure *figure)
{
    return (struct tri_check_options){.min_angle = demands->min_angle, .max_area = demands->max_area,
                                      .max_areas = figure->elements.areas,
                                      .delaunay = (enum tri_check_delaunay)demands->delaunay, .max_bad = -1,
                                      .convex = demands->convex, .renumbered = demands->renumbered,
                                      .ignore_holes = demands->ignore_holes, .any_holes = demands->any_holes,
                                      .border = demands->keep_hull ? TRI_CHECK_BORDER_HULL
                                                                   : TRI_CHECK_BORDER_SEGMENTS};
}

static void fill_verdict(struct tri_verdict *verdict, const struct tri_check_report *report)
{
    *verdict = (struct tri_verdict){.n_points = report->n_used_points, .n_edges = report->n_edges,
                                    .n_boundary_edges = report->n_boundary_edges,
                                    .smallest_angle = report->smallest_angle, .largest_angle = report->largest_angle,
                                    .smallest_area = report->smallest_area, .largest_area = report->largest_area,
                                    .total_area = report->total_area, .n_small = report->n_small,
                                    .n_small_explained = report->n_small_explained};
    for (int k = 0; k < TRI_N_CHECKS; k++) {
        const struct tri_check_item *item = &report->item[k];
        if (item->state != TRI_CHECK_FAILED)
            continue;
        if (verdict->n_faults == 0)
            snprintf(verdict->text, sizeof verdict->text, "%s: %s", tri_check_name((enum tri_check_kind)k), item->text);
        verdict->n_faults += item->count > 0 ? item->count : 1;
    }
}

enum tri_status tri_check_figure(const struct tri_figure *mesh, const struct tri_figure *input,
                          const struct tri_demands *demands, struct tri_verdict *verdict, struct tri_error *error)
{
    struct tri_demands own;
    struct tri_api_figure judged, given = {0};
    struct tri_check_report report;
    enum tri_status status = tri_api_figure_take(&judged, mesh, error);
    status = status ? status : tri_api_struct_take(&own, sizeof own, demands, "tri_demands", error);
    if (!status && input)
        status = tri_api_figure_take(&given, input, error);
    if (!status) {
        const struct tri_check_mesh on_trial = mesh_of(&judged);
        const struct tri_check_options options = options_of(&own, &judged);
        status = tri_check(&on_trial, input ? &given.pslg : NULL, &options, &report, error);
    }
    if (!status)
        fill_verdict(verdict, &report);
    tri_api_figure_free(&judged);
    tri_api_figure_free(&given);
    return status;
}
