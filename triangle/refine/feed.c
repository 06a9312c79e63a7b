/* Judges new triangles and queues the bad ones.
 *
 * Three kinds wait, in this order (refine.c): triangles with a corner that encroaches the opposite subsegment; other
 * triangles with bad angles, by their shortest edges; triangles that are only too large. */
#include "triangle/refine/refiner.h"

#include <assert.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"

/* Maps a shortest squared edge length to its bucket. There are four buckets per octave, counted from the shortest
 * edge that coordinates resolve. */
static int bucket_of(const struct tri_refiner *r, double shortest)
{
    int exponent, first = TRI_URGENT_BUCKET + 1;
    double mantissa = frexp(shortest, &exponent);
    assert(shortest >= 0 && shortest < HUGE_VAL);
    int bucket = first + 4 * (exponent - r->least_exponent) + (int)(8 * mantissa) - 4;
    return bucket < first ? first : bucket >= TRI_BUCKETS ? TRI_BUCKETS - 1 : bucket;
}

/* Does a corner of the triangle see the opposite subsegment under too wide an angle? */
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

bool tri_push_angle(struct tri_refiner *r, tri_triangle_id triangle, double shortest)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    assert(triangle >= 0 && tri_is_live(t));
    int bucket = encroaches_opposite(r, t) ? TRI_URGENT_BUCKET : bucket_of(r, shortest);
    return tri_bad_queue_push_angle(&r->queue, (struct tri_entry){triangle, t->generation}, bucket);
}

static bool push(struct tri_refiner *r, tri_triangle_id triangle, enum tri_badness badness, double shortest)
{
    struct tri_entry entry = {triangle, r->mesh->tri[triangle].generation};
    assert(badness != TRI_GOOD && tri_is_live(&r->mesh->tri[triangle]));
    return badness == TRI_BAD_ANGLE ? tri_push_angle(r, triangle, shortest)
                                    : tri_bad_queue_push_size(&r->queue, entry, badness == TRI_BAD_SIZE);
}

/* Queues the triangle unless it is good or its only fault is `other`. */
static bool queue_unless(struct tri_refiner *r, tri_triangle_id triangle, enum tri_badness other)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
    enum tri_badness badness = tri_refiner_judge(r, t, &shape);
    return badness == TRI_GOOD || badness == other || push(r, triangle, badness, shape.l[shape.shortest]);
}

/* Judges the new triangles if hooks->urgent selects some of them. */
static bool judge_urgent(struct tri_refiner *r)
{
    for (int32_t i = 0; i < r->cavity.n_edges; i++)
        if (!queue_unless(r, r->cavity.tri[i], TRI_GOOD))
            return false;
    return true;
}

/* Judges the new triangle on a cavity edge, using the coordinates that the cavity search has computed. */
static inline bool judge_on_edge(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_cavity_edge *edge)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    const struct tri_relative a = edge[0].a->r, b = edge[1].a->r;
    double area2 = edge->area2, x = a.x - b.x, y = a.y - b.y, l = x * x + y * y;
    if (area2 * area2 < r->criterion.bounds.sin2 * tri_longer_product(a.l, b.l, l))
        return tri_push_angle(r, triangle, tri_lesser(a.l, tri_lesser(b.l, l)));
    bool is_bad = area2 > tri_area2_bound(&r->criterion.asked, edge->region);
    if (r->quality->lengths)
        is_bad = is_bad || tri_is_too_long(&r->criterion.asked, t->v, a.l, b.l, l, area2);
    if (tri_asks_caller(r->quality))
        is_bad = is_bad || tri_is_unsuitable(&r->criterion.asked, t->v);
    return tri_bad_queue_push_size(&r->queue, (struct tri_entry){triangle, t->generation}, is_bad);
}

bool tri_queue_fan(struct tri_refiner *r)
{
    const struct tri_cavity *c = &r->cavity;
    if (r->hooks->urgent)
        return judge_urgent(r);
    if (r->stage == FRONT_STAGE)
        return tri_front_queue_fan(r);
    for (int32_t i = 0; i < c->n_edges; i++)
        if (!judge_on_edge(r, c->tri[i], &c->edge[i]))
            return false;
    return true;
}

/* All triangles of the fan are made even if memory for the queue runs out. */
bool tri_fill_and_queue(struct tri_refiner *r, tri_vertex_id v)
{
    if (r->hooks->urgent || r->stage == FRONT_STAGE) {
        tri_cavity_fill(&r->cavity, r->mesh, v);
        return tri_queue_fan(r);
    }
    tri_cavity_number_fan(&r->cavity, r->mesh);
    const int32_t n = r->cavity.n_edges;
    const tri_triangle_id *id = r->cavity.tri;
    const struct tri_cavity_edge *edge = r->cavity.edge;
    bool room = true;
    for (int32_t i = 0; i < n; i++) {
        tri_make_fan_triangle(r->mesh, v, &edge[i], id[i > 0 ? i - 1 : n - 1], id[i], id[i + 1]);
        room = judge_on_edge(r, id[i], &edge[i]) && room;
    }
    return room;
}

bool tri_queue_subsegment(struct tri_refiner *r, tri_sub_id s)
{
    assert(s >= 0);
    if (!tri_grow(&r->encroached, &r->encroached_capacity, r->n_encroached + 1, sizeof *r->encroached))
        return false;
    r->encroached[r->n_encroached++] = s;
    return true;
}

/* For conforming meshes: the new vertex may lie in the diametral circles of the cavity's walls. */
bool tri_queue_walls(struct tri_refiner *r)
{
    const int32_t n = r->quality->conforming ? r->cavity.n_wall : 0;
    for (int32_t i = 0; i < n; i++)
        if (!tri_queue_subsegment(r, ~r->cavity.edge[r->cavity.wall[i]].outer))
            return false;
    return true;
}

bool tri_queue_triangle(struct tri_refiner *r, tri_triangle_id triangle, bool sizes)
{
    return !tri_is_live(&r->mesh->tri[triangle]) || queue_unless(r, triangle, sizes ? TRI_BAD_ANGLE : TRI_BAD_SIZE);
}

bool tri_queue_beside(struct tri_refiner *r, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    for (int e = 0; tri_is_live(t) && e < 3; e++)
        if (t->n[e] < 0 && !tri_queue_subsegment(r, ~t->n[e]))
            return false;
    return true;
}
