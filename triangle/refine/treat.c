/* Treats one bad triangle.
 *
 * The triangle proposes a point (petal.h, place.h), and the point's cavity is searched completely. Every subsegment
 * that the point encroaches is a wall of the cavity (cavity.h). If there is one, it is split instead, and the
 * triangle proposes again if it still exists. Otherwise the point is inserted. The mesh changes only after all tests
 * have succeeded, so no change has to be undone.
 *
 * INVARIANT. A triangle is refined for its angle with three exceptions: its shortest edge is shorter than s(v) / 6
 * (feature_size.c), joins two segments that meet at an acute vertex (shell, spike), or bridges a gap that would need
 * more points than the mesh can afford (hopeless.c). Refinement for sizes is never given up: see place.c.
 *
 * A subsegment that must not be split (-Y) tolerates points in its lens at a distance of at least TRI_CLEARANCE
 * times the shortest edge: docs/theory.md, protected walls. */
#include "triangle/refine/refiner.h"

#include <assert.h>

#include "triangle/geometry/predicates.h"
#include "triangle/refine/lattice.h"
#include "triangle/refine/petal.h"
#include "triangle/refine/place.h"
#include "triangle/refine/split.h"
#include "triangle/size/feature_size.h"
#include "triangle/size/hopeless.h"
#include "triangle/tunables.h"

/* 4 / sqrt(3): the squared edge of an equilateral triangle is this times its area. */
static const double EQUILATERAL = 2.3094010767585030580;

/* The predicates cannot handle points farther out. They occur if rounding has reduced a triangle's area to nearly
 * zero. */
static const double FARTHEST = TRI_LARGEST_COORDINATE / 2;

static enum tri_status find_room(struct tri_refiner *r, int32_t points)
{
    struct tri_mesh *m = r->mesh;
    if (r->hooks->more_room)
        return r->error.status = r->hooks->more_room(r->hooks->more_room_user, m, points, &r->error);
    enum tri_status status = tri_mesh_reserve_vertices(m, points, &r->error);
    status = status ? status : tri_mesh_reserve_triangles(m, 2 * points, &r->error);
    return status ? status : tri_mesh_reserve_subs(m, 1, &r->error);
}

enum tri_status tri_make_room(struct tri_refiner *r, int32_t points)
{
    const struct tri_mesh *m = r->mesh;
    bool has_room = m->vertex_capacity - m->n_vertices >= points &&
                    m->triangle_capacity - m->n_triangles >= 2 * points && m->sub_capacity > m->n_subs;
    return has_room ? TRI_OK : find_room(r, points);
}

tri_vertex_id tri_add_vertex(struct tri_refiner *r, struct tri_point p, int32_t on, int32_t marker)
{
    struct tri_mesh *m = r->mesh;
    assert(m->n_vertices < m->vertex_capacity && tri_is_in_range(p));
    assert(on == TRI_VERTEX_FREE || (on >= 0 && on < m->n_parents));
    tri_vertex_id v = m->n_vertices++;
    m->xy[v] = p;
    m->on[v] = on;
    m->vertex_markers[v] = marker;
    if (m->has_lengths) {
        const bool is_coarse = r->hooks->urgent || tri_area_scale(r->quality) > 1;
        m->length[v] = copysign(tri_lengths_at(r->quality->lengths, p), is_coarse ? -1 : 1);
    }
    return v;
}

static void report_changes(const struct tri_refiner *r)
{
    if (r->hooks->part)
        r->hooks->part->changed(r->hooks->part->user, r->cavity.tri, r->cavity.n_edges);
}

/* Inserts p, whose cavity has been found, on behalf of a triangle. most: upper bound on the feature size at p. */
static enum tri_outcome insert_free(struct tri_refiner *r, struct tri_point p, tri_triangle_id triangle,
                                const struct tri_shape *shape, double most)
{
    assert(p.x == r->cavity.p.x && p.y == r->cavity.p.y && r->cavity.n_edges == r->cavity.n_tri + 2);
    if (tri_make_room(r, 1))
        return FAILED;
    tri_vertex_id v = tri_add_vertex(r, p, TRI_VERTEX_FREE, 0);
    const tri_vertex_id *corner = r->mesh->tri[triangle].v;
    const double feature = tri_feature_inside(r->mesh, corner[tri_next[shape->shortest]],
                                              corner[tri_prev[shape->shortest]], p, r->sized);
    r->mesh->feature[v] = tri_lesser(feature, most);
    bool room = tri_fill_and_queue(r, v);
    report_changes(r);
    r->report->inserted_free++;
    return room && tri_queue_walls(r) ? DONE : FAILED;
}

