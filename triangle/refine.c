/* The refinement loop.
 *
 * A bad triangle proposes a point (off-centre or circumcentre, quality.h). Its cavity is searched; the walls of the
 * cavity tell which subsegments the point would encroach. If there are any, one of them is split instead, and the
 * triangle, if it still stands, is asked again. Nothing is changed before everything is known, so nothing is ever
 * undone.
 *
 * ORDER. The walls of a cavity are all the subsegments that its point encroaches and sees only if none of them is
 * encroached already (cavity.h): the corner that encroaches it may hide it, and the point would come to lie anywhere
 * near it. So triangles with a corner that sees a subsegment of theirs under too wide an angle come before all others:
 * their points lie behind it, and it is split, unless a fence forbids that.
 * Then those with the shortest edges (bad_queue.h).
 *
 * Angles may be given up; sizes are not: a triangle that is too large and cannot have that point gets another
 * (inside.c). For -D, subsegments whose diametral circle is not empty are split before anything else (disk.c).
 *
 * COST. A triangle costs what its cavity has. That is O(1) on average, but where a wall must not be split (-Y): all
 * vertices close to it share circumdisks, so that each of n points there, and each triangle given up, may cost n.
 *
 * PROTECTED WALLS. A subsegment that must not be split stays as long as it is. If its lens were closed to points, as
 * those of others are, a long one would keep everything coarse that lies in its sight. RULE: a point in the lens of
 * such a wall, before it, is inserted if it is farther from it than CLEARANCE times the shortest edge of the triangle
 * that asks, be it for sizes or for angles; for sizes inside.c has another where it is not. THEOREM: what is said of
 * distances between points still holds, and of their number. Proof: it lies as far from all vertices as it would
 * elsewhere; half of a disk around it of a fixed share of that edge, or more, lies on its side of all walls, so that
 * the disks of all points still take up area in proportion (feature_size.c). Measured on 160 to 183 figures: -Y at 20
 * and 30 degrees 0.8 and 1.5% more triangles and 3 and 5% fewer bad ones (two parabolas in a box: 33 of 1,028,092 bad,
 * not 62,200 of 761,342); -YY at 30 and 33 degrees 4 and 5% more, and as many bad ones. A clearance of 0 or 1 fills
 * slits where that helps nobody (-YY at 33: 32 and 14% more, more of them bad); 4 gains less for -Y.
 *
 * Termination: for angles by the rules in small_angle.c and feature_size.c; the points for sizes and for
 * circles that come on top are finitely many whatever the others do, see inside.c and disk.c. */
#include "triangle/refine.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/bad_queue.h"
#include "triangle/cavity.h"
#include "triangle/census.h"
#include "triangle/criterion.h"
#include "triangle/disk.h"
#include "triangle/estimate.h"
#include "triangle/feature_size.h"
#include "triangle/grow.h"
#include "triangle/inside.h"
#include "triangle/interpolate.h"
#include "triangle/pause.h"
#include "triangle/predicates.h"
#include "triangle/quality.h"
#include "triangle/small_angle.h"
#include "triangle/split.h"

/* 4 / sqrt(3): an equilateral triangle of area A has a squared edge of this times A. The point of a triangle that is
 * only too large is placed as if to make an equilateral triangle of IDEAL of that edge, when that is nearer than the
 * circumcentre: sizes then lie closer to the bound than with circumcentres alone. */
static const double EQUILATERAL = 2.3094010767585030580, IDEAL = 0.85;

/* See PROTECTED WALLS. */
static const double CLEARANCE = 2;

enum stage { EASY_STAGE, USUAL_STAGE, LAST_STAGE };

enum step { NOT_BEGUN, FIRST_PASS, SECOND_PASS };

_Static_assert((int)LAST_STAGE == (int)TRI_PAUSE_LAST_STAGE && (int)SECOND_PASS == (int)TRI_PAUSE_LAST_STEP,
               "pause.c compares with them");

