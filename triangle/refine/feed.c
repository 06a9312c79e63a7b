/* What waits to be treated: new bad triangles are judged and queued.
 *
 * Three kinds wait, in this order (refine.c): triangles with a corner that sees the opposite subsegment under too wide
 * an angle; other triangles with bad angles, by their shortest edges; triangles that are only too large. */
#include "triangle/refine/refiner.h"

#include <assert.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"
#include "triangle/refine/quality.h"

/* Four buckets an octave of the squared length, counted from the shortest edge that can be resolved. */
static int bucket_of(const struct tri_refiner *r, double shortest)
{
    int exponent, first = TRI_URGENT_BUCKET + 1;
    double mantissa = frexp(shortest, &exponent);
    assert(shortest >= 0 && shortest < HUGE_VAL);
    int bucket = first + 4 * (exponent - r->least_exponent) + (int)(8 * mantissa) - 4;
    return bucket < first ? first : bucket >= TRI_BUCKETS ? TRI_BUCKETS - 1 : bucket;
}

/* Does a corner of the triangle see the subsegment opposite to it under too wide an angle? */
static bool encroaches_opposite(const struct tri_refiner *r, const struct tri_triangle *t)
{
    for (int e = 0; e < 3; e++) {
        if (t->n[e] >= 0)
            continue;
        assert(t->n[e] != TRI_BEYOND);
        struct tri_point p = r->mesh->xy[t->v[e]];
        struct tri_relative a = tri_relative(&r->mesh->xy[t->v[tri_next[e]]], p);
        struct tri_relative b = tri_relative(&r->mesh->xy[t->v[tri_prev[e]]], p);
        double dot = a.x * b.x + a.y * b.y;
        if (dot < 0 && dot * dot > r->criterion.bounds.lens_cos2 * a.l * b.l)
            return true;
    }
    return false;
}

static bool push_angle(struct tri_refiner *r, tri_triangle_id triangle, double shortest)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    assert(triangle >= 0 && tri_is_live(t));
    int bucket = encroaches_opposite(r, t) ? TRI_URGENT_BUCKET : bucket_of(r, shortest);
    return tri_bad_queue_push_angle(&r->queue, (struct tri_entry){triangle, t->life}, bucket);
}

static bool push(struct tri_refiner *r, tri_triangle_id triangle, enum tri_badness badness, double shortest)
{
    struct tri_entry entry = {triangle, r->mesh->tri[triangle].life};
    assert(badness != TRI_GOOD && tri_is_live(&r->mesh->tri[triangle]));
    return badness == TRI_BAD_ANGLE ? push_angle(r, triangle, shortest)
                                    : tri_bad_queue_push_size(&r->queue, entry, badness == TRI_BAD_SIZE);
}

/* Judges the triangle of an edge and the new vertex, from the coordinates the cavity search left. */
static bool judge_edge(struct tri_refiner *r, const struct tri_cavity_edge *edge, double area2_bound)
{
    struct tri_relative ra = edge[0].ra, rb = edge[1].ra;
    assert(edge->triangle >= 0);
    double area2 = edge->area2, x = ra.x - rb.x, y = ra.y - rb.y, l = x * x + y * y;
    if (area2 * area2 < r->criterion.bounds.sin2 * tri_longer_product(ra.l, rb.l, l))
        return push_angle(r, edge->triangle, tri_lesser(ra.l, tri_lesser(rb.l, l)));
    bool is_bad = area2 > area2_bound;
    if (r->options->unsuitable)
        is_bad = is_bad || tri_is_unsuitable(&r->criterion, r->mesh->tri[edge->triangle].v);
    struct tri_entry entry = {edge->triangle, r->mesh->tri[edge->triangle].life};
    return tri_bad_queue_push_size(&r->queue, entry, is_bad);
}

/* Judges the new triangles where only urgent ones count (options->urgent). */
static bool judge_urgent(struct tri_refiner *r)
{
    for (int32_t i = 0; i < r->cavity.n_edges; i++) {
        tri_triangle_id triangle = r->cavity.edge[i].triangle;
        const struct tri_triangle *t = &r->mesh->tri[triangle];
        struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
        enum tri_badness badness = tri_judge(&r->criterion, t, &shape);
        if (badness != TRI_GOOD && !push(r, triangle, badness, shape.l[shape.shortest]))
            return false;
    }
    return true;
}

/* Queues what is bad among the new triangles. */
bool tri_feed_fan(struct tri_refiner *r)
{
    if (r->options->urgent)
        return judge_urgent(r);
    for (int32_t i = 0; i < r->cavity.n_edges; i++) {
        const struct tri_cavity_edge *edge = &r->cavity.edge[i];
        if (!judge_edge(r, edge, tri_area2_bound(&r->criterion, edge->region)))
            return false;
    }
    return true;
}

bool tri_feed_subsegment(struct tri_refiner *r, tri_sub_id s)
{
    assert(s >= 0 && r->options->conforming);
    if (!tri_grow(&r->encroached, &r->encroached_capacity, r->n_encroached + 1, sizeof *r->encroached))
        return false;
    r->encroached[r->n_encroached++] = s;
    return true;
}

/* For conforming meshes: the new vertex may lie in the diametral circle of a wall. */
bool tri_feed_walls(struct tri_refiner *r)
{
    for (int32_t i = 0; r->options->conforming && i < r->cavity.n_wall; i++)
        if (!tri_feed_subsegment(r, ~r->cavity.edge[r->cavity.wall[i]].outer))
            return false;
    return true;
}

bool tri_feed_triangle(struct tri_refiner *r, tri_triangle_id triangle, bool sizes)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    if (!tri_is_live(t))
        return true;
    struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
    enum tri_badness badness = tri_judge(&r->criterion, t, &shape);
    if (badness == TRI_GOOD || (badness == TRI_BAD_SIZE) != sizes)
        return true;
    return push(r, triangle, badness, shape.l[shape.shortest]);
}

/* The subsegments beside a triangle. */
bool tri_feed_beside(struct tri_refiner *r, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    for (int e = 0; tri_is_live(t) && e < 3; e++)
        if (t->n[e] < 0 && !tri_feed_subsegment(r, ~t->n[e]))
            return false;
    return true;
}
