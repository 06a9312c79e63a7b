/* Bounds: what is missed must be explained by the report, and the report must be right. */
#include <stdio.h>

#include "tests/torture/judge.h"
#include "triangle/disk.h"
#include "triangle/quality.h"

/* Heights below this share of the largest coordinate are at the resolution of coordinates. */
static const double RESOLUTION = 1e-12;

/* Circles that small angles share end by concentric shells, of which the smallest are larger than that. */
static const double RESOLUTION_OF_CIRCLES = 1e-10;

struct bounds {
    const struct outcome *outcome;
    double least_height; /* in the mesh's units */
    int64_t too_large, too_flat;
    double worst; /* area over bound */
    int32_t worst_at;
};

static double area_bound(const struct outcome *o, int32_t t)
{
    const struct tri_refine_options *q = &o->options.quality;
    double bound = q->max_area > 0 ? q->max_area : INFINITY;
    double own = o->mesh.regions[o->mesh.tri[t].region].max_area;
    return (q->region_areas && own > 0 ? fmin(bound, own) : bound) / o->mesh.unit / o->mesh.unit;
}

static void measure(struct bounds *b, int32_t t)
{
    const struct tri_mesh *mesh = &b->outcome->mesh;
    struct tri_shape s = tri_shape_of(mesh->xy, mesh->tri[t].v);
    double height = s.area2 / sqrt(fmax(s.l[0], fmax(s.l[1], s.l[2])));
    bool flat = height < b->least_height;
    double over = s.area2 / 2 / area_bound(b->outcome, t);
    b->too_flat += flat;
    if (flat || over <= 1 + 1e-9)
        return;
    b->too_large++;
    if (over > b->worst)
        b->worst = over, b->worst_at = t;
}

static void judge_areas(const struct outcome *o, struct bounds *b, struct verdict *verdict)
{
    struct figure_bounds box = figure_bounds(&o->of->figure.pslg);
    *b = (struct bounds){.outcome = o, .least_height = RESOLUTION * box.largest / o->mesh.unit};
    for (int32_t t = 0; t < o->mesh.n_slots; t++)
        measure(b, t);
    if (b->too_large > 0 && o->switches.protect == 0)
        judge_fault(verdict, "area", "%lld triangles too large, the worst %d by a factor of %.3g",
                    (long long)b->too_large, (int)b->worst_at, b->worst);
}

/* The counts that the programs print. A point for a triangle beside a flat one may see the flat one from behind, and is
 * not inserted then: where there are flat triangles, a few around each may be left. */
enum { AROUND = 10 };

static void judge_angles(const struct outcome *o, const struct bounds *b, const struct tri_check_report *report,
                         struct verdict *verdict)
{
    struct tri_refine_options angles = o->options.quality;
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
    if (o->switches.protect > 0 || o->options.quality.min_angle > TRI_USUAL_ANGLE)
        return;
    if (count[TRI_EXCUSE_LIMIT] > 0)
        judge_fault(verdict, "angle limit", "%lld triangles given up at %g degrees", (long long)count[TRI_EXCUSE_LIMIT],
                    o->options.quality.min_angle);
    int64_t unexplained = report->n_small - report->n_small_explained, beside = AROUND * b->too_flat;
    int64_t flat = count[TRI_EXCUSE_PRECISION] < beside ? count[TRI_EXCUSE_PRECISION] : beside;
    if (unexplained > count[TRI_EXCUSE_CHANNEL] + flat)
        judge_fault(verdict, "angle",
                    "%lld small angles without a reason (input angle %lld, channel %lld, precision %lld)",
                    (long long)(unexplained - count[TRI_EXCUSE_CHANNEL] - flat),
                    (long long)count[TRI_EXCUSE_INPUT_ANGLE], (long long)count[TRI_EXCUSE_CHANNEL],
                    (long long)count[TRI_EXCUSE_PRECISION]);
}

/* Is there a triangle of ordinary height on this side of a subsegment, with its apex in the circle? */
static bool is_resolvable(const struct tri_mesh *mesh, const struct tri_subsegment *s, int side, double least_height)
{
    if (s->side[side] == TRI_NONE || !tri_is_in_diametral_disk(mesh, s, s->side[side]))
        return false;
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[tri_of(s->side[side])].v);
    double longest2 = fmax(shape.l[0], fmax(shape.l[1], shape.l[2]));
    return shape.area2 * shape.area2 > least_height * least_height * longest2;
}

/* What is not conforming must be counted, and lie at the resolution of coordinates or where filling a narrow space would
 * cost too much. The checker has found so many faults. */
void judge_conforming(const struct outcome *o, int64_t faults, struct verdict *verdict)
{
    struct figure_bounds box = figure_bounds(&o->of->figure.pslg);
    double least_height = RESOLUTION_OF_CIRCLES * box.largest / o->mesh.unit;
    int64_t count[TRI_EXCUSES], sum = 0, resolvable = 0;
    tri_count_encroached(&o->mesh, &o->options.quality, &o->report.quality, count);
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum += count[k];
    for (int32_t s = 0; s < o->mesh.n_subs; s++)
        resolvable += is_resolvable(&o->mesh, &o->mesh.sub[s], 0, least_height) ||
                      is_resolvable(&o->mesh, &o->mesh.sub[s], 1, least_height);
    if (sum == 0)
        judge_fault(verdict, "conforming uncounted", "%lld faults", (long long)faults);
    if (resolvable > count[TRI_EXCUSE_CHANNEL])
        judge_fault(verdict, "conforming",
                    "%lld subsegments without a reason (input angle %lld, channel %lld, precision %lld)",
                    (long long)(resolvable - count[TRI_EXCUSE_CHANNEL]), (long long)count[TRI_EXCUSE_INPUT_ANGLE],
                    (long long)count[TRI_EXCUSE_CHANNEL], (long long)count[TRI_EXCUSE_PRECISION]);
}

/* Y: no new vertex on the boundary; YY: on no subsegment. */
static void judge_protection(const struct outcome *o, struct verdict *verdict)
{
    const struct tri_mesh *mesh = &o->mesh;
    for (int32_t s = 0; s < mesh->n_subs && o->switches.protect > 0; s++) {
        const struct tri_subsegment *sub = &mesh->sub[s];
        bool boundary = sub->side[0] == TRI_NONE || sub->side[1] == TRI_NONE;
        if ((boundary || o->switches.protect > 1) && (mesh->on[sub->v[0]] >= 0 || mesh->on[sub->v[1]] >= 0))
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
    struct bounds b;
    if (!o->options.refine)
        return;
    judge_protection(o, verdict);
    judge_limit(o, verdict);
    if (o->report.quality.hit_limit)
        return;
    judge_areas(o, &b, verdict);
    if (o->options.quality.min_angle > 0)
        judge_angles(o, &b, report, verdict);
}
