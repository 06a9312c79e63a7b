/* Bounds: what is missed must be explained by the report, and the report must be right. */
#include <stdio.h>

#include "tests/torture/judge.h"
#include "triangle/census.h"
#include "triangle/disk.h"
#include "triangle/predicates.h"
#include "triangle/quality.h"
#include "triangle/small_angle.h"

/* Heights below this share of the largest coordinate are at the resolution of coordinates. */
static const double RESOLUTION = 1e-12;

/* A vertex that is level with an end of a subsegment up to rounding, an ulp, leaves the circles of parts not longer
 * than height^2 / ulp: where more of them than that are needed, the place is not resolved. From SHORTEST ulps on it is
 * not for rounding that the vertex lies in the circle. */
enum { MOST_PARTS = 8, SHORTEST = 128 };

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
    for (int32_t t = 0; t < o->mesh.n_triangles; t++)
        measure(b, t);
    if (b->too_large > 0 && o->switches.protect == 0)
        judge_fault(verdict, "area", "%lld triangles too large, the worst %d by a factor of %.3g",
                    (long long)b->too_large, (int)b->worst_at, b->worst);
}

/* The point of a parent that is nearest to p. */
static struct tri_point nearest_point(const struct tri_mesh *mesh, tri_parent_id parent, struct tri_point p)
{
    struct tri_point a = mesh->xy[mesh->parents[parent].v[0]], b = mesh->xy[mesh->parents[parent].v[1]];
    double x = b.x - a.x, y = b.y - a.y, along = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    along = fmin(fmax(along, 0), 1);
    return (struct tri_point){a.x + along * x, a.y + along * y};
}

/* Is the space between these two, which face each other across p at u and v, one that is not filled? */
static bool is_unfilled(const struct tri_mesh *mesh, tri_parent_id near, tri_parent_id far, struct tri_point u,
                        struct tri_point v, struct tri_point p)
{
    bool across = (u.x - p.x) * (v.x - p.x) + (u.y - p.y) * (v.y - p.y) < 0;
    return across && (tri_corner_between(mesh, near, far) == TRI_SPIKE ||
                      tri_filling_cost(mesh, near, far, u, v) > mesh->limits.dearest_gap);
}

/* Between the nearest parent and any other one. */
static bool is_in_unfilled_space(const struct tri_mesh *mesh, int32_t t)
{
    const int32_t *v = mesh->tri[t].v;
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]], at = a;
    struct tri_point p = {a.x + ((b.x - a.x) + (c.x - a.x)) / 3, a.y + ((b.y - a.y) + (c.y - a.y)) / 3};
    tri_parent_id near = TRI_NONE;
    double least = INFINITY;
    for (tri_parent_id i = 0; i < mesh->n_parents; i++) {
        struct tri_point foot = nearest_point(mesh, i, p);
        if (tri_distance2(p, foot) < least)
            least = tri_distance2(p, foot), near = i, at = foot;
    }
    for (tri_parent_id i = 0; i < mesh->n_parents; i++)
        if (i != near && is_unfilled(mesh, near, i, at, nearest_point(mesh, i, p), p))
            return true;
    return false;
}

/* Of the triangles given up where vertices ran away those that do not lie in a spike or a gap too dear to fill. No
 * angle is promised there: points that sizes put there see only each other. */
static int64_t outside_gaps(const struct outcome *o, const struct tri_refine_options *angles)
{
    int64_t n = 0;
    for (int32_t t = 0; t < o->mesh.n_triangles; t++) {
        int64_t count[TRI_EXCUSES + 1] = {0};
        tri_count_bad_among(&o->mesh, angles, &o->report.quality, &t, 1, count);
        n += count[TRI_EXCUSE_LIMIT] > 0 && !is_in_unfilled_space(&o->mesh, t);
    }
    return n;
}

