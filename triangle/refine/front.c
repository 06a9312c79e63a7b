/* The front stage comes before the usual stage. It divides segments, then refines all triangles that are too large
 * for the wanted lengths h.
 *
 * A segment is divided into parts over which the integral of ds / h is the same: it is split recursively, and each
 * half gets half of the parts. Beside an acute vertex it is split on concentric shells instead (split.h). In a block
 * of a schedule, free vertices of the coarse mesh are then erased if their star lies in the fence, because their
 * positions do not fit the wanted lengths. Each is erased at most once, and refinement creates no further ones.
 *
 * INVARIANT. Each triangle that is too large waits in one of the two stacks, or has been deferred or given up. */
#include "triangle/refine/refiner.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/geometry/predicates.h"
#include "triangle/refine/split.h"
#include "triangle/tunables.h"

void tri_front_free(struct tri_front *front)
{
    free(front->on.item);
    free(front->off.item);
    free(front->large);
}

/* --- waiting triangles */

static bool is_large(const struct tri_refiner *r, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    const struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
    return tri_is_too_large(&r->criterion.asked, t, &shape);
}

static bool push(struct tri_refiner *r, struct tri_front_stack *to, tri_triangle_id t)
{
    if (!tri_grow(&to->item, &to->capacity, to->n + 1, sizeof *to->item))
        return false;
    to->item[to->n++] = (struct tri_entry){t, r->mesh->tri[t].generation};
    return true;
}

/* Queues a triangle that is not too large for the usual stage if its angle is bad. a, b, c: its squared edge
 * lengths. Returns false if memory ran out. */
static bool push_angle(struct tri_refiner *r, tri_triangle_id id, double a, double b, double c, double area2)
{
    return area2 * area2 >= r->criterion.bounds.sin2 * tri_longer_product(a, b, c) ||
           tri_push_angle(r, id, tri_lesser(a, tri_lesser(b, c)));
}

/* Is the new triangle on cavity edge i too large? If not, queues it if its angle is bad. Sets *room to false if
 * memory ran out. */
static bool is_fan_triangle_large(struct tri_refiner *r, int32_t i, bool *room)
{
    const struct tri_cavity_edge *edge = &r->cavity.edge[i];
    const struct tri_relative a = edge[0].a->r, b = edge[1].a->r;
    const tri_triangle_id id = r->cavity.tri[i];
    const struct tri_triangle *t = &r->mesh->tri[id];
    const double x = a.x - b.x, y = a.y - b.y, l = x * x + y * y, area2 = edge->area2;
    const struct tri_asked *asked = &r->criterion.asked;
    if (tri_is_too_long(asked, t->v, a.l, b.l, l, area2) || area2 > tri_area2_bound(asked, edge->region) ||
        (tri_asks_caller(r->quality) && tri_is_unsuitable(asked, t->v)))
        return true;
    *room = push_angle(r, id, a.l, b.l, l, area2) && *room;
    return false;
}

/* Pushes the new triangles that are too large, and the neighbours of new triangles that are too large and now lie on
 * the front. */
bool tri_front_queue_fan(struct tri_refiner *r)
{
    const struct tri_cavity *c = &r->cavity;
    struct tri_front *f = &r->front;
    const int32_t n = c->n_edges;
    bool room = tri_grow(&f->large, &f->capacity, n, sizeof *f->large);
    for (int32_t i = 0; room && i < n; i++)
        f->large[i] = is_fan_triangle_large(r, i, &room);
    for (int32_t i = 0; room && i < n; i++) {
        const struct tri_triangle *t = &r->mesh->tri[c->tri[i]];
        const tri_link outer = c->edge[i].outer;
        const bool between = f->large[i > 0 ? i - 1 : n - 1] && f->large[i + 1 < n ? i + 1 : 0] && t->n[1] >= 0 &&
                             t->n[2] >= 0;
        if (f->large[i])
            room = push(r, between && outer >= 0 && is_large(r, tri_of(outer)) ? &f->off : &f->on, c->tri[i]);
        else if (outer >= 0 && is_large(r, tri_of(outer)))
            room = push(r, &f->on, tri_of(outer));
    }
    return room;
}