static bool at_limit(struct tri_refiner *r)
{
    int64_t inserted = r->report->inserted_free + r->report->inserted_on_segments;
    assert(r->quality->max_steiner < 0 || inserted <= r->quality->max_steiner);
    if (r->quality->max_steiner < 0 || inserted < r->quality->max_steiner)
        return false;
    return r->report->hit_limit = true;
}

/* Defers the triangle and counts it. TRI_NONE: there is no triangle to defer. */
static enum tri_outcome defer(struct tri_refiner *r, tri_triangle_id triangle, int64_t *counter)
{
    *counter += triangle != TRI_NONE;
    if (r->hooks->deferred && triangle != TRI_NONE)
        r->hooks->deferred(r->hooks->deferred_user, triangle);
    return DEFERRED;
}

/* Changes nothing. The step is tried again when more of the mesh is available. */
enum tri_outcome tri_request_beyond(struct tri_refiner *r, const tri_vertex_id edge[2])
{
    assert(r->hooks->part);
    r->hooks->part->beyond(r->hooks->part->user, edge);
    r->error.status = TRI_NO_ROOM;
    return FAILED;
}

static enum tri_outcome refuse(struct tri_refiner *r, enum tri_excuse excuse)
{
    assert(excuse < TRI_EXCUSES);
    r->excuse = excuse;
    return REFUSED;
}

/* Gives up a triangle or, if `triangle` is TRI_NONE, a subsegment. */
static enum tri_outcome give_up(struct tri_refiner *r, tri_triangle_id triangle, enum tri_excuse excuse)
{
    r->report->given_up[excuse]++;
    if (r->hooks->given_up && triangle != TRI_NONE)
        r->hooks->given_up(r->hooks->given_up_user, triangle);
    return GIVEN_UP;
}

static bool is_in_circle(const struct tri_mesh *m, tri_sub_id s, struct tri_point p)
{
    return tri_dot(m->xy[m->sub[s].v[0]], m->xy[m->sub[s].v[1]], p) < 0;
}

/* Returns a wall of the cavity that has `level` as an end and the new point in its circle, or TRI_NONE. */
static tri_sub_id wall_out_of_level(const struct tri_refiner *r, tri_vertex_id level)
{
    const struct tri_mesh *m = r->mesh;
    for (int32_t i = 0; i < r->cavity.n_wall; i++) {
        tri_sub_id wall = ~r->cavity.edge[r->cavity.wall[i]].outer;
        const tri_vertex_id *end = m->sub[wall].v;
        if ((end[0] == level || end[1] == level) && is_in_circle(m, wall, r->cavity.p))
            return wall;
    }
    return TRI_NONE;
}

/* Finds the cavity of the first candidate level with split->level. The new point counts as level with the vertex if
 * neither lies in the diametral circle of a subsegment that belongs to the other, although coordinates are rounded.
 * Walls that contained an earlier candidate are tested before the next search. */
static enum tri_search find_level_split(struct tri_refiner *r, tri_sub_id s, const struct tri_disk_split *split,
                                        const struct tri_split_base *base, int32_t *n_left)
{
    const struct tri_mesh *m = r->mesh;
    tri_sub_id known[2] = {s, s}; /* two walls that contained candidates; s: none yet */
    for (int choice = 0; choice < TRI_DISK_PLACES; choice++) {
        struct tri_point p;
        if (!tri_place_disk_split(m, &m->sub[s], split, base, choice, &p) ||
            !tri_leaves_disks_empty(m, &m->sub[s], p, m->xy[split->level]) ||
            (known[0] != s && is_in_circle(m, known[0], p)) || (known[1] != s && is_in_circle(m, known[1], p)))
            continue;
        enum tri_search found = tri_cavity_search_split(&r->cavity, m, p, s, n_left);
        tri_sub_id wall = found == TRI_SEARCH_FOUND ? wall_out_of_level(r, split->level) : TRI_NONE;
        if (found != TRI_SEARCH_OUTSIDE && wall == TRI_NONE)
            return found;
        if (wall != TRI_NONE) {
            known[1] = known[0];
            known[0] = wall;
        }
    }
    return TRI_SEARCH_OUTSIDE;
}