/* Where vertices ran away triangles are given up, at any bound: beside small angles, where the checker finds the reason
 * itself, and in dear spaces. Elsewhere none are up to the angle that theory promises (Ruppert 1995: 20.7 degrees),
 * next to none up to 25, and few above. */
static int64_t may_run_away(const struct outcome *o, const struct tri_refine_options *angles, int64_t count,
                            struct verdict *verdict)
{
    const double PROMISED = 20.7, LIKELY = 25, angle = angles->min_angle;
    double share = angle <= LIKELY ? 0 : 0.02;
    double few = 20 + share * o->mesh.n_triangles;
    if (angle <= PROMISED)
        return count > 0 ? count - outside_gaps(o, angles) : 0;
    int64_t outside = count > few ? outside_gaps(o, angles) : 0;
    if (outside > few)
        judge_fault(verdict, "angle limit", "%lld of %d triangles given up at %g degrees", (long long)outside,
                    (int)o->mesh.n_triangles, angle);
    return count;
}

/* --- beside flat triangles */

/* Is a triangle beside the subsegment as flat as rounding? Then that leaves no room for a split point. */
static bool is_beside_flat(const struct tri_mesh *mesh, const struct tri_subsegment *s, double least_height)
{
    for (int side = 0; side < 2; side++) {
        if (s->side[side] == TRI_NONE)
            continue;
        struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[tri_of(s->side[side])].v);
        if (shape.area2 < least_height * sqrt(fmax(shape.l[0], fmax(shape.l[1], shape.l[2]))))
            return true;
    }
    return false;
}

/* Does a triangle about `from` whose new point is p lead to a split of this subsegment, which hides p or is encroached
 * by it? */
static bool leads_to(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point from,
                     struct tri_point p)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    double x = b.x - a.x, y = b.y - a.y;
    double here = x * (from.y - a.y) - y * (from.x - a.x), there = x * (p.y - a.y) - y * (p.x - a.x);
    double px = p.x - from.x, py = p.y - from.y;
    bool parts = (px * (a.y - from.y) - py * (a.x - from.x) > 0) != (px * (b.y - from.y) - py * (b.x - from.x) > 0);
    return tri_dot(a, b, p) < 0 || ((here > 0) != (there > 0) && parts);
}

/* Of the triangles without a reason of their own those whose usual point leads to a subsegment beside a flat one. */
static int64_t stuck_beside_flat(const struct outcome *o, const struct tri_refine_options *angles, double least_height)
{
    const struct tri_mesh *mesh = &o->mesh;
    double off_centre = tri_bounds_for(angles->min_angle, angles->conforming).off_centre;
    int64_t n = 0;
    for (int32_t t = 0; t < mesh->n_triangles; t++) {
        int64_t count[TRI_EXCUSES + 1] = {0};
        tri_count_bad_among(mesh, angles, &o->report.quality, &t, 1, count);
        if (count[TRI_EXCUSES] == 0) /* good, or with a reason of its own */
            continue;
        const int32_t *v = mesh->tri[t].v;
        struct tri_shape shape = tri_shape_of(mesh->xy, v);
        double reach = off_centre > 0 ? off_centre * sqrt(shape.l[shape.shortest]) : HUGE_VAL;
        struct tri_point p = tri_place(mesh->xy, v, &shape, reach), a = mesh->xy[v[0]];
        struct tri_point centroid = {a.x + ((mesh->xy[v[1]].x - a.x) + (mesh->xy[v[2]].x - a.x)) / 3,
                                     a.y + ((mesh->xy[v[1]].y - a.y) + (mesh->xy[v[2]].y - a.y)) / 3};
        bool is_stuck = false;
        for (int32_t s = 0; s < mesh->n_subs && !is_stuck; s++)
            is_stuck = is_beside_flat(mesh, &mesh->sub[s], least_height) && leads_to(mesh, &mesh->sub[s], centroid, p);
        n += is_stuck;
    }
    return n;
}