bool tri_front_next(struct tri_refiner *r)
{
    struct tri_front_stack *from = r->front.on.n > 0 ? &r->front.on : &r->front.off;
    if (from->n == 0)
        return false;
    r->hand = from->item[--from->n];
    return true;
}

/* --- new points */

/* Returns the front edge whose length is closest to the wanted length, or -1 if no edge of the triangle is on the
 * front. h: wanted lengths at the corners. */
static int best_edge(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape,
                     const double h[3])
{
    double least = HUGE_VAL;
    int best = -1;
    for (int e = 0; e < 3; e++) {
        const double mean = 0.5 * (h[tri_next[e]] + h[tri_prev[e]]), ratio = shape->l[e] / (mean * mean);
        const double off = ratio > 1 ? ratio : 1 / ratio;
        if (off < least && (t->n[e] < 0 || !is_large(r, tri_of(t->n[e])))) {
            least = off;
            best = e;
        }
    }
    return best;
}

/* A triangle and its circumcentre. The origin of the coordinates is a, and the x axis is along the chosen edge ab. */
struct stand {
    struct tri_point a; /* first end of the edge */
    double x, y;       /* unit vector from a to b */
    double length;     /* of the edge */
    double cx, cy;     /* circumcentre relative to a: along the edge, and perpendicular to it */
    double ha, hb;     /* wanted lengths at a and at b */
};

static struct stand stand_on(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape,
                             int e, const double h[3])
{
    const struct tri_point a = r->mesh->xy[t->v[tri_next[e]]], b = r->mesh->xy[t->v[tri_prev[e]]],
                           c = r->mesh->xy[t->v[e]];
    const double length = sqrt(shape->l[e]), x = (b.x - a.x) / length, y = (b.y - a.y) / length;
    const double along = (c.x - a.x) * x + (c.y - a.y) * y, up = shape->area2 / length;
    const double cy = 0.5 * (up + along * (along - length) / up);
    return (struct stand){a, x, y, length, 0.5 * length, cy, h[tri_next[e]], h[tri_prev[e]]};
}

static struct tri_point point_at(const struct stand *s, double along, double up)
{
    return (struct tri_point){s->a.x + along * s->x - up * s->y, s->a.y + along * s->y + up * s->x};
}

/* Finds the apex over the edge in three fixed-point steps. Each leg has the mean of the wanted lengths at its end of
 * the edge and at the apex. Returns false if the apex does not lie well below the circumcentre. */
static bool find_apex(const struct tri_refiner *r, const struct stand *s, double *along, double *up)
{
    const double mean = 0.5 * (s->ha + s->hb);
    double leg = mean;
    for (int step = 0; step < 3; step++) {
        const double a = leg + 0.5 * (s->ha - mean), b = leg + 0.5 * (s->hb - mean);
        const double least = 0.25 * leg * leg, up2 = leg * leg - 0.25 * s->length * s->length;
        *along = 0.5 * s->length + 0.5 * (a * a - b * b) / s->length;
        *up = sqrt(tri_larger(up2, least));
        if (*up * TRI_FRONT_CUSHION >= s->cy)
            return false;
        leg = 0.5 * (mean + tri_wanted_at(&r->criterion.asked, point_at(s, *along, *up)));
    }
    const double radius = sqrt(s->cx * s->cx + s->cy * s->cy), x = *along - s->cx, y = *up - s->cy;
    return radius - sqrt(x * x + y * y) >= TRI_FRONT_APART * mean;
}

struct tri_point tri_front_place(const struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    double h[3], along, up;
    for (int k = 0; k < 3; k++)
        h[k] = tri_wanted_of(&r->criterion.asked, t->v[k]);
    const int e = best_edge(r, t, shape, h);
    const struct stand s = stand_on(r, t, shape, e >= 0 ? e : shape->shortest, h);
    const bool is_apex = find_apex(r, &s, &along, &up);
    const struct tri_point p = is_apex ? point_at(&s, along, up) : point_at(&s, s.cx, s.cy);
    return (struct tri_point){tri_round_coordinate(p.x), tri_round_coordinate(p.y)};
}

