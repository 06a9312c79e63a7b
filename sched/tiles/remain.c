/* A list of triangles that have been given up, looked through once for each column. */
#include "sched/tiles/remain.h"

#include <stdlib.h>
#include <string.h>

#include "triangle/refine/census.h"

/* Reasons that name the schedule: nothing is deferred where no block leaves anything. */
static struct tri_refine_report report_of(const struct par_run *run)
{
    struct tri_refine_report report = run->report->total;
    report.gated = report.fenced = 0;
    return report;
}

bool par_remain_begin(struct par_run *run)
{
    struct par_ids *list = &run->remain.listed;
    tri_triangle_id *found = malloc(((size_t)run->mesh->n_triangles + 1) * sizeof *found);
    const int32_t n = found ? tri_find_hopeless(run->mesh, &run->bounds, found) : 0;
    list->n = 0;
    bool memory = found && par_ids_add_all(list, found, n);
    free(found);
    memset(run->remain.counted, 0, sizeof run->remain.counted);
    return memory;
}

static bool has_corner_left_of(const struct tri_mesh *mesh, tri_triangle_id t, double x)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    return mesh->xy[v[0]].x < x || mesh->xy[v[1]].x < x || mesh->xy[v[2]].x < x;
}

/* Those to come stay in front, those to count go behind them, and are counted by one call. */
void par_remain_count(struct par_run *run, double x)
{
    const struct tri_mesh *mesh = run->mesh;
    const struct tri_refine_report report = report_of(run);
    struct par_ids *list = &run->remain.listed;
    int32_t n = par_sort_unique(list->item, list->n), live = 0, kept = 0;
    for (int32_t i = 0; i < n; i++) {
        const tri_triangle_id t = list->item[i];
        if (!tri_is_live(&mesh->tri[t]))
            continue;
        list->item[live++] = t;
        if (!has_corner_left_of(mesh, t, x)) {
            list->item[live - 1] = list->item[kept];
            list->item[kept++] = t;
        }
    }
    tri_count_bad_among(mesh, &run->bounds, &report, list->item + kept, live - kept, run->remain.counted);
    list->n = kept;
}

void par_remain_settle(struct par_run *run)
{
    const struct tri_refine_report report = report_of(run);
    tri_settle_counts(&report, run->remain.counted, run->report->remain);
    run->report->remain_known = true;
}

void par_remain_count_all(struct par_run *run)
{
    const struct tri_refine_report report = report_of(run);
    tri_count_bad(run->mesh, &run->bounds, &report, &run->asked.executor, run->report->remain);
    run->report->remain_known = true;
}