struct tri_refiner {
    struct tri_mesh *mesh;
    const struct tri_refine_options *options;
    struct tri_refine_report *report;
    struct tri_error error; /* of the run that is on */
    struct tri_criterion criterion;
    int least_exponent; /* of mesh->limits.shortest2 */
    struct tri_cavity cavity;
    struct tri_bad_queue queue;
    bool sized;       /* the triangle in hand asks for a point because of sizes, not of angles */
    enum step step;
    int limit;        /* buckets from here on wait for the second pass */
    int32_t next_listed, n_worklist;
    enum stage stage;
    enum tri_excuse excuse; /* of the last refusal */
    bool in_hand;     /* `hand` was being treated when there was no room */
    struct tri_entry hand;
    tri_sub_id *encroached; /* stack of subsegments to test for encroachment (conforming only) */
    int32_t n_encroached, encroached_capacity;
    uint32_t step_of_stop; /* see tri_stop_is_due */
};

enum { WORKLIST_CHUNK = 1 << 16 };

/* Beyond this lies no point that the predicates can carry: the triangle's area has been rounded to nothing. */
static const double FARTHEST = TRI_LARGEST_COORDINATE / 2;

/* What came of a bad triangle. */
enum outcome {
    DONE,     /* a point was inserted, or the triangle is gone */
    AGAIN,    /* a subsegment was split instead, and the triangle may still stand */
    REFUSED,  /* this point cannot be had, for the reason in `excuse`; perhaps another */
    GIVEN_UP, /* it stays, and has been counted */
    DEFERRED, /* the gate or the fence stands before it: somebody else's */
    FAILED    /* no memory, no room, or somebody asks for the end */
};

struct tri_refine_options tri_refine_defaults(void)
{
    return (struct tri_refine_options){.max_steiner = -1};
}

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

/* The same where only what is urgent counts. */
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
static bool judge_fan(struct tri_refiner *r)
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

static bool queue_encroached(struct tri_refiner *r, tri_sub_id s)
{
    assert(s >= 0 && r->options->conforming);
    if (!tri_grow(&r->encroached, &r->encroached_capacity, r->n_encroached + 1, sizeof *r->encroached))
        return false;
    r->encroached[r->n_encroached++] = s;
    return true;
}

/* For conforming meshes: the new vertex may lie in the diametral circle of a wall. */
static bool queue_walls(struct tri_refiner *r)
{
    for (int32_t i = 0; r->options->conforming && i < r->cavity.n_wall; i++)
        if (!queue_encroached(r, ~r->cavity.edge[r->cavity.wall[i]].outer))
            return false;
    return true;
}

static enum tri_status make_room(struct tri_refiner *r)
{
    struct tri_mesh *m = r->mesh;
    int32_t vertices = m->vertex_capacity - m->n_vertices, triangles = m->triangle_capacity - m->n_triangles;
    if (vertices >= 1 && triangles >= 2 && m->sub_capacity > m->n_subs)
        return TRI_OK;
    if (r->options->more_room)
        return r->error.status = r->options->more_room(r->options->more_room_user, m, &r->error);
    enum tri_status status = tri_mesh_reserve_vertices(m, 1, &r->error);
    status = status ? status : tri_mesh_reserve_triangles(m, 2, &r->error);
    return status ? status : tri_mesh_reserve_subs(m, 1, &r->error);
}

static tri_vertex_id add_vertex(struct tri_refiner *r, struct tri_point p, int32_t on, int32_t marker)
{
    struct tri_mesh *m = r->mesh;
    assert(m->n_vertices < m->vertex_capacity && tri_is_in_range(p));
    assert(on == TRI_VERTEX_FREE || (on >= 0 && on < m->n_parents));
    tri_vertex_id v = m->n_vertices++;
    m->xy[v] = p;
    m->on[v] = on;
    m->vertex_markers[v] = marker;
    return v;
}

/* The corners of the cavity's triangle that holds the new point, for interpolation. */
static const tri_vertex_id *corners_around(const struct tri_refiner *r, struct tri_point p)
{
    for (int32_t i = 0; i < r->cavity.n_tri; i++) {
        const tri_vertex_id *v = r->mesh->tri[r->cavity.tri[i]].v;
        struct tri_point a = r->mesh->xy[v[0]], b = r->mesh->xy[v[1]], c = r->mesh->xy[v[2]];
        if (tri_orient2d(a, b, p) >= 0 && tri_orient2d(b, c, p) >= 0 && tri_orient2d(c, a, p) >= 0)
            return v;
    }
    return r->mesh->tri[r->cavity.tri[0]].v;
}