/* --- segments */

/* Walks along a subsegment until the integral of ds / h is `count`. Returns the integral reached, and sets *fraction
 * to the point reached. In each step of a quarter of h, h counts as the mean of both ends. Takes a limited number of
 * steps; if the subsegment needs more, *fraction is 0.5, so that it is halved first. */
static double integrate(const struct tri_refiner *r, const struct tri_subsegment *s, double count, double *fraction)
{
    enum { MOST_STEPS = 1 << 16 };
    const struct tri_point a = r->mesh->xy[s->v[0]], b = r->mesh->xy[s->v[1]];
    const double length = sqrt(tri_distance2(a, b));
    double at = 0, sum = 0, h = tri_wanted_of(&r->criterion.asked, s->v[0]);
    for (int i = 0; i < MOST_STEPS && at < length; i++) {
        const double step = tri_lesser(0.25 * h, length - at);
        const double next = at + step < length
                                ? tri_wanted_at(&r->criterion.asked, tri_point_between(a, b, (at + step) / length))
                                : tri_wanted_of(&r->criterion.asked, s->v[1]);
        const double mean = 0.5 * (h + next);
        if (sum + step / mean >= count) {
            *fraction = (at + (count - sum) * mean) / length;
            return count;
        }
        sum += step / mean;
        at += step;
        h = next;
    }
    *fraction = at < length ? 0.5 : 1;
    return sum;
}

/* Finds where to divide the subsegment. Returns false if it is short enough or must not be split. */
static bool find_division(const struct tri_refiner *r, const struct tri_subsegment *s, double *fraction)
{
    const double all = integrate(r, s, HUGE_VAL, fraction);
    const int parts = (int)tri_lesser(all + 0.5, 1e9);
    if (parts < 2 || tri_is_protected(r->quality, s))
        return false;
    if (r->mesh->on[s->v[0]] == TRI_VERTEX_ACUTE || r->mesh->on[s->v[1]] == TRI_VERTEX_ACUTE)
        *fraction = tri_split_fraction(r->mesh, s);
    else if (*fraction == 1)
        integrate(r, s, all * (parts / 2) / parts, fraction);
    return *fraction > 0.01 && *fraction < 0.99;
}

/* Divides the waiting subsegments, and then their parts, until no part needs to be divided. */
static bool divide(struct tri_refiner *r)
{
    while (r->n_encroached > 0) {
        if (tri_refiner_must_stop(r))
            return false;
        const tri_sub_id s = r->encroached[r->n_encroached - 1];
        double fraction;
        if (!find_division(r, &r->mesh->sub[s], &fraction)) {
            r->n_encroached--;
            continue;
        }
        const enum tri_outcome outcome = tri_divide_at(r, s, fraction);
        if (outcome == FAILED)
            return false;
        r->n_encroached -= outcome != DONE;
        if (outcome == DONE && !tri_queue_subsegment(r, r->mesh->n_subs - 1)) /* the second half */
            return false;
    }
    return true;
}

/* Pushes all subsegments beside the worklist at once. They are pushed before any of them is divided, since a
 * division changes the triangles beside them. */
static bool list_segments(struct tri_refiner *r)
{
    bool room = true;
    for (int32_t i = r->n_worklist - 1; room && i >= 0; i--)
        room = tri_queue_beside(r, tri_worklist_triangle(r, i));
    return room;
}

/* --- erasing vertices of the coarse mesh */

enum { MOST_STAR = 64 };

/* The triangles around a vertex. The rim is the polygon of their outer edges. */
struct star {
    int n;                     /* number of triangles */
    tri_triangle_id id[MOST_STAR];          /* [n] triangles in counter-clockwise order */
    tri_vertex_id rim[MOST_STAR];           /* [n] rim vertex at which triangle i begins */
    tri_link outer[MOST_STAR]; /* link across the edge from rim[i] to rim[i + 1] */
    int next[MOST_STAR], before[MOST_STAR]; /* neighbours of corner i in the rest of the rim */
};