/* Finds the cavity of the first usable candidate for splitting subsegment s. Rounding may move a candidate out of
 * the circumdisk of a triangle beside s, or behind one of its edges. */
static enum tri_search find_split(struct tri_refiner *r, tri_sub_id s, const struct tri_disk_split *split,
                                  int32_t *n_left)
{
    const struct tri_mesh *m = r->mesh;
    if (!tri_can_split(m, m->xy[m->sub[s].v[0]], m->xy[m->sub[s].v[1]]))
        return TRI_SEARCH_OUTSIDE;
    const struct tri_split_base base = tri_disk_base(m, &m->sub[s], split);
    enum tri_search found = TRI_SEARCH_OUTSIDE;
    if (split->level != TRI_NONE)
        found = find_level_split(r, s, split, &base, n_left);
    struct tri_point p;
    for (int choice = 0; choice < TRI_DISK_PLACES && found == TRI_SEARCH_OUTSIDE; choice++)
        if (tri_place_disk_split(m, &m->sub[s], split, &base, choice, &p))
            found = tri_cavity_search_split(&r->cavity, m, p, s, n_left);
    return found;
}

/* Splits subsegment s on behalf of a triangle. */
static enum tri_outcome split_at(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split split,
                                 tri_triangle_id triangle)
{
    struct tri_mesh *m = r->mesh;
    const struct tri_subsegment old = m->sub[s];
    int32_t n_left;
    assert(s >= 0 && split.fraction > 0 && split.fraction < 1);
    if (tri_is_protected(r->quality, &old))
        return refuse(r, TRI_EXCUSE_PROTECTED);
    enum tri_search found = find_split(r, s, &split, &n_left);
    if (found == TRI_SEARCH_FENCED)
        return defer(r, triangle, &r->report->fenced);
    if (found == TRI_SEARCH_BEYOND)
        return tri_request_beyond(r, r->cavity.beyond);
    if (found == TRI_SEARCH_OUTSIDE)
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (found == TRI_SEARCH_NO_MEMORY || tri_make_room(r, 1))
        return FAILED;
    bool boundary = tri_is_boundary(&old);
    assert(r->cavity.n_edges > n_left || boundary);
    tri_vertex_id v = tri_add_vertex(r, r->cavity.p, old.parent, old.marker ? old.marker : boundary ? 1 : 0);
    m->feature[v] = tri_feature_on_segment(m, &r->cavity, s, r->sized);
    tri_sub_id second = tri_cavity_fill_split(&r->cavity, m, v, s, n_left);
    report_changes(r);
    r->report->inserted_on_segments++;
    bool room = tri_queue_fan(r) && tri_queue_walls(r);
    if (room && r->quality->conforming)
        room = tri_queue_subsegment(r, s) && tri_queue_subsegment(r, second);
    return room ? DONE : FAILED;
}

enum tri_outcome tri_divide_at(struct tri_refiner *r, tri_sub_id s, double fraction)
{
    r->sized = true;
    return at_limit(r) ? REFUSED : split_at(r, s, (struct tri_disk_split){fraction, TRI_NONE}, TRI_NONE);
}

static enum tri_outcome split(struct tri_refiner *r, tri_sub_id s, tri_triangle_id triangle)
{
    struct tri_disk_split usual = {tri_split_fraction(r->mesh, &r->mesh->sub[s]), TRI_NONE};
    return split_at(r, s, usual, triangle);
}