static void tell_changes(const struct tri_refiner *r)
{
    if (r->options->part)
        r->options->part->changed(r->options->part->user, r->cavity.tri, r->cavity.n_edges);
}

/* Inserts p, whose cavity has been found, for the sake of a triangle. */
static enum outcome insert_free(struct tri_refiner *r, struct tri_point p, tri_triangle_id triangle,
                                const struct tri_shape *shape)
{
    assert(p.x == r->cavity.p.x && p.y == r->cavity.p.y && r->cavity.n_edges == r->cavity.n_tri + 2);
    if (make_room(r))
        return FAILED;
    tri_vertex_id v = add_vertex(r, p, TRI_VERTEX_FREE, 0);
    const tri_vertex_id *corner = r->mesh->tri[triangle].v;
    r->mesh->feature[v] = tri_feature_inside(r->mesh, corner[tri_next[shape->shortest]],
                                             corner[tri_prev[shape->shortest]], p, r->sized);
    if (r->mesh->n_attributes)
        tri_interpolate_triangle(r->mesh, corners_around(r, p), v);
    tri_cavity_fill(&r->cavity, r->mesh, v);
    tell_changes(r);
    r->report->inserted_free++;
    return judge_fan(r) && queue_walls(r) ? DONE : FAILED;
}

static enum outcome defer(struct tri_refiner *r, tri_triangle_id triangle, int64_t *counter)
{
    ++*counter;
    if (r->options->deferred)
        r->options->deferred(r->options->deferred_user, triangle);
    return DEFERRED;
}

/* Nothing has been changed; the same is tried again when there is more of the mesh. */
static enum outcome wait_for_more(struct tri_refiner *r, const tri_vertex_id edge[2])
{
    assert(r->options->part);
    r->options->part->beyond(r->options->part->user, edge);
    r->error.status = TRI_NO_ROOM;
    return FAILED;
}

static enum outcome refuse(struct tri_refiner *r, enum tri_excuse excuse)
{
    assert(excuse < TRI_EXCUSES);
    r->excuse = excuse;
    return REFUSED;
}

/* A triangle, or, where it is TRI_NONE, a subsegment. */
static enum outcome give_up(struct tri_refiner *r, tri_triangle_id triangle, enum tri_excuse excuse)
{
    r->report->given_up[excuse]++;
    if (r->options->given_up && triangle != TRI_NONE)
        r->options->given_up(r->options->given_up_user, triangle);
    return GIVEN_UP;
}

/* Are vertex `level` and the point whose cavity has been found out of the circles of each other's subsegments? */
static bool is_level(const struct tri_refiner *r, tri_sub_id s, tri_vertex_id level)
{
    const struct tri_mesh *m = r->mesh;
    if (!tri_leaves_disks_empty(m, &m->sub[s], r->cavity.p, m->xy[level]))
        return false;
    for (int32_t i = 0; i < r->cavity.n_wall; i++) {
        const tri_vertex_id *end = m->sub[~r->cavity.edge[r->cavity.wall[i]].outer].v;
        if ((end[0] == level || end[1] == level) && tri_dot(m->xy[end[0]], m->xy[end[1]], r->cavity.p) < 0)
            return false;
    }
    return true;
}

/* The cavity of one of the places for a split; TRI_SEARCH_OUTSIDE: it has none. */
static enum tri_search search_place(struct tri_refiner *r, tri_sub_id s, const struct tri_disk_split *split, int choice,
                                    int32_t *n_left)
{
    struct tri_point p;
    return tri_place_disk_split(r->mesh, &r->mesh->sub[s], split, choice, &p)
               ? tri_cavity_search_split(&r->cavity, r->mesh, p, s, n_left)
               : TRI_SEARCH_OUTSIDE;
}

/* The cavity of the point that splits subsegment s, the first of its places that has one: rounding may put a place
 * outside the disk of a triangle beside s, or behind one of its edges. Beside a vertex that it shall be level with the
 * first that is so in spite of rounding, if any is. */