/* Collects the star of v. DONE: all of it may be changed. */
static enum tri_outcome find_star(struct tri_refiner *r, tri_triangle_id first, tri_vertex_id v, struct star *star)
{
    const struct tri_mesh *m = r->mesh;
    tri_triangle_id at = first;
    star->n = 0;
    do {
        const struct tri_triangle *t = &m->tri[at];
        const int k = tri_corner_of(t, v);
        if (star->n == MOST_STAR || t->region != m->tri[first].region || !tri_fence_owns(r->hooks->fence, m, at))
            return REFUSED;
        for (int e = 0; e < 2; e++) { /* the outer edge, then the edge to the next triangle */
            const int edge = e == 0 ? k : tri_next[k];
            if (t->n[edge] == TRI_BEYOND)
                return tri_request_beyond(r, (tri_vertex_id[2]){t->v[tri_next[edge]], t->v[tri_prev[edge]]});
        }
        if (t->n[tri_next[k]] < 0)
            return REFUSED;
        assert(tri_owners_claim(r->hooks->owners, at));
        star->id[star->n] = at;
        star->rim[star->n] = t->v[tri_next[k]];
        star->outer[star->n++] = t->n[k];
        at = tri_of(t->n[tri_next[k]]);
    } while (at != first);
    for (int i = 0; i < star->n; i++) {
        star->next[i] = i + 1 < star->n ? i + 1 : 0;
        star->before[i] = i > 0 ? i - 1 : star->n - 1;
    }
    return DONE;
}

/* Does the triangle of corner i and its two rim neighbours belong to the rim's Delaunay triangulation? */
static bool is_ear(const struct star *s, const struct tri_point *xy, int i)
{
    const int a = s->before[i], c = s->next[i];
    const struct tri_point p[3] = {xy[s->rim[a]], xy[s->rim[i]], xy[s->rim[c]]};
    bool is = tri_orient2d(p[0], p[1], p[2]) > 0;
    for (int k = s->next[c]; is && k != a; k = s->next[k])
        is = tri_incircle(p[0], p[1], p[2], xy[s->rim[k]]) <= 0;
    return is;
}

/* Cuts ears off the rim until it is empty, and lists the n - 2 ears in order. Returns false if rounding leaves no
 * ear. */
static bool find_ears(struct star *s, const struct tri_point *xy, int ear[MOST_STAR][3])
{
    int i = 0, since = 0, n = 0;
    for (int left = s->n; left > 2; since++) {
        if (since > left)
            return false;
        if (!is_ear(s, xy, i)) {
            i = s->next[i];
            continue;
        }
        const int a = s->before[i], c = s->next[i];
        ear[n][0] = a;
        ear[n][1] = i;
        ear[n++][2] = c;
        s->next[a] = c;
        s->before[c] = a;
        i = a;
        since = -1;
        left--;
    }
    return true;
}

/* Replaces the first n - 2 triangles of the star by the ears. */
static void fill_star(struct tri_refiner *r, struct star *s, int ear[MOST_STAR][3])
{
    struct tri_mesh *m = r->mesh;
    for (int k = 0; k < s->n - 2; k++) {
        const int a = ear[k][0], b = ear[k][1], c = ear[k][2];
        struct tri_triangle *t = &m->tri[s->id[k]];
        *t = (struct tri_triangle){{s->rim[a], s->rim[b], s->rim[c]}, {s->outer[b], TRI_BEYOND, s->outer[a]},
                                   t->region, t->generation + 1};
        tri_relink(m, s->outer[a], s->rim[a], tri_code(s->id[k], 2));
        tri_relink(m, s->outer[b], s->rim[b], tri_code(s->id[k], 0));
        if (k + 1 < s->n - 2) {
            s->outer[a] = tri_code(s->id[k], 1);
            continue;
        }
        t->n[1] = s->outer[c];
        tri_relink(m, s->outer[c], s->rim[c], tri_code(s->id[k], 1));
    }
}