/* What is small without another reason, next to flat triangles. A point for a triangle beside a flat one may see that
 * from behind, and is not inserted then: some around each may be left. A subsegment beside a flat triangle cannot be
 * split, since no point that coordinates know lies in between: of the triangles whose points lead to it all may be
 * left, and with areas to keep they are as many as fit along it. */
static int64_t may_be_beside_flat(const struct outcome *o, const struct bounds *b,
                                  const struct tri_refine_options *angles, int64_t unexplained)
{
    enum { AROUND = 10 };
    int64_t around = AROUND * b->too_flat;
    return unexplained > around && around > 0 ? around + stuck_beside_flat(o, angles, b->least_height) : around;
}

/* The counts that the programs print. */
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
    int64_t unexplained = report->n_small - report->n_small_explained - count[TRI_EXCUSE_NARROW_GAP];
    unexplained -= may_run_away(o, &angles, count[TRI_EXCUSE_LIMIT], verdict);
    unexplained -= may_be_beside_flat(o, b, &angles, unexplained);
    if (unexplained > 0)
        judge_fault(verdict, "angle",
                    "%lld small angles without a reason (input angle %lld, gap %lld, precision %lld)",
                    (long long)unexplained,
                    (long long)count[TRI_EXCUSE_INPUT_ANGLE], (long long)count[TRI_EXCUSE_NARROW_GAP],
                    (long long)count[TRI_EXCUSE_PRECISION]);
}

/* Is another subsegment as near as rounding to both these places, and so to all in between? Then a point there may come
 * to lie beyond it. */
static bool is_crowded_between(const struct tri_mesh *mesh, int32_t s, struct tri_point from, struct tri_point to,
                               double ulp)
{
    for (int32_t i = 0; i < mesh->n_subs; i++) {
        struct tri_point a = mesh->xy[mesh->sub[i].v[0]], b = mesh->xy[mesh->sub[i].v[1]];
        if (i != s && tri_dot(a, b, from) < 0 && tri_dot(a, b, to) < 0 && tri_line_distance(a, b, from) < 2 * ulp &&
            tri_line_distance(a, b, to) < 2 * ulp)
            return true;
    }
    return false;
}

/* Is the apex on this side in the circle of the subsegment, although coordinates resolve parts whose circles it is not
 * in? */
static bool is_resolvable(const struct tri_mesh *mesh, int32_t i, int side, double largest)
{
    const struct tri_subsegment *s = &mesh->sub[i];
    if (s->side[side] == TRI_NONE || !tri_is_in_diametral_disk(mesh, s, s->side[side]))
        return false;
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    struct tri_point v = mesh->xy[mesh->tri[tri_of(s->side[side])].v[tri_edge(s->side[side])]];
    double x = b.x - a.x, y = b.y - a.y, length = sqrt(x * x + y * y), ulp = 0x1p-52 * largest;
    double height = fabs(x * (v.y - a.y) - y * (v.x - a.x)) / length;
    double foot = (x * (v.x - a.x) + y * (v.y - a.y)) / length, off = fmin(foot, length - foot);
    /* Any split from the foot on to where a right angle at the vertex ends leaves it out of both circles (disk.c). */
    double farthest = fmin(off + height * (height / off), length / 2), way = foot > length / 2 ? -1 : 1;
    double last = foot + way * (farthest - off);
    struct tri_point from = {a.x + foot / length * x, a.y + foot / length * y};
    struct tri_point to = {a.x + last / length * x, a.y + last / length * y};
    if (height < SHORTEST * ulp || length <= 2 * SHORTEST * ulp || is_beside_flat(mesh, s, RESOLUTION * largest))
        return false;
    return off >= SHORTEST * ulp ? !is_crowded_between(mesh, i, from, to, ulp)
                                 : (fmax(off, 0) + ulp) * length <= MOST_PARTS * height * height;
}

/* What is not conforming must be counted, one by one, and lie at the resolution of coordinates. The checker has found
 * so many faults of this kind. */
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

/* Y: no new vertex on the boundary; YY: on no subsegment. */
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