static enum tri_search find_split(struct tri_refiner *r, tri_sub_id s, const struct tri_disk_split *split,
                                  int32_t *n_left)
{
    const struct tri_mesh *m = r->mesh;
    int first = -1;
    if (!tri_can_split(m, m->xy[m->sub[s].v[0]], m->xy[m->sub[s].v[1]]))
        return TRI_SEARCH_OUTSIDE;
    for (int choice = 0; choice < TRI_DISK_PLACES; choice++) {
        enum tri_search found = search_place(r, s, split, choice, n_left);
        if (found == TRI_SEARCH_OUTSIDE)
            continue;
        if (found != TRI_SEARCH_FOUND || split->level == TRI_NONE || is_level(r, s, split->level))
            return found;
        first = first < 0 ? choice : first;
    }
    return first < 0 ? TRI_SEARCH_OUTSIDE : search_place(r, s, split, first, n_left);
}

/* Splits subsegment s for the sake of a triangle. */
static enum outcome split_at(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split split, tri_triangle_id triangle)
{
    struct tri_mesh *m = r->mesh;
    const struct tri_subsegment old = m->sub[s];
    int32_t n_left;
    assert(s >= 0 && split.fraction > 0 && split.fraction < 1);
    if (tri_is_protected(r->options, &old))
        return refuse(r, TRI_EXCUSE_PROTECTED);
    enum tri_search found = find_split(r, s, &split, &n_left);
    if (found == TRI_SEARCH_FENCED)
        return defer(r, triangle, &r->report->fenced);
    if (found == TRI_SEARCH_BEYOND)
        return wait_for_more(r, r->cavity.beyond);
    if (found == TRI_SEARCH_OUTSIDE)
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (found == TRI_SEARCH_NO_MEMORY || make_room(r))
        return FAILED;
    bool boundary = tri_is_boundary(&old);
    assert(r->cavity.n_edges > n_left || boundary);
    tri_vertex_id v = add_vertex(r, r->cavity.p, old.parent, old.marker ? old.marker : boundary ? 1 : 0);
    m->feature[v] = tri_feature_on_segment(m, &r->cavity, s, r->sized);
    tri_interpolate_edge(m, old.v[0], old.v[1], split.fraction, v);
    tri_sub_id second = tri_cavity_fill_split(&r->cavity, m, v, s, n_left);
    tell_changes(r);
    r->report->inserted_on_segments++;
    bool room = judge_fan(r) && queue_walls(r);
    if (room && r->options->conforming)
        room = queue_encroached(r, s) && queue_encroached(r, second);
    return room ? DONE : FAILED;
}

static enum outcome split(struct tri_refiner *r, tri_sub_id s, tri_triangle_id triangle)
{
    struct tri_disk_split usual = {tri_split_fraction(r->mesh, &r->mesh->sub[s]), TRI_NONE};
    return split_at(r, s, usual, triangle);
}

/* May the new point see this wall under any angle? See PROTECTED WALLS. */
static bool tolerates(const struct tri_refiner *r, const struct tri_cavity_edge *edge, double shortest)
{
    if (!tri_is_protected(r->options, &r->mesh->sub[~edge->outer]))
        return false;
    double x = edge[1].ra.x - edge[0].ra.x, y = edge[1].ra.y - edge[0].ra.y, area2 = edge->area2;
    return area2 * area2 > CLEARANCE * CLEARANCE * shortest * (x * x + y * y);
}

/* Does the new point, for a triangle with this shortest edge, squared, lie on the wrong side of a wall, or see it under
 * too wide an angle? Sets *behind. */
static bool encroaches(const struct tri_refiner *r, int32_t i, double shortest, bool *behind)
{
    const struct tri_cavity *c = &r->cavity;
    const struct tri_cavity_edge *edge = &c->edge[i], *next = edge + 1;
    assert(i >= 0 && i < c->n_edges && edge->outer < 0); /* a wall */
    double cross = edge->area2, dot = edge->ra.x * next->ra.x + edge->ra.y * next->ra.y;
    *behind = false;
    if (dot >= 0 && cross > 0)
        return false;
    bool in_lens = dot < 0 && dot * dot > r->criterion.bounds.lens_cos2 * edge->ra.l * next->ra.l;
    if (in_lens && !tolerates(r, edge, shortest))
        return true;
    *behind = tri_orient2d(c->p, r->mesh->xy[edge->a], r->mesh->xy[next->a]) <= 0;
    return *behind;
}