/* May the new point see this wall under any angle? True for a protected wall that is far enough away. */
static bool tolerates(const struct tri_refiner *r, int32_t i, double shortest)
{
    const struct tri_cavity *c = &r->cavity;
    if (!tri_is_protected(r->quality, &r->mesh->sub[~c->edge[i].outer]))
        return false;
    struct tri_relative a = c->edge[i].a->r, b = c->edge[i + 1].a->r;
    double x = b.x - a.x, y = b.y - a.y, area2 = c->edge[i].area2;
    return area2 * area2 > TRI_CLEARANCE * TRI_CLEARANCE * shortest * (x * x + y * y);
}

/* Does the new point lie on the wrong side of wall i (then sets *behind), or see it under too wide an angle?
 * shortest: shortest squared edge of the bad triangle. */
static bool encroaches(const struct tri_refiner *r, int32_t i, double shortest, bool *behind)
{
    const struct tri_cavity *c = &r->cavity;
    const struct tri_cavity_corner *a = c->edge[i].a, *b = c->edge[i + 1].a;
    assert(i >= 0 && i < c->n_edges && c->edge[i].outer < 0); /* it is a wall */
    double cross = c->edge[i].area2, dot = a->r.x * b->r.x + a->r.y * b->r.y;
    *behind = false;
    if (dot >= 0 && cross > 0)
        return false;
    bool in_lens = dot < 0 && dot * dot > r->criterion.bounds.lens_cos2 * a->r.l * b->r.l;
    if (in_lens && !tolerates(r, i, shortest))
        return true;
    *behind = tri_orient2d(c->p, r->mesh->xy[a->v], r->mesh->xy[b->v]) <= 0;
    return *behind;
}

/* Returns the subsegment to split instead of inserting the new point: a wall that hides the point if there is one,
 * otherwise the first wall that it encroaches. shortest: shortest squared edge of the bad triangle. */
static tri_sub_id find_encroached(const struct tri_refiner *r, double shortest)
{
    tri_sub_id found = TRI_NONE;
    for (int32_t i = 0; i < r->cavity.n_wall; i++) {
        bool behind;
        if (!encroaches(r, r->cavity.wall[i], shortest, &behind))
            continue;
        if (behind)
            return ~r->cavity.edge[r->cavity.wall[i]].outer;
        if (found == TRI_NONE)
            found = ~r->cavity.edge[r->cavity.wall[i]].outer;
    }
    return found;
}

/* Returns the largest height at which the new point may lie over the triangle's shortest edge. */
static double reach_of(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape,
                       enum tri_badness badness)
{
    double l = shape->l[shape->shortest];
    if (r->hooks->urgent)
        return HUGE_VAL;
    assert(l > 0 && badness != TRI_GOOD);
    double reach = r->criterion.bounds.off_centre > 0 ? r->criterion.bounds.off_centre * sqrt(l) : HUGE_VAL;
    double area2_bound = tri_area2_bound(&r->criterion.asked, t->region);
    if (badness == TRI_BAD_SIZE && shape->area2 > area2_bound) {
        double ideal2 = TRI_IDEAL * EQUILATERAL * 0.5 * area2_bound - 0.25 * l;
        reach = tri_lesser(ideal2 > 0.25 * l ? sqrt(ideal2) : HUGE_VAL, reach);
    }
    return reach;
}

/* Finds the cavity of a new point for a triangle. DONE: it is found, and the call may change it. */
static enum tri_outcome find_cavity(struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p)
{
    if (!(fabs(p.x) < FARTHEST && fabs(p.y) < FARTHEST))
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (r->hooks->gate) {
        double at[2] = {p.x * r->mesh->unit, p.y * r->mesh->unit};
        if (!r->hooks->gate(r->hooks->gate_user, at))
            return defer(r, triangle, &r->report->gated);
    }
    if (r->hooks->fence && !tri_fence_holds(r->hooks->fence, p)) /* its cavity would cross the fence as well */
        return defer(r, triangle, &r->report->fenced);
    switch (tri_cavity_search(&r->cavity, r->mesh, p, triangle)) {
    case TRI_SEARCH_FOUND: return DONE;
    case TRI_SEARCH_FENCED: return defer(r, triangle, &r->report->fenced);
    case TRI_SEARCH_BEYOND: return tri_request_beyond(r, r->cavity.beyond);
    case TRI_SEARCH_OUTSIDE: return refuse(r, TRI_EXCUSE_PRECISION);
    default: return FAILED;
    }
}

