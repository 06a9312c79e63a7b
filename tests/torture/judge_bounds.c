/* Bounds: the report must explain each violation, and must be correct. */
#include <stdio.h>

#include "tests/torture/judge.h"
#include "triangle/refine/census.h"
#include "triangle/refine/split.h"
#include "triangle/geometry/predicates.h"
#include "triangle/refine/place.h"

/* Triangles lower than this many units in the last place of the largest coordinate may be too large, and leave no room
 * to split a subsegment. With -YY the limit is twice as high. */
static const double FLAT = 100 * 0x1p-52;

/* Within this relative distance, rounding may leave a vertex in a subsegment's circle. */
static const double LEVEL = 1e-8;

static double area_bound(const struct outcome *o, int32_t t)
{
    const struct tri_quality *q = &o->options.quality;
    double bound = q->max_area > 0 ? q->max_area : INFINITY;
    double own = o->mesh.regions[o->mesh.tri[t].region].max_area;
    return (q->region_areas && own > 0 ? fmin(bound, own) : bound) / o->mesh.unit / o->mesh.unit;
}

static void judge_areas(const struct outcome *o, struct verdict *verdict)
{
    struct figure_bounds box = figure_bounds(&o->of->figure.pslg);
    const double flat = (o->switches.protect > 1 ? 2 : 1) * FLAT * box.largest / o->mesh.unit;
    for (int32_t t = 0; t < o->mesh.n_triangles; t++) {
        struct tri_shape s = tri_shape_of(o->mesh.xy, o->mesh.tri[t].v);
        double over = s.area2 / 2 / area_bound(o, t), height = s.area2 / sqrt(tri_longest2(&s));
        if (over > 1 + 1e-9 && height >= flat)
            judge_fault(verdict, "area", "triangle %d is too large by a factor of %.3g", (int)t, over);
    }
}

/* Only few angles are below the bound, apart from three exceptions: small input angles, which the checker finds itself,
 * narrow spaces, and details below the resolution of coordinates. The few lie where points accumulate, which rarely
 * happens to the extent that the theory allows. */
static void judge_unexplained(const struct outcome *o, const struct tri_check_report *report,
                              const int64_t count[TRI_EXCUSES], struct verdict *verdict)
{
    enum { FEW = 30 };
    const double share = o->options.quality.min_angle > PROMISED ? 0.05 : 0;
    const int64_t excused = report->n_small_explained + count[TRI_EXCUSE_NARROW_GAP] + count[TRI_EXCUSE_PRECISION];
    const int64_t unexplained = report->n_small - excused;
    if (o->switches.protect > 0 || o->options.quality.min_angle > tri_worked_angle(&o->options.quality))
        return;
    if (unexplained > FEW + share * o->mesh.n_triangles)
        judge_fault(verdict, "angle", "%lld of %d angles are small without a reason (input angle %lld, gap %lld)",
                    (long long)unexplained, (int)o->mesh.n_triangles, (long long)count[TRI_EXCUSE_INPUT_ANGLE],
                    (long long)count[TRI_EXCUSE_NARROW_GAP]);
}

/* The counts that the programs print. */
static void judge_angles(const struct outcome *o, const struct tri_check_report *report, struct verdict *verdict)
{
    struct tri_quality angles = o->options.quality;
    int64_t count[TRI_EXCUSES], sum = 0;
    angles.max_area = 0;
    angles.region_areas = false;
    angles.unsuitable = NULL;
    tri_count_bad(&o->mesh, &angles, &o->report.quality, NULL, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    if (report->n_small > sum)
        judge_fault(verdict, "angle uncounted", "%lld small angles, %lld counted", (long long)report->n_small,
                    (long long)sum);
    if (count[TRI_EXCUSE_DEFERRED] > 0)
        judge_fault(verdict, "angle deferred", "%lld triangles", (long long)count[TRI_EXCUSE_DEFERRED]);
    if (count[TRI_EXCUSE_PROTECTED] > 0 && o->switches.protect == 0)
        judge_fault(verdict, "angle protected", "%lld without Y", (long long)count[TRI_EXCUSE_PROTECTED]);
    judge_unexplained(o, report, count, verdict);
}

/* Is a triangle beside the subsegment so flat that rounding leaves no room for a split point? */
static bool is_beside_flat(const struct tri_mesh *mesh, const struct tri_subsegment *s, double least_height)
{
    for (int side = 0; side < 2; side++) {
        if (s->side[side] == TRI_NONE)
            continue;
        struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[tri_of(s->side[side])].v);
        if (shape.area2 < least_height * sqrt(tri_longest2(&shape)))
            return true;
    }
    return false;
}