/* The subsegment to split instead of inserting the new point for a triangle with this shortest edge, squared: one that
 * hides it, else the first that it encroaches. */
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

/* How far from its shortest edge may the new point of this triangle lie? */
static double reach_of(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape,
                       enum tri_badness badness)
{
    double l = shape->l[shape->shortest];
    if (r->options->urgent)
        return HUGE_VAL;
    assert(l > 0 && badness != TRI_GOOD);
    double reach = r->criterion.bounds.off_centre > 0 ? r->criterion.bounds.off_centre * sqrt(l) : HUGE_VAL;
    double area2_bound = tri_area2_bound(&r->criterion, t->region);
    if (badness == TRI_BAD_SIZE && shape->area2 > area2_bound) {
        double ideal2 = IDEAL * EQUILATERAL * 0.5 * area2_bound - 0.25 * l;
        double ideal = ideal2 > 0 ? sqrt(ideal2) : 0;
        reach = ideal2 > 0.25 * l && ideal < reach ? ideal : reach;
    }
    return reach;
}

/* The cavity of a new point for a triangle: DONE where it is found and is ours. */
static enum outcome find_cavity(struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p)
{
    if (!(fabs(p.x) < FARTHEST && fabs(p.y) < FARTHEST))
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (r->options->gate) {
        double at[2] = {p.x * r->mesh->unit, p.y * r->mesh->unit};
        if (!r->options->gate(r->options->gate_user, at))
            return defer(r, triangle, &r->report->gated);
    }
    if (r->options->fence && !tri_fence_holds(r->options->fence, p)) /* then its cavity reaches beyond, too */
        return defer(r, triangle, &r->report->fenced);
    switch (tri_cavity_search(&r->cavity, r->mesh, p, triangle)) {
    case TRI_SEARCH_FOUND: return DONE;
    case TRI_SEARCH_FENCED: return defer(r, triangle, &r->report->fenced);
    case TRI_SEARCH_BEYOND: return wait_for_more(r, r->cavity.beyond);
    case TRI_SEARCH_OUTSIDE: return refuse(r, TRI_EXCUSE_PRECISION);
    default: return FAILED;
    }
}

/* The usual point, or the split of a subsegment that it encroaches. */
static enum outcome propose(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape,
                            enum tri_badness badness)
{
    const struct tri_triangle t = r->mesh->tri[triangle];
    struct tri_point p = tri_place(r->mesh->xy, t.v, shape, reach_of(r, &t, shape, badness));
    enum outcome outcome = find_cavity(r, triangle, p);
    if (outcome != DONE)
        return outcome;
    assert(r->cavity.n_tri > 0 && r->cavity.tri[0] == triangle);
    tri_sub_id s = find_encroached(r, shape->l[shape->shortest]);
    if (s == TRI_NONE)
        return insert_free(r, p, triangle, shape);
    if (tri_is_flat(r->mesh, shape))
        return refuse(r, TRI_EXCUSE_PRECISION);
    outcome = split(r, s, triangle);
    return outcome == DONE ? AGAIN : outcome;
}

/* For sizes, where the usual point is refused: see inside.c. */
static enum outcome propose_inside(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape)
{
    tri_sub_id s = tri_long_wall(r->mesh, r->options, triangle, shape);
    enum outcome outcome = s == TRI_NONE ? REFUSED : split(r, s, triangle);
    if (outcome != REFUSED)
        return outcome == DONE ? AGAIN : outcome;
    struct tri_point p;
    if (!tri_centroid(r->mesh, triangle, shape, &p))
        return refuse(r, TRI_EXCUSE_PRECISION);
    if (tri_is_walled_in(&r->criterion, triangle, shape))
        return refuse(r, TRI_EXCUSE_PROTECTED);
    outcome = find_cavity(r, triangle, p);
    return outcome == DONE ? insert_free(r, p, triangle, shape) : outcome;
}

