/* Two kinds of pre-refinement. If areas decide where the triangles are, the mesh is refined to the same bounds with
 * areas scaled up. Otherwise only bad triangles with edges that are long compared with their cell are refined. */
#include "sched/schedule/prerefine.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "sched/tunables.h"
#include "triangle/base/system.h"
#include "triangle/geometry/shape.h"
#include "triangle/size/estimate.h"

/* Returns the sine of an angle in degrees, 0 to 180, from the portable cosine. */
static double sine(double degrees)
{
    double cosine = tri_cos_degrees(degrees);
    return sqrt(1 - cosine * cosine);
}

double par_rho(double min_angle)
{
    assert(min_angle > 0 && min_angle <= 60);
    return 1 / (2 * sine(min_angle));
}

double par_radius_lemma7(double max_area, double rho) { return 2 * rho * sqrt(rho) * sqrt(max_area); }

double par_radius_tight(double max_area, double min_angle)
{
    double s = sine(min_angle);
    assert(min_angle > 0 && min_angle < 90);
    return sqrt(max_area / (2 * s * s * sine(2 * min_angle)));
}

double par_radius2(struct tri_point a, struct tri_point b, struct tri_point c)
{
    double area2 = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
    return tri_distance2(a, b) * tri_distance2(b, c) * tri_distance2(c, a) / (4 * area2 * area2);
}

/* The test for triangles that a graded pre-refinement refines: those with an edge longer than a share of the cell that
 * they lie in. */
struct coarse_test {
    const struct par_partition *partition; /* the cells */
    double share2; /* square of this share */
    double least2; /* square of a length: shorter edges are not too long in any cell, which saves looking up the cell */
};

/* A tri_urgent callback: returns whether the longest edge is too long for the cell that holds the triangle's centre. */
static bool is_too_long(void *user, const struct tri_point *xy, const tri_vertex_id v[3])
{
    const struct coarse_test *test = user;
    const struct tri_point a = xy[v[0]], b = xy[v[1]], c = xy[v[2]];
    const double longest2 = fmax(tri_distance2(a, b), fmax(tri_distance2(b, c), tri_distance2(c, a)));
    if (longest2 <= test->least2)
        return false;
    double size = par_cell_size(test->partition,
                                (struct tri_point){(a.x + b.x + c.x) / 3, (a.y + b.y + c.y) / 3});
    return longest2 > test->share2 * size * size;
}

/* Lists the worklist entries that are too long, in their order. False: no memory. */
static bool list_long_ones(const struct par_run *run, struct coarse_test *test, struct par_ids *found)
{
    const struct par_ids *worklist = &run->worklist;
    *found = (struct par_ids){malloc(((size_t)worklist->n + 1) * sizeof *found->item), 0, worklist->n};
    for (int32_t i = 0; found->item && i < worklist->n; i++)
        if (is_too_long(test, run->mesh->xy, run->mesh->tri[worklist->item[i]].v))
            found->item[found->n++] = worklist->item[i];
    return found->item;
}

/* Returns the smallest width or height of all cells. */
static double smallest_cell(const struct par_partition *p)
{
    double least = HUGE_VAL;
    for (int32_t c = 0; c + 1 < p->n_columns; c++)
        least = p->x[c + 1] - p->x[c] < least ? p->x[c + 1] - p->x[c] : least;
    for (int32_t c = 0; c < p->n_columns; c++) {
        const double *y = p->y + (size_t)c * (size_t)p->n_rows;
        for (int32_t r = 0; r + 1 < p->n_rows; r++)
            least = y[r + 1] - y[r] < least ? y[r + 1] - y[r] : least;
    }
    return least > 0 ? least : 0;
}

struct tri_quality par_coarse_bounds(const struct tri_quality *quality, double cell)
{
    struct tri_quality coarse = *quality;
    coarse.area_scale = tri_area_scale(quality) * (cell / PAR_COARSE_PER_CELL);
    coarse.min_angle = fmin(quality->min_angle, TRI_SIZES_ANGLE);
    coarse.lattice = tri_wants_lattice(quality);
    return coarse;
}

bool par_areas_decide(const struct par_run *run, const struct tri_quality *quality, double estimate,
                      double cell)
{
    struct tri_quality coarse = par_coarse_bounds(quality, cell);
    double sure, most = estimate * fmin(4 * PAR_COARSE_PER_CELL / cell, 0.25);
    return tri_has_sizes(quality) && tri_estimate(run->mesh, &coarse, &run->asked.executor, &sure) < most;
}

enum tri_status par_fill_worklist(struct par_run *run, const struct tri_quality *quality, bool known,
                                  struct tri_error *error)
{
    run->key.n = 0;
    return par_worklist_fill(&run->worklist, run->mesh, quality, known, &run->asked.executor, &run->radius, error);
}

enum tri_status par_prerefine_graded(struct par_run *run, const struct tri_quality *quality,
                                     const struct par_partition *partition, struct tri_error *error)
{
    struct tri_quality coarse = *quality;
    struct tri_refine_report report;
    double least = smallest_cell(partition);
    /* An edge is too long if it is longer than a quarter of the cell; 1/16 is the square of this share. */
    struct coarse_test test = {partition, 1.0 / 16, least * least / 16};
    /* At most one point for 400 final triangles. */
    coarse.max_steiner = (int64_t)(partition->estimate / 400);
    struct par_ids long_ones;
    double began = tri_seconds();
    enum tri_status status = par_fill_worklist(run, quality, false, error);
    if (status)
        return status;
    if (!list_long_ones(run, &test, &long_ones))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)run->worklist.n);
    assert(long_ones.n <= run->worklist.n);
    struct tri_refine_hooks hooks = par_hooks(run);
    /* Refine only triangles that are too long, including new ones. */
    hooks.urgent = is_too_long;
    hooks.urgent_user = &test;
    hooks.worklist = long_ones.item;
    hooks.n_worklist = long_ones.n;
    double found = tri_seconds(), refined = found;
    if (long_ones.n > 0) {
        status = tri_refine_with(run->mesh, &coarse, &hooks, &report, error);
        par_add_points(&run->report->total, &report);
        refined = tri_seconds();
        /* Only triangles made since the worklist was filled need to be judged. */
        status = status ? status : par_fill_worklist(run, quality, true, error);
    }
    free(long_ones.item);
    run->report->seconds_prerefine += refined - found;
    run->report->seconds_find += tri_seconds() - refined + found - began;
    return status;
}