/* Is the apex on this side inside the subsegment's circle, although it lies clearly beside the subsegment? */
static bool is_resolvable(const struct tri_mesh *mesh, int32_t i, int side, double largest)
{
    const struct tri_subsegment *s = &mesh->sub[i];
    if (s->side[side] == TRI_NONE || !tri_is_in_diametral_disk(mesh, s, s->side[side]) ||
        is_beside_flat(mesh, s, FLAT * largest))
        return false;
    return tri_line_distance(mesh->xy[s->v[0]], mesh->xy[s->v[1]], mesh->xy[tri_apex(mesh, s->side[side])]) >
           LEVEL * largest;
}

/* Each non-conforming subsegment or triangle must be counted, and must lie at the resolution of coordinates. The
 * checker has found this number of faults of the kind. */
void judge_conforming(const struct outcome *o, int kind, int64_t faults, struct verdict *verdict)
{
    struct figure_bounds box = figure_bounds(&o->of->figure.pslg);
    double largest = box.largest / o->mesh.unit;
    int64_t count[TRI_EXCUSES], sum = 0, resolvable = 0;
    tri_count_encroached(&o->mesh, &o->options.quality, &o->report.quality, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    for (int32_t s = 0; s < o->mesh.n_subs; s++)
        resolvable += is_resolvable(&o->mesh, s, 0, largest) || is_resolvable(&o->mesh, s, 1, largest);
    if (sum == 0 || (kind == TRI_CHECK_ENCROACHMENT && sum != faults))
        judge_fault(verdict, "conforming uncounted", "%lld faults, %lld counted", (long long)faults, (long long)sum);
    if (resolvable > 0)
        judge_fault(verdict, "conforming",
                    "%lld subsegments without a reason (input angle %lld, gap %lld, precision %lld)",
                    (long long)resolvable, (long long)count[TRI_EXCUSE_INPUT_ANGLE],
                    (long long)count[TRI_EXCUSE_NARROW_GAP], (long long)count[TRI_EXCUSE_PRECISION]);
}

static bool is_new(const struct tri_mesh *mesh, int32_t v) { return v >= mesh->n_input && mesh->on[v] >= 0; }

/* Y: no new vertex on the boundary. YY: no new vertex on any subsegment. */
static void judge_protection(const struct outcome *o, struct verdict *verdict)
{
    const struct tri_mesh *mesh = &o->mesh;
    for (int32_t s = 0; s < mesh->n_subs && o->switches.protect > 0; s++) {
        const struct tri_subsegment *sub = &mesh->sub[s];
        bool boundary = sub->side[0] == TRI_NONE || sub->side[1] == TRI_NONE;
        if ((boundary || o->switches.protect > 1) && (is_new(mesh, sub->v[0]) || is_new(mesh, sub->v[1])))
            judge_fault(verdict, "protection", "subsegment %d has a new end", (int)s);
    }
}

static void judge_limit(const struct outcome *o, struct verdict *verdict)
{
    const struct tri_refine_report *r = &o->report.quality;
    int64_t limit = o->options.quality.max_steiner, inserted = r->inserted_free + r->inserted_on_segments;
    if (limit >= 0 && inserted > limit)
        judge_fault(verdict, "steiner", "%lld points inserted, %lld allowed", (long long)inserted, (long long)limit);
}

void judge_bounds(const struct outcome *o, const struct tri_check_report *report, struct verdict *verdict)
{
    if (!o->options.refine)
        return;
    judge_protection(o, verdict);
    judge_limit(o, verdict);
    if (o->report.quality.hit_limit)
        return;
    judge_areas(o, verdict);
    if (o->options.quality.min_angle > 0)
        judge_angles(o, report, verdict);
}