static bool at_limit(struct tri_refiner *r)
{
    int64_t inserted = r->report->inserted_free + r->report->inserted_on_segments;
    assert(r->options->max_steiner < 0 || inserted <= r->options->max_steiner);
    if (r->options->max_steiner < 0 || inserted < r->options->max_steiner)
        return false;
    return r->report->hit_limit = true;
}

/* Somebody asks for the end: between two points the mesh is in order. */
static bool must_stop(struct tri_refiner *r)
{
    return tri_stop_is_due(r->mesh->stop, &r->step_of_stop) && tri_fail_stopped(&r->error);
}

/* Treats one bad triangle until it is gone, given up or deferred. */
static enum outcome treat(struct tri_refiner *r, struct tri_entry entry)
{
    for (;;) {
        const struct tri_triangle *t = &r->mesh->tri[entry.t];
        assert(entry.t >= 0 && entry.life <= t->life);
        if (t->life != entry.life || !tri_is_live(t))
            return DONE;
        struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
        enum tri_badness badness = tri_judge(&r->criterion, t, &shape);
        if (badness == TRI_GOOD)
            return DONE;
        r->sized = badness == TRI_BAD_SIZE;
        if (badness == TRI_BAD_ANGLE && tri_is_hopeless(r->mesh, entry.t, &shape)) {
            if (!tri_is_too_large(&r->criterion, t, &shape))
                return give_up(r, entry.t, TRI_EXCUSE_INPUT_ANGLE);
            r->sized = true;
        }
        if (at_limit(r))
            return give_up(r, entry.t, TRI_EXCUSE_LIMIT);
        bool resolved = shape.l[shape.shortest] >= r->mesh->limits.shortest2;
        enum outcome outcome = resolved ? propose(r, entry.t, &shape, badness) : refuse(r, TRI_EXCUSE_PRECISION);
        if (outcome == REFUSED && tri_is_too_large(&r->criterion, t, &shape)) {
            r->sized = true;
            outcome = propose_inside(r, entry.t, &shape);
        }
        if (outcome != AGAIN)
            return outcome == REFUSED ? give_up(r, entry.t, r->excuse) : outcome;
        if (must_stop(r))
            return FAILED;
    }
}

/* Splits subsegments until no vertex lies in the circle of one that waits. */
static bool split_encroached(struct tri_refiner *r)
{
    while (r->n_encroached > 0) {
        if (must_stop(r))
            return false;
        tri_sub_id s = r->encroached[r->n_encroached - 1];
        const struct tri_subsegment *sub = &r->mesh->sub[s];
        if (sub->side[0] == TRI_BEYOND || sub->side[1] == TRI_BEYOND)
            return wait_for_more(r, sub->v) != FAILED;
        r->n_encroached--;
        struct tri_disk_split where;
        if (!tri_is_encroached(r->mesh, sub, &where) || at_limit(r))
            continue;
        r->sized = false;
        const tri_triangle_id beside = tri_of(sub->side[0] == TRI_NONE ? sub->side[1] : sub->side[0]);
        enum outcome outcome = split_at(r, s, where, beside);
        if (outcome == FAILED) {
            r->encroached[r->n_encroached++] = s; /* there is room: it was there a moment ago */
            return false;
        }
        if (outcome == REFUSED)
            give_up(r, TRI_NONE, r->excuse);
    }
    return true;
}

/* In the first pass only triangles with short edges are taken, see refine_worklist. */
static bool next_entry(struct tri_refiner *r)
{
    return r->step == FIRST_PASS ? tri_bad_queue_pop_angle(&r->queue, r->limit, r->mesh, &r->hand)
                                 : tri_bad_queue_pop(&r->queue, r->mesh, &r->hand);
}

static bool work_off(struct tri_refiner *r)
{
    assert(r->step != NOT_BEGUN);
    for (;;) {
        if (must_stop(r))
            return false;
        if (!r->in_hand && !split_encroached(r)) /* after a pause the triangle in hand goes on first, as without one */
            return false;
        if (!r->in_hand && !next_entry(r))
            return true;
        r->in_hand = true;
        if (treat(r, r->hand) == FAILED)
            return false;
        r->in_hand = false;
    }
}