/* Erases v: replaces its star by the Delaunay triangulation of the rim, if the star may be changed. */
static enum tri_outcome erase_vertex(struct tri_refiner *r, tri_triangle_id first, tri_vertex_id v)
{
    struct star star;
    int ear[MOST_STAR][3];
    const enum tri_outcome outcome = find_star(r, first, v, &star);
    if (outcome != DONE || !find_ears(&star, r->mesh->xy, ear))
        return outcome == DONE ? REFUSED : outcome;
    fill_star(r, &star, ear);
    for (int k = star.n - 2; k < star.n; k++) {
        r->mesh->tri[star.id[k]].v[0] = TRI_NONE;
        r->mesh->tri[star.id[k]].generation++;
    }
    r->mesh->on[v] = TRI_VERTEX_NONE;
    r->report->inserted_free--;
    if (r->hooks->part)
        r->hooks->part->changed(r->hooks->part->user, star.id, star.n);
    r->hooks->erased(r->hooks->erased_user, v, &star.id[star.n - 2]);
    bool room = true;
    for (int k = 0; room && k < star.n - 2; k++) {
        const struct tri_shape s = tri_shape_of(r->mesh->xy, r->mesh->tri[star.id[k]].v);
        room = is_large(r, star.id[k]) ? push(r, &r->front.off, star.id[k])
                                       : push_angle(r, star.id[k], s.l[0], s.l[1], s.l[2], s.area2);
    }
    return room ? DONE : FAILED;
}

/* Erases those corners of a too large triangle that may be erased. Returns false on failure or a pause; call it
 * again to resume. */
static bool erase_corners(struct tri_refiner *r, tri_triangle_id id)
{
    const struct tri_mesh *m = r->mesh;
    for (int k = 0; k < 3 && tri_is_live(&m->tri[id]) && is_large(r, id); k++) {
        const tri_vertex_id v = m->tri[id].v[k];
        if (m->on[v] != TRI_VERTEX_FREE || !(m->length[v] < 0))
            continue;
        const enum tri_outcome outcome = erase_vertex(r, id, v);
        if (outcome == FAILED)
            return false;
        k = outcome == DONE ? -1 : k;
    }
    return true;
}

static bool erase_all(struct tri_refiner *r)
{
    const bool may = r->hooks->erased && r->hooks->fence && tri_area_scale(r->quality) <= 1;
    for (; may && r->next_listed < r->n_worklist; r->next_listed++)
        if (!erase_corners(r, tri_worklist_triangle(r, r->next_listed)))
            return false;
    return true;
}

/* --- the stage */

/* Pushes the triangles of the worklist that are too large. */
static bool push_all_large(struct tri_refiner *r)
{
    for (int32_t i = r->n_worklist - 1; i >= 0; i--) {
        const tri_triangle_id id = tri_worklist_triangle(r, i);
        const struct tri_triangle *t = &r->mesh->tri[id];
        if (!tri_is_live(t) || !is_large(r, id))
            continue;
        bool is_on = false;
        for (int e = 0; e < 3; e++)
            is_on = is_on || t->n[e] < 0 || /* listed triangles have no neighbour TRI_BEYOND */
                    !is_large(r, tri_of(t->n[e]));
        if (!push(r, is_on ? &r->front.on : &r->front.off, id))
            return false;
    }
    return true;
}

bool tri_front_begin(struct tri_refiner *r)
{
    if (r->step == NOT_BEGUN) {
        r->n_worklist = tri_worklist_length(r);
        r->step = DIVIDING;
        if (!r->quality->conforming && !list_segments(r))
            return false;
    }
    if (r->step == DIVIDING) {
        if (!r->quality->conforming && !divide(r))
            return false;
        r->next_listed = 0;
        r->step = ERASING;
    }
    if (r->step == ADVANCING)
        return true;
    if (!erase_all(r))
        return false;
    r->n_worklist = tri_worklist_length(r);
    r->step = ADVANCING;
    return push_all_large(r);
}
