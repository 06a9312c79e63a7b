/* Each question takes one pass over the triangles or the subsegments. */
#include "triangle/refine/census.h"

#include <assert.h>
#include <math.h>

#include "triangle/geometry/predicates.h"
#include "triangle/mesh/parents.h"
#include "triangle/refine/split.h"
#include "triangle/size/gap.h"
#include "triangle/size/hopeless.h"
#include "triangle/size/quality.h"

static bool needs_work(const struct tri_criterion *c, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &c->asked.mesh->tri[triangle];
    if (!tri_is_live(t))
        return false;
    struct tri_shape shape = tri_shape_of(c->asked.mesh->xy, t->v);
    enum tri_badness badness = tri_judge(c, t, &shape);
    if (badness == TRI_BAD_ANGLE && tri_is_hopeless(c->asked.mesh, triangle, &shape) &&
        !tri_is_too_large(&c->asked, t, &shape))
        badness = TRI_GOOD; /* it cannot be improved */
    if (badness != TRI_GOOD)
        return true;
    if (!c->asked.quality->conforming)
        return false;
    struct tri_disk_split split;
    for (int e = 0; e < 3; e++)
        if (t->n[e] < 0 && t->n[e] != TRI_BEYOND &&
            tri_is_encroached_from(c->asked.mesh, &c->asked.mesh->sub[~t->n[e]], tri_code(triangle, e), &split))
            return true;
    return false;
}

int32_t tri_find_work(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id first,
                      tri_triangle_id last, tri_triangle_id *found)
{
    assert(first >= 0 && last <= mesh->n_triangles);
    for (tri_triangle_id triangle = first; triangle < last; triangle++)
        found[triangle - first] = triangle;
    return tri_find_work_among(mesh, quality, found, last - first, found);
}

int32_t tri_find_work_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                            const tri_triangle_id *triangle, int32_t n, tri_triangle_id *found)
{
    const struct tri_criterion c = tri_criterion_for(mesh, quality);
    int32_t n_found = 0;
    assert(n >= 0);
    for (int32_t i = 0; i < n; i++)
        if (needs_work(&c, triangle[i]))
            found[n_found++] = triangle[i];
    return n_found;
}

int tri_obtuse_corner(const struct tri_mesh *mesh, tri_triangle_id triangle)
{
    const struct tri_point *xy = mesh->xy;
    const tri_vertex_id *v = mesh->tri[triangle].v;
    for (int k = 0; k < 3; k++)
        if (tri_dot(xy[v[tri_next[k]]], xy[v[tri_prev[k]]], xy[v[k]]) < 0)
            return k;
    return -1;
}

int32_t tri_find_hopeless(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          tri_triangle_id *found)
{
    const struct tri_criterion c = tri_criterion_for(mesh, quality);
    int32_t n = 0;
    for (tri_triangle_id triangle = 0; triangle < mesh->n_triangles; triangle++) {
        const struct tri_triangle *t = &mesh->tri[triangle];
        if (!tri_is_live(t) || needs_work(&c, triangle))
            continue;
        struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
        if (tri_judge(&c, t, &shape) != TRI_GOOD)
            found[n++] = triangle;
    }
    return n;
}

/* Does a subsegment that must not be split lie on the triangle or on one of its neighbours? */
static bool is_beside_protected(const struct tri_criterion *c, const struct tri_triangle *t)
{
    for (int e = 0; e < 3; e++) {
        if (t->n[e] < 0 && tri_is_protected(c->asked.quality, &c->asked.mesh->sub[~t->n[e]]))
            return true;
        const struct tri_triangle *other = t->n[e] < 0 ? t : &c->asked.mesh->tri[tri_of(t->n[e])];
        for (int f = 0; f < 3; f++)
            if (other->n[f] < 0 && tri_is_protected(c->asked.quality, &c->asked.mesh->sub[~other->n[f]]))
                return true;
    }
    return false;
}

/* Returns why the triangle is bad, or TRI_EXCUSES if no reason is known. */
static enum tri_excuse excuse_for(const struct tri_criterion *c, tri_triangle_id triangle,
                                  const struct tri_shape *shape, enum tri_badness badness,
                                  const struct tri_refine_report *report)
{
    const struct tri_triangle *t = &c->asked.mesh->tri[triangle];
    if (!c->asked.mesh->incidence.start) /* the mesh was not prepared for refinement, so its features are unknown */
        return TRI_EXCUSES;
    if (tri_is_too_large(&c->asked, t, shape))
        badness = TRI_BAD_SIZE;
    if (badness == TRI_BAD_ANGLE && tri_is_hopeless(c->asked.mesh, triangle, shape))
        return shape->l[shape->shortest] < c->asked.mesh->limits.shortest2 ? TRI_EXCUSE_PRECISION
               : tri_bridges_spike(c->asked.mesh, triangle, shape)   ? TRI_EXCUSE_INPUT_ANGLE
               : tri_is_narrow_gap(c->asked.mesh, triangle, shape)   ? TRI_EXCUSE_NARROW_GAP
               : tri_crosses_angle(c->asked.mesh, triangle, shape)   ? TRI_EXCUSE_INPUT_ANGLE
                                                               : TRI_EXCUSE_LIMIT;
    if (report->hit_limit)
        return TRI_EXCUSE_LIMIT;
    if (c->asked.quality->protect > 0 && is_beside_protected(c, t))
        return TRI_EXCUSE_PROTECTED;
    if (c->asked.quality->min_angle > tri_worked_angle(c->asked.quality) && badness == TRI_BAD_ANGLE)
        return TRI_EXCUSE_LIMIT;
    return TRI_EXCUSES;
}

/* If several edges are equally short, returns the smallest of their reasons. So the result does not depend on the
 * order of the corners, which renumbering may change. */