static bool queue_bad(struct tri_refiner *r, tri_triangle_id triangle, bool sizes)
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

static tri_triangle_id listed(const struct tri_refiner *r, int32_t i)
{
    return r->options->worklist ? r->options->worklist[i] : i;
}

static int32_t listed_count(const struct tri_refiner *r)
{
    return r->options->worklist ? r->options->n_worklist : r->mesh->n_triangles;
}

/* The subsegments beside a triangle. */
static bool queue_beside(struct tri_refiner *r, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    for (int e = 0; tri_is_live(t) && e < 3; e++)
        if (t->n[e] < 0 && !queue_encroached(r, ~t->n[e]))
            return false;
    return true;
}

/* Queues the bad angles of the next chunk of the worklist; the median of what waits then becomes the limit. */
static bool queue_chunk(struct tri_refiner *r)
{
    for (int32_t i = 0; i < WORKLIST_CHUNK && r->next_listed < r->n_worklist; i++, r->next_listed++) {
        tri_triangle_id triangle = listed(r, r->next_listed);
        if ((r->options->conforming && !queue_beside(r, triangle)) || !queue_bad(r, triangle, false))
            return false;
    }
    assert(r->next_listed <= r->n_worklist);
    r->limit = tri_bad_queue_median(&r->queue);
    return true;
}

/* Passes over the worklist. First, chunk by chunk, the bad angles beside the shorter half of the edges: the order by
 * shortest edge (bad_queue.h) then nearly holds for the whole mesh, but the work stays in the cache, if triangles that
 * are neighbours in the list are neighbours in the plane. Then what is left of the bad angles, in the same order, and,
 * place by place, what is only too large. Resumable: false means that something failed or that there was no room. */
static bool refine_worklist(struct tri_refiner *r)
{
    if (r->step == NOT_BEGUN) {
        assert(!r->in_hand && r->n_encroached == 0);
        r->n_worklist = listed_count(r);
        r->next_listed = 0;
        r->step = FIRST_PASS;
    }
    while (r->step == FIRST_PASS) {
        if (!work_off(r))
            return false;
        if (r->next_listed == r->n_worklist) {
            r->step = SECOND_PASS;
            r->next_listed = 0;
        } else if (!queue_chunk(r)) {
            return false;
        }
    }
    if (!work_off(r))
        return false;
    while (tri_has_sizes(r->options) && r->next_listed < r->n_worklist)
        if (!queue_bad(r, listed(r, r->next_listed++), true) || !work_off(r))
            return false;
    return true;
}

/* A bound above TRI_USUAL_ANGLE is worked for as that one. */
static double worked_angle(const struct tri_refine_options *options)
{
    return fmin(options->min_angle, TRI_USUAL_ANGLE);
}

/* Where areas decide on the mesh and the angle bound is above TRI_EASY_ANGLE, sizes come first, with an easy bound
 * (tri_sizes_come_first). Not within a fence, nor with a worklist: what the first stage makes bad for the second is not
 * among its triangles. */
static void begin_stages(struct tri_refiner *r)
{
    bool easy = !r->options->fence && !r->options->worklist && tri_sizes_come_first(r->mesh, r->options, NULL);
    r->stage = easy ? EASY_STAGE : USUAL_STAGE;
    r->criterion.bounds = tri_bounds_for(easy ? TRI_SIZES_ANGLE : worked_angle(r->options), r->options->conforming);
}

static void next_stage(struct tri_refiner *r)
{
    r->step = NOT_BEGUN;
    r->stage++;
    r->criterion.bounds = tri_bounds_for(worked_angle(r->options), r->options->conforming);
}

/* Resumable, as refine_worklist. */
static bool refine_in_stages(struct tri_refiner *r)
{
    while (r->stage != LAST_STAGE) {
        if (!refine_worklist(r))
            return false;
        next_stage(r);
    }
    return true;
}