/* Finds the best point *p for a bad angle, and its cavity. REFUSED: use the standard point. */
static enum tri_outcome find_best(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape,
                                  struct tri_point *p)
{
    tri_vertex_id beyond[2];
    switch (tri_petal_point(r->mesh, r->hooks->fence, triangle, shape, r->criterion.bounds.off_centre, p, beyond)) {
    case TRI_PETAL_BETTER: return find_cavity(r, triangle, *p);
    case TRI_PETAL_BEYOND: return tri_request_beyond(r, beyond);
    default: return REFUSED;
    }
}

/* Finds the lattice point *p for a triangle, and its cavity. Sets *most for insert_free. REFUSED: there is none. */
static enum tri_outcome find_in_lattice(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape,
                                        struct tri_point *p, double *most)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    const double area2 = tri_area2_bound(&r->criterion.asked, t->region) / tri_area_scale(r->quality);
    if (!(r->edge > 0) && (!r->lattice || !(area2 < HUGE_VAL)))
        return REFUSED;
    const struct tri_lattice lattice = r->edge > 0 ? tri_lattice_of(r->edge) : tri_lattice_for(area2);
    if (!tri_lattice_point(&lattice, r->mesh->xy, t->v, shape, p))
        return REFUSED;
    const enum tri_outcome outcome = find_cavity(r, triangle, *p);
    if (outcome == DONE && !tri_lattice_is_clear(&r->cavity, &lattice))
        return REFUSED;
    *most = lattice.feature;
    return outcome;
}

/* Inserts p, whose cavity has been found, or splits a subsegment that p encroaches (AGAIN). most: as in insert_free;
 * bad: the triangle to defer if necessary, or TRI_NONE. */
static enum tri_outcome insert_or_split(struct tri_refiner *r, struct tri_point p, tri_triangle_id triangle,
                                        const struct tri_shape *shape, double most, tri_triangle_id bad)
{
    assert(r->cavity.n_tri > 0 && r->cavity.tri[0] == triangle);
    tri_sub_id s = find_encroached(r, shape->l[shape->shortest]);
    if (s == TRI_NONE)
        return insert_free(r, p, triangle, shape, most);
    if (tri_is_flat(r->mesh, shape))
        return refuse(r, TRI_EXCUSE_PRECISION);
    const enum tri_outcome outcome = split(r, s, bad);
    return outcome == DONE ? AGAIN : outcome;
}

/* Inserts the lattice point, the best or the standard point, or splits a subsegment that this point encroaches. */
static enum tri_outcome propose(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape,
                                enum tri_badness badness)
{
    const struct tri_triangle t = r->mesh->tri[triangle];
    struct tri_point p;
    double most = HUGE_VAL;
    enum tri_outcome outcome = find_in_lattice(r, triangle, shape, &p, &most);
    if (outcome == REFUSED && badness == TRI_BAD_ANGLE && !r->sized && !r->hooks->urgent)
        outcome = find_best(r, triangle, shape, &p);
    if (outcome == REFUSED) {
        p = r->stage == FRONT_STAGE ? tri_front_place(r, triangle, shape)
                                    : tri_place(r->mesh->xy, t.v, shape, reach_of(r, &t, shape, badness));
        outcome = find_cavity(r, triangle, p);
    }
    return outcome == DONE ? insert_or_split(r, p, triangle, shape, most, triangle) : outcome;
}

enum tri_outcome tri_insert_in_lattice(struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p,
                                       const struct tri_lattice *lattice)
{
    const struct tri_shape shape = tri_shape_of(r->mesh->xy, r->mesh->tri[triangle].v);
    if (r->hooks->fence && !tri_fence_holds(r->hooks->fence, p))
        return REFUSED;
    r->sized = true;
    switch (tri_cavity_search(&r->cavity, r->mesh, p, triangle)) {
    case TRI_SEARCH_FOUND: break;
    case TRI_SEARCH_BEYOND: return tri_request_beyond(r, r->cavity.beyond);
    case TRI_SEARCH_NO_MEMORY: return FAILED;
    default: return REFUSED;
    }
    if (!tri_lattice_is_clear(&r->cavity, lattice))
        return REFUSED;
    return insert_or_split(r, p, triangle, &shape, lattice->feature, TRI_NONE);
}