static enum tri_excuse first_excuse_for(const struct tri_criterion *c, tri_triangle_id triangle,
                                        const struct tri_shape *shape, enum tri_badness badness,
                                        const struct tri_refine_report *report)
{
    enum tri_excuse first = TRI_EXCUSES;
    for (int k = 0; k < 3; k++) {
        struct tri_shape seen = *shape;
        seen.shortest = k;
        if (shape->l[k] > shape->l[shape->shortest])
            continue;
        const enum tri_excuse excuse = excuse_for(c, triangle, &seen, badness, report);
        first = excuse < first ? excuse : first;
    }
    return first;
}

void tri_settle_counts(const struct tri_refine_report *report, const int64_t found[TRI_EXCUSES + 1],
                       int64_t count[TRI_EXCUSES])
{
    bool protected_more = report->given_up[TRI_EXCUSE_PROTECTED] > report->given_up[TRI_EXCUSE_PRECISION];
    for (int k = 0; k < TRI_EXCUSES; k++)
        count[k] = found[k];
    if (report->gated + report->fenced > 0)
        count[TRI_EXCUSE_DEFERRED] += found[TRI_EXCUSES];
    else /* its neighbourhood may depend on a protected segment farther away */
        count[protected_more ? TRI_EXCUSE_PROTECTED : TRI_EXCUSE_PRECISION] += found[TRI_EXCUSES];
}

static enum tri_excuse excuse_for_circle(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                         const struct tri_refine_report *report, const struct tri_subsegment *s,
                                         tri_halfedge code)
{
    tri_vertex_id apex = tri_apex(mesh, code);
    if (tri_is_protected(quality, s))
        return TRI_EXCUSE_PROTECTED;
    if (report->hit_limit)
        return TRI_EXCUSE_LIMIT;
    struct tri_disk_split split;
    if (!tri_is_resolved_from(mesh, s, apex) || tri_is_encroached_from(mesh, s, code, &split))
        return TRI_EXCUSE_PRECISION; /* coordinates resolve the split, but rounding left no place that sees the whole
                                        cavity */
    if (tri_common_end(mesh, s->parent, apex) != TRI_NONE)
        return TRI_EXCUSE_INPUT_ANGLE;
    return tri_is_on_parent(mesh, apex) ? TRI_EXCUSE_NARROW_GAP : TRI_EXCUSE_PRECISION;
}

void tri_count_encroached(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_refine_report *report, int64_t count[TRI_EXCUSES])
{
    for (int k = 0; k < TRI_EXCUSES; k++)
        count[k] = 0;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        const struct tri_subsegment *sub = &mesh->sub[s];
        enum tri_excuse first = TRI_EXCUSES;
        for (int side = 0; side < 2; side++)
            if (sub->side[side] != TRI_NONE && tri_is_in_diametral_disk(mesh, sub, sub->side[side])) {
                const enum tri_excuse excuse = excuse_for_circle(mesh, quality, report, sub, sub->side[side]);
                first = excuse < first ? excuse : first;
            }
        if (first < TRI_EXCUSES)
            count[first]++;
    }
}

/* A parallel count of bad triangles, divided into shares. */
struct counting {
    struct tri_criterion criterion; /* the bounds */
    const struct tri_refine_report *report; /* report of the refinement */
    int64_t count[TRI_MOST_SHARES][TRI_EXCUSES + 1]; /* bad triangles per share and reason; last: no reason */
};

static void count_triangle(const struct tri_criterion *c, const struct tri_refine_report *report, tri_triangle_id t,
                           int64_t count[TRI_EXCUSES + 1])
{
    const struct tri_mesh *mesh = c->asked.mesh;
    if (!tri_is_live(&mesh->tri[t]))
        return;
    struct tri_shape shape = tri_shape_of(mesh->xy, mesh->tri[t].v);
    enum tri_badness badness = tri_judge(c, &mesh->tri[t], &shape);
    if (badness != TRI_GOOD)
        count[first_excuse_for(c, t, &shape, badness, report)]++;
}

static void count_share(void *context, size_t share)
{
    struct counting *c = context;
    struct tri_range range = tri_share(share, c->criterion.asked.mesh->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++)
        count_triangle(&c->criterion, c->report, t, c->count[share]);
}

/* Returns the bounds without lengths. Lengths are met on average and do not bound single triangles. */
static struct tri_criterion bounds_of(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                      struct tri_quality *bounds)
{
    struct tri_criterion c = tri_criterion_for(mesh, quality);
    *bounds = *quality;
    bounds->lengths = NULL;
    c.asked.quality = bounds;
    return c;
}

void tri_count_bad_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         const struct tri_refine_report *report, const tri_triangle_id *triangle, int32_t n,
                         int64_t count[TRI_EXCUSES + 1])
{
    struct tri_quality bounds;
    const struct tri_criterion c = bounds_of(mesh, quality, &bounds);
    for (int32_t i = 0; i < n; i++)
        count_triangle(&c, report, triangle[i], count);
}

void tri_count_bad(const struct tri_mesh *mesh, const struct tri_quality *quality,
                   const struct tri_refine_report *report, const struct tri_executor *executor,
                   int64_t count[TRI_EXCUSES])
{
    struct tri_quality bounds;
    struct counting c = {bounds_of(mesh, quality, &bounds), report, {{0}}};
    size_t shares = tri_shares(mesh->n_triangles);
    tri_execute(tri_asks_caller(quality) ? NULL : executor, shares, count_share, &c);
    for (size_t i = 1; i < shares; i++)
        for (int k = 0; k <= TRI_EXCUSES; k++)
            c.count[0][k] += c.count[i][k];
    tri_settle_counts(report, c.count[0], count);
}