enum tri_status tri_refiner_new(struct tri_refiner **refiner, struct tri_mesh *mesh,
                                const struct tri_refine_options *options, struct tri_refine_report *report,
                                struct tri_error *error)
{
    struct tri_refiner *r = NULL;
    *refiner = NULL;
    memset(report, 0, sizeof *report); /* all its bytes: a pause shows them */
    enum tri_status status = options->fence || options->part ? TRI_OK : tri_refine_check(mesh, options, NULL, error);
    if (status)
        return status;
    r = calloc(1, sizeof *r);
    if (!r || !tri_bad_queue_init(&r->queue)) {
        free(r);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for refinement");
    }
    *refiner = r;
    assert(mesh->n_triangles == 0 || mesh->incidence.n_vertices > 0); /* tri_refine_prepare has been called */
    r->mesh = mesh;
    r->options = options;
    r->criterion = tri_criterion_for(mesh, options);
    r->report = report;
    begin_stages(r);
    frexp(mesh->limits.shortest2, &r->least_exponent);
    r->cavity.fence = options->fence;
    r->cavity.owners = options->owners;
    return TRI_OK;
}

enum tri_status tri_refiner_run(struct tri_refiner *r, struct tri_error *error)
{
    r->error = (struct tri_error){.status = TRI_OK}; /* the caller's stays as it is where nothing fails */
    if (refine_in_stages(r)) {
        assert(!r->in_hand && r->n_encroached == 0);
        return TRI_OK;
    }
    if (r->error.status == TRI_OK)
        tri_fail(&r->error, TRI_NO_MEMORY, NULL, 0, "out of memory while refining");
    if (error)
        *error = r->error;
    return r->error.status;
}

void tri_refiner_free(struct tri_refiner *r)
{
    if (!r)
        return;
    tri_cavity_free(&r->cavity);
    tri_bad_queue_free(&r->queue);
    free(r->encroached);
    free(r);
}

void tri_refiner_show(const struct tri_refiner *r, struct tri_pause *pause)
{
    assert(!r->options->urgent);
    memset(pause, 0, sizeof *pause);
    memcpy(&pause->report, r->report, sizeof pause->report);
    pause->bounds = r->criterion.bounds;
    pause->stage = (int32_t)r->stage;
    pause->step = (int32_t)r->step;
    pause->limit = r->limit;
    pause->next_listed = r->next_listed;
    pause->n_worklist = r->n_worklist;
    pause->in_hand = r->in_hand;
    pause->hand = r->hand;
    memcpy(&pause->queue, &r->queue, sizeof r->queue);
    pause->encroached = r->encroached;
    pause->n_encroached = r->n_encroached;
    pause->encroached_capacity = r->encroached_capacity;
}

void tri_refiner_leave(struct tri_refiner *r, struct tri_pause *pause)
{
    tri_refiner_show(r, pause);
    r->queue = (struct tri_bad_queue){0};
    r->encroached = NULL;
    r->n_encroached = r->encroached_capacity = 0;
}

void tri_refiner_go_on(struct tri_refiner *r, struct tri_pause *pause)
{
    assert(r->step == NOT_BEGUN && r->n_encroached == 0 && !r->encroached);
    *r->report = pause->report;
    r->criterion.bounds = pause->bounds;
    r->stage = (enum stage)pause->stage;
    r->step = (enum step)pause->step;
    r->limit = pause->limit;
    r->next_listed = pause->next_listed;
    r->n_worklist = pause->n_worklist;
    r->in_hand = pause->in_hand != 0;
    r->hand = pause->hand;
    tri_bad_queue_free(&r->queue);
    r->queue = pause->queue;
    r->encroached = pause->encroached;
    r->n_encroached = pause->n_encroached;
    r->encroached_capacity = pause->encroached_capacity;
    pause->queue = (struct tri_bad_queue){0};
    pause->encroached = NULL;
    pause->n_encroached = pause->encroached_capacity = 0;
}

enum tri_status tri_refine(struct tri_mesh *mesh, const struct tri_refine_options *options,
                           struct tri_refine_report *report, struct tri_error *error)
{
    struct tri_refiner *refiner = NULL;
    enum tri_status status = tri_refine_prepare(mesh, NULL, error);
    status = status ? status : tri_refiner_new(&refiner, mesh, options, report, error);
    status = status ? status : tri_refiner_run(refiner, error);
    tri_refiner_free(refiner);
    assert(options->more_room || tri_mesh_is_sound(mesh)); /* a view's counts are not those of the mesh */
    return status;
}