/* The fallback for sizes if the standard point is refused: see place.c. */
static enum tri_outcome propose_inside(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape)
{
    tri_sub_id s = tri_long_wall(r->mesh, r->quality, triangle, shape);
    enum tri_outcome outcome = s == TRI_NONE ? REFUSED : split(r, s, triangle);
    if (outcome != REFUSED)
        return outcome == DONE ? AGAIN : outcome;
    struct tri_point p;
    if (!tri_centroid(r->mesh, triangle, shape, &p))
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (tri_is_walled_in(&r->criterion.asked, triangle, shape))
        return refuse(r, TRI_EXCUSE_PROTECTED);
    outcome = find_cavity(r, triangle, p);
    return outcome == DONE ? insert_free(r, p, triangle, shape, HUGE_VAL) : outcome;
}

/* Called between two insertions, when the mesh is valid. */
bool tri_refiner_must_stop(struct tri_refiner *r)
{
    if (r->hooks->told && r->step_of_stop % TRI_STOP_STEPS == 0)
        r->hooks->told(r->hooks->told_user, r->mesh->n_triangles);
    return tri_stop_is_due(r->mesh->stop, &r->step_of_stop) && tri_fail_stopped(&r->error);
}

enum tri_outcome tri_treat(struct tri_refiner *r, struct tri_entry entry)
{
    for (;;) {
        const struct tri_triangle *t = &r->mesh->tri[entry.t];
        assert(entry.t >= 0 && entry.generation <= t->generation);
        if (t->generation != entry.generation || !tri_is_live(t))
            return DONE;
        struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
        enum tri_badness badness = tri_refiner_judge(r, t, &shape);
        if (badness == TRI_GOOD)
            return DONE;
        r->sized = badness == TRI_BAD_SIZE;
        if (badness == TRI_BAD_ANGLE && tri_is_hopeless(r->mesh, entry.t, &shape)) {
            if (!tri_is_too_large(&r->criterion.asked, t, &shape))
                return give_up(r, entry.t, TRI_EXCUSE_INPUT_ANGLE);
            r->sized = true;
        }
        if (at_limit(r))
            return give_up(r, entry.t, TRI_EXCUSE_LIMIT);
        bool resolved = shape.l[shape.shortest] >= r->mesh->limits.shortest2;
        enum tri_outcome outcome = resolved ? propose(r, entry.t, &shape, badness) : refuse(r, TRI_EXCUSE_PRECISION);
        if (outcome == REFUSED && tri_is_too_large(&r->criterion.asked, t, &shape)) {
            r->sized = true;
            outcome = propose_inside(r, entry.t, &shape);
        }
        if (outcome != AGAIN)
            return outcome == REFUSED ? give_up(r, entry.t, r->excuse) : outcome;
        if (tri_refiner_must_stop(r))
            return FAILED;
    }
}

bool tri_split_encroached(struct tri_refiner *r)
{
    while (r->n_encroached > 0) {
        if (tri_refiner_must_stop(r))
            return false;
        tri_sub_id s = r->encroached[r->n_encroached - 1];
        const struct tri_subsegment *sub = &r->mesh->sub[s];
        if (sub->side[0] == TRI_BEYOND || sub->side[1] == TRI_BEYOND)
            return tri_request_beyond(r, sub->v) != FAILED;
        r->n_encroached--;
        struct tri_disk_split where;
        if (!tri_is_encroached(r->mesh, sub, &where) || at_limit(r))
            continue;
        r->sized = false;
        const tri_triangle_id beside = tri_of(sub->side[0] == TRI_NONE ? sub->side[1] : sub->side[0]);
        enum tri_outcome outcome = split_at(r, s, where, beside);
        if (outcome == FAILED) {
            if (r->n_encroached < r->encroached_capacity) /* otherwise s was split, and queueing ran out of memory */
                r->encroached[r->n_encroached++] = s;
            return false;
        }
        if (outcome == REFUSED)
            give_up(r, TRI_NONE, r->excuse);
    }
    return true;
}
