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
 * their points lie behind it, and it is split; where a fence forbids that, hidden_wall.c finds it behind the cavity.
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
 * BARRIERS. Where no subsegment may be split (-YY; -Y where none lies inside), most of those are given up for points
 * behind the wall. RULE: a point behind the subsegment that was in the way last is refused without a search. THEOREM:
 * with one it would be, too, or deferred. Proof: let the way from a corner of the triangle, across the opposite edge,
 * to the point p cross the barrier, and no vertex (else a way beside it does). As long as it crosses edges that are no
 * subsegments, the next triangle, too, has p in its circumdisk (cavity.h), and belongs to the cavity. So it does not
 * reach p, behind the barrier. It meets a subsegment, a wall of the cavity with p behind it, which must not be split.
 *
 * FENCES. The walls beyond a fence stay coarse while its own side is refined, so that such fans of n triangles come to
 * lie there; each asks for a point, searches all of them, is led to a wall, and finds that the cavity of its split lies
 * beyond the fence. RULE: where such searches have gone through more than WIDE triangles, these are all deferred as
 * they are (wall_off). THEOREM: then n triangles of a fan cost n together, where they cost n each; and what is deferred
 * is as it was before, so all that is said of calls with fences holds. Proof: the first of them that is asked defers
 * the others, which are not asked before they have changed; deferred triangles are found again by whoever comes later,
 * with other fences or none.
 *
 * FLAT TRIANGLES. Where segments lie an ulp apart, a subsegment beside a flat triangle has no place for a split before
 * the subsegment behind that triangle has one, on the same level. In one call the flat triangles come first, and all
 * are split in step. Within a fence the one behind may be another's, or be kept for the margin below; for sizes the
 * point would then be a centroid (inside.c), a third as far from the subsegment each time, down to what coordinates
 * resolve, and angles grade the mesh around each of these. RULE: within a fence a triangle that would get a centroid
 * since its subsegment has no place is deferred, if a flat triangle there is, or the split of the wall behind these. In
 * a call for the whole mesh it gets its centroid; and where nobody else can help, so that a sweep leaves nothing over.
 * (Grids of 12 segments with a size test, in cells of 60 triangles: 4,790 triangles at 30 degrees, 511 with the rule,
 * 545 by one call; at 22 degrees another left 42 triangles of 1,084 below the bound, now none.)
 *
 * SIZES. A triangle whose angle is given up may be too large all the same. The usual point lies as near to its shortest
 * edge as its angle asks, and the triangles on that edge are good then: where the edge has run away (feature_size.c)
 * that would go on with what was given up, and angles grade the mesh around each such point. RULE: there the point lies
 * as far from the edge as sizes ask. Where walls must not be split the usual one is taken: the other would mostly lie
 * behind them, and a centroid in its place comes nearer to walls. (A square and its copy, 10^-6 beside it, with -D and
 * a size test, turned forty ways, in cells of 60 triangles: 1,705 to 8,790 triangles, 1,705 to 3,003 with the rule; by
 * one call up to 3,602, and 3,141.)
 *
 * SEAMS. Bad triangles that reach beyond a fence stay; around them a bound above TRI_PROMISED_ANGLE can only be
 * reached by points that are ever denser, and whoever refines them later has to keep all of these. RULE: for such a
 * bound a triangle is refined only where it lies within the fence with a margin of its longest edge, and of twice
 * its shortest; others are deferred as they are. They are somebody else's inner ones in the next phase. (A comb of
 * 22 slits, some of them cut lengthwise by seams, at 30 and 34 degrees: 131,985 and 277,516 triangles without the
 * rule, 103,153 and 141,620 with it; one call makes 101,327 and 135,661. Once the shortest edge gains half as much
 * in tiny cells; twice alone lets points gather where seams cross at tiny features, to 2.8 times what one call
 * makes; four times the shortest edge leaves more at the seams, which a sweep cannot come back to.)
 *
 * Termination: for angles by the rules in small_angle.c, and credit.h says at what price; the points for sizes and for
 * circles that come on top are finitely many whatever the others do, see inside.c and disk.c. */
#include "triangle/refine.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/bad_queue.h"
#include "triangle/cavity.h"
#include "triangle/census.h"
#include "triangle/credit.h"
#include "triangle/criterion.h"
#include "triangle/disk.h"
#include "triangle/entry_set.h"
#include "triangle/estimate.h"
#include "triangle/feature_size.h"
#include "triangle/grow.h"
#include "triangle/hidden_wall.h"
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

/* In degrees: a bound that is soon reached around points that were inserted for a larger one. */
static const double BACK_ANGLE = 30;

/* So many bad triangles are the most for which a bound above TRI_USUAL_ANGLE is tried: see begin_stages. */
enum { FEW_BAD = 16 };

enum stage { EASY_STAGE, USUAL_STAGE, ABOVE_STAGE, BACK_STAGE, LAST_STAGE };

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
    bool none_splits;            /* no subsegment may be split */
    bool has_barrier;            /* then: one has been in the way, */
    struct tri_point barrier[2]; /* between these ends the last */
    struct tri_bad_queue queue;
    bool sized;       /* the triangle in hand asks for a point because of sizes, not of angles */
    bool on_credit;   /* its point, or split, is */
    struct tri_credit credit;
    double promised_sin2, poor_sin2; /* as bounds.sin2, for TRI_PROMISED_ANGLE and TRI_POOR_ANGLE */
    int64_t above;    /* how many points more may be inserted for angles above TRI_USUAL_ANGLE */
    int64_t back;     /* and, once that was too many, for BACK_ANGLE */
    bool left_above;  /* has a triangle been left in ABOVE_STAGE for what it would cost? */
    enum step step;
    int limit;        /* buckets from here on wait for the second pass */
    int32_t next_listed, n_worklist;
    enum stage stage;
    enum tri_excuse excuse; /* of the last refusal */
    tri_sub_id placeless;   /* that was since this subsegment should be split, and has no place for it; or TRI_NONE */
    struct tri_entry_set walled_off; /* triangles that are deferred as they are, see FENCES */
    tri_triangle_id *searched; /* [n_searched] the cavity before a split was searched, if that is wide */
    int32_t n_searched, searched_capacity;
    bool in_hand;     /* `hand` was being treated when there was no room */
    struct tri_entry hand;
    tri_sub_id *encroached; /* stack of subsegments to test for encroachment (conforming only) */
    int32_t n_encroached, encroached_capacity;
    int64_t uncounted; /* points that max_steiner does not bound, see split_encroached */
    uint32_t step_of_stop; /* see tri_stop_is_due */
};

enum { WORKLIST_CHUNK = 1 << 16, WIDE = 64 };

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

/* A feature size is negative where the vertex is on credit. */
static void set_feature(const struct tri_refiner *r, tri_vertex_id v, double size)
{
    assert(size >= 0);
    r->mesh->feature[v] = r->on_credit ? -size : size;
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
    set_feature(r, v, tri_feature_inside(r->mesh, corner[tri_next[shape->shortest]],
                                         corner[tri_prev[shape->shortest]], p, r->sized));
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

static bool wall_off(struct tri_refiner *r, const tri_triangle_id *triangle, int32_t n)
{
    for (int32_t i = 0; n > WIDE && i < n; i++) {
        struct tri_entry entry = {triangle[i], r->mesh->tri[triangle[i]].life};
        if (!tri_entry_set_add(&r->walled_off, entry))
            return false;
    }
    return true;
}

/* The fence does, after a search. */
static enum outcome defer_fenced(struct tri_refiner *r, tri_triangle_id triangle)
{
    if (!wall_off(r, r->cavity.tri, r->cavity.n_tri) || !wall_off(r, r->searched, r->n_searched))
        return FAILED;
    r->report->searched_in_vain += r->cavity.n_tri + r->n_searched;
    return defer(r, triangle, &r->report->fenced);
}

/* Keeps the triangles of a wide cavity while another is searched. */
static bool keep_searched(struct tri_refiner *r)
{
    int32_t n = r->cavity.n_tri;
    r->n_searched = 0;
    if (!r->options->fence || n <= WIDE)
        return true;
    if (!tri_grow(&r->searched, &r->searched_capacity, n, sizeof *r->searched))
        return false;
    memcpy(r->searched, r->cavity.tri, (size_t)n * sizeof *r->searched);
    r->n_searched = n;
    return true;
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
    r->placeless = TRI_NONE;
    return REFUSED;
}

/* The subsegment that should be split has no place for it. */
static enum outcome refuse_place(struct tri_refiner *r, tri_sub_id s)
{
    refuse(r, TRI_EXCUSE_PRECISION);
    r->placeless = s;
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

/* The cavity of a place that has one was found. Where a subsegment beside it has no place level with it, another
 * place for both, if there is any. */
static enum tri_search settle_level(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split *split, int first,
                                    int32_t *n_left)
{
    const struct tri_mesh *m = r->mesh;
    const struct tri_point p = r->cavity.p;
    for (int32_t i = 0; r->options->conforming && i < r->cavity.n_wall; i++) {
        tri_sub_id t = ~r->cavity.edge[r->cavity.wall[i]].outer;
        struct tri_disk_split shifted = *split;
        int choice;
        if (t == s || tri_has_level(m, &m->sub[s], p, &m->sub[t]))
            continue;
        if (!tri_shift_level(m, &m->sub[s], &m->sub[t], &shifted.fraction, &choice))
            return TRI_SEARCH_FOUND;
        enum tri_search found = search_place(r, s, &shifted, choice, n_left);
        if (found == TRI_SEARCH_OUTSIDE)
            return search_place(r, s, split, first, n_left);
        split->fraction = shifted.fraction;
        return found;
    }
    return TRI_SEARCH_FOUND;
}

/* Can all subsegments beside a point on s, whose cavity has been found, be split level with it? */
static bool begins_levels(const struct tri_refiner *r, tri_sub_id s)
{
    const struct tri_mesh *m = r->mesh;
    for (int32_t i = 0; i < r->cavity.n_wall; i++) {
        tri_sub_id t = ~r->cavity.edge[r->cavity.wall[i]].outer;
        if (t != s && !tri_has_level(m, &m->sub[s], r->cavity.p, &m->sub[t]))
            return false;
    }
    return true;
}

/* The subsegments that will be split level with a point on s, whose cavity has been found: how many, but for t? *last:
 * one of them. */
static int takers(const struct tri_refiner *r, tri_sub_id s, tri_sub_id t, tri_sub_id *last)
{
    const struct tri_mesh *m = r->mesh;
    int n = 0;
    for (int32_t i = 0; i < r->cavity.n_wall; i++) {
        tri_sub_id wall = ~r->cavity.edge[r->cavity.wall[i]].outer;
        if (wall == s || wall == t || !tri_takes_level(m, &m->sub[s], r->cavity.p, &m->sub[wall]))
            continue;
        *last = wall;
        n++;
    }
    return n;
}

/* The cavity of any place for a split. */
static enum tri_search search_any(struct tri_refiner *r, tri_sub_id s, const struct tri_disk_split *split,
                                  int32_t *n_left)
{
    enum tri_search found = TRI_SEARCH_OUTSIDE;
    for (int choice = 0; choice < TRI_SPLIT_PLACES && found == TRI_SEARCH_OUTSIDE; choice++)
        found = search_place(r, s, split, choice, n_left);
    return found;
}

/* The cavity of a place for a level that renews one. Such levels are begun between two subsegments alone: where others
 * had to take them over, and had no places that fit, there would be more to renew than before. */
static enum tri_search find_renewal(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split *split, int32_t *n_left)
{
    enum { MOST_FITS = 8 };
    const struct tri_mesh *m = r->mesh;
    struct tri_disk_split begun = {split->fraction, TRI_NONE, false};
    tri_sub_id t = TRI_NONE, other;
    enum tri_search found = search_any(r, s, &begun, n_left);
    if (found != TRI_SEARCH_FOUND)
        return found;
    if (takers(r, s, TRI_NONE, &t) > 1)
        return TRI_SEARCH_OUTSIDE;
    if (t != TRI_NONE) {
        struct tri_disk_split taken = {tri_level_of(m, &m->sub[s], r->cavity.p, &m->sub[t]), TRI_NONE, false};
        found = search_any(r, t, &taken, n_left);
        if (found != TRI_SEARCH_FOUND || takers(r, t, s, &other) > 0)
            return found != TRI_SEARCH_FOUND ? found : TRI_SEARCH_OUTSIDE;
    }
    int trial = 0;
    const struct tri_subsegment *beside = t == TRI_NONE ? NULL : &m->sub[t];
    for (int i = 0; i < MOST_FITS && tri_renew_level(m, &m->sub[s], beside, split, &trial); i++) {
        begun.fraction = split->fraction;
        found = search_place(r, s, &begun, tri_renewal_place(trial++), n_left);
        if (found != TRI_SEARCH_OUTSIDE)
            return found;
    }
    return TRI_SEARCH_OUTSIDE;
}

/* The cavity of the point that splits subsegment s, the first of its places that has one: rounding may put a place
 * outside the disk of a triangle beside s, or behind one of its edges. Beside a vertex that it shall be level with the
 * first that is so in spite of rounding, if any is. Where it begins a level, one with room for those that follow. */
static enum tri_search find_split(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split *split, int32_t *n_left)
{
    const struct tri_mesh *m = r->mesh;
    int first = -1;
    bool first_is_level = false;
    if (!tri_can_split(m, m->xy[m->sub[s].v[0]], m->xy[m->sub[s].v[1]]))
        return TRI_SEARCH_OUTSIDE;
    if (split->renews)
        return find_renewal(r, s, split, n_left);
    for (int choice = 0; choice < TRI_DISK_PLACES; choice++) {
        enum tri_search found = search_place(r, s, split, choice, n_left);
        if (found == TRI_SEARCH_OUTSIDE)
            continue;
        if (found == TRI_SEARCH_FOUND && split->level == TRI_NONE)
            return settle_level(r, s, split, choice, n_left);
        if (found != TRI_SEARCH_FOUND)
            return found;
        bool level = is_level(r, s, split->level);
        if (level && begins_levels(r, s))
            return found;
        first = first < 0 || (level && !first_is_level) ? choice : first;
        first_is_level = first_is_level || level;
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
    if (tri_is_protected(r->options, &old)) {
        r->has_barrier = r->none_splits;
        r->barrier[0] = m->xy[old.v[0]];
        r->barrier[1] = m->xy[old.v[1]];
        return refuse(r, TRI_EXCUSE_PROTECTED);
    }
    enum tri_search found = find_split(r, s, &split, &n_left);
    if (found == TRI_SEARCH_FENCED)
        return defer_fenced(r, triangle);
    if (found == TRI_SEARCH_BEYOND)
        return wait_for_more(r, r->cavity.beyond);
    if (found == TRI_SEARCH_OUTSIDE)
        return refuse_place(r, s);
    if (found == TRI_SEARCH_NO_MEMORY || make_room(r))
        return FAILED;
    bool boundary = tri_is_boundary(&old);
    assert(r->cavity.n_edges > n_left || boundary);
    tri_vertex_id v = add_vertex(r, r->cavity.p, old.parent, old.marker ? old.marker : boundary ? 1 : 0);
    set_feature(r, v, tri_feature_on_segment(m, &r->cavity, s, r->sized));
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
    struct tri_disk_split usual = {tri_split_fraction(r->mesh, &r->mesh->sub[s]), TRI_NONE, false};
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

/* Has the angle of a triangle that is too large been given up, since its shortest edge is no feature? See SIZES. */
static bool is_for_size_alone(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape)
{
    const int k = shape->shortest;
    return r->sized && r->options->protect == 0 &&
           tri_has_run_away(r->mesh, tri_final_angle(r->options), t->v[tri_next[k]], t->v[tri_prev[k]], shape->l[k]);
}

/* How far from its shortest edge may the new point of this triangle lie? */
static double reach_of(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape,
                       enum tri_badness badness)
{
    double l = shape->l[shape->shortest];
    if (r->options->urgent)
        return HUGE_VAL;
    assert(l > 0 && badness != TRI_GOOD);
    const bool for_size = badness == TRI_BAD_SIZE || is_for_size_alone(r, t, shape);
    const bool near = r->criterion.bounds.off_centre > 0 && (badness == TRI_BAD_SIZE || !for_size);
    double reach = near ? r->criterion.bounds.off_centre * sqrt(l) : HUGE_VAL;
    double area2_bound = tri_area2_bound(&r->criterion, t->region);
    if (for_size && shape->area2 > area2_bound) {
        double ideal2 = IDEAL * EQUILATERAL * 0.5 * area2_bound - 0.25 * l;
        double ideal = ideal2 > 0 ? sqrt(ideal2) : 0;
        reach = ideal2 > 0.25 * l && ideal < reach ? ideal : reach;
    }
    return reach;
}

/* Do the open line segments ab and cd cross? */
static bool do_cross(struct tri_point a, struct tri_point b, struct tri_point c, struct tri_point d)
{
    const double of_a = tri_orient2d(c, d, a), of_b = tri_orient2d(c, d, b);
    if (!((of_a > 0 && of_b < 0) || (of_a < 0 && of_b > 0)))
        return false;
    const double of_c = tri_orient2d(a, b, c), of_d = tri_orient2d(a, b, d);
    return (of_c > 0 && of_d < 0) || (of_c < 0 && of_d > 0);
}

/* Is p, in the circumdisk of the triangle, behind the barrier, seen from the corner that has p behind the opposite
 * edge? See BARRIERS. */
static bool is_behind_barrier(const struct tri_refiner *r, tri_triangle_id triangle, struct tri_point p)
{
    const tri_vertex_id *v = r->mesh->tri[triangle].v;
    for (int k = 0; r->has_barrier && k < 3; k++) {
        const struct tri_point a = r->mesh->xy[v[k]];
        const struct tri_point b = r->mesh->xy[v[tri_next[k]]], c = r->mesh->xy[v[tri_prev[k]]];
        if (tri_orient2d(b, c, p) < 0 && tri_orient2d(a, b, p) > 0 && tri_orient2d(c, a, p) > 0)
            return do_cross(a, p, r->barrier[0], r->barrier[1]);
    }
    return false;
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
    if (is_behind_barrier(r, triangle, p))
        return refuse(r, TRI_EXCUSE_PROTECTED);
    switch (tri_cavity_search(&r->cavity, r->mesh, p, triangle)) {
    case TRI_SEARCH_FOUND: return DONE;
    case TRI_SEARCH_FENCED: return defer_fenced(r, triangle);
    case TRI_SEARCH_BEYOND: return wait_for_more(r, r->cavity.beyond);
    case TRI_SEARCH_OUTSIDE: return refuse(r, TRI_EXCUSE_PRECISION);
    default: return FAILED;
    }
}

/* The same where subsegments that are encroached may have been left: hidden_wall.c. Those that must not be split are in
 * nobody's way: they are hidden in calls for the whole mesh, too. */
static enum outcome find_hidden(struct tri_refiner *r, tri_triangle_id triangle, tri_sub_id *s)
{
    if (!r->options->fence && !r->options->urgent)
        return DONE;
    switch (tri_find_hidden_wall(&r->cavity, r->mesh, r->options, r->criterion.bounds.lens_cos2, s)) {
    case TRI_SEARCH_FENCED: return defer_fenced(r, triangle);
    case TRI_SEARCH_BEYOND: return wait_for_more(r, r->cavity.beyond);
    default: break;
    }
    return DONE;
}

/* The usual point, or the split of a subsegment that it encroaches. */
static enum outcome propose(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape,
                            enum tri_badness badness)
{
    const struct tri_triangle t = r->mesh->tri[triangle];
    struct tri_point p = tri_place(r->mesh->xy, t.v, shape, reach_of(r, &t, shape, badness));
    enum outcome outcome = find_cavity(r, triangle, p);
    if (outcome == REFUSED && r->excuse == TRI_EXCUSE_PROTECTED && tri_is_flat(r->mesh, shape))
        return refuse(r, TRI_EXCUSE_PRECISION); /* as with a search */
    if (outcome != DONE)
        return outcome;
    assert(r->cavity.n_tri > 0 && r->cavity.tri[0] == triangle);
    tri_sub_id s = find_encroached(r, shape->l[shape->shortest]);
    if (s == TRI_NONE && (outcome = find_hidden(r, triangle, &s)) != DONE)
        return outcome;
    if (s == TRI_NONE)
        return insert_free(r, p, triangle, shape);
    if (tri_is_flat(r->mesh, shape))
        return refuse(r, TRI_EXCUSE_PRECISION);
    outcome = keep_searched(r) ? split(r, s, triangle) : FAILED;
    r->n_searched = 0;
    return outcome == DONE ? AGAIN : outcome;
}

/* Are there points on credit? */
static bool gives_credit(const struct tri_refiner *r)
{
    return r->stage == USUAL_STAGE && r->options->min_angle > TRI_PROMISED_ANGLE;
}

/* Does the triangle lie within the fence, with this margin? */
static bool lies_within(const struct tri_refiner *r, const struct tri_triangle *t, double margin)
{
    bool does = true;
    for (int k = 0; k < 3; k++) {
        struct tri_point p = r->mesh->xy[t->v[k]];
        struct tri_point low = {p.x - margin, p.y - margin}, high = {p.x + margin, p.y + margin};
        does = does && tri_fence_holds(r->options->fence, low) && tri_fence_holds(r->options->fence, high);
    }
    return does;
}

/* With a margin to spare? See SEAMS. */
static bool keeps_margin(const struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape)
{
    return lies_within(r, t, sqrt(tri_larger(4 * shape->l[shape->shortest], tri_longest2(shape))));
}

/* DONE: the split of this subsegment would not be refused by the fence. */
static enum outcome owns_split(struct tri_refiner *r, tri_sub_id s)
{
    int32_t n_left;
    struct tri_disk_split usual = {tri_split_fraction(r->mesh, &r->mesh->sub[s]), TRI_NONE, false};
    switch (find_split(r, s, &usual, &n_left)) {
    case TRI_SEARCH_FENCED: return DEFERRED;
    case TRI_SEARCH_BEYOND: return wait_for_more(r, r->cavity.beyond);
    case TRI_SEARCH_NO_MEMORY: return FAILED;
    default: return DONE;
    }
}

/* Flat triangles from this one on, each across the longest edge of the last, to the wall behind them, which is split
 * first of all. DONE: all that is within the fence. */
static enum outcome owns_flats(struct tri_refiner *r, tri_triangle_id t)
{
    const struct tri_mesh *m = r->mesh;
    for (double longest2 = 0;;) {
        const tri_vertex_id *v = m->tri[t].v;
        const struct tri_shape shape = tri_shape_of(m->xy, v);
        if (!tri_is_flat(m, &shape) || tri_longest2(&shape) <= longest2)
            return DONE;
        longest2 = tri_longest2(&shape);
        if (!lies_within(r, &m->tri[t], 0) || (gives_credit(r) && !keeps_margin(r, &m->tri[t], &shape)))
            return DEFERRED;
        const int e = shape.l[0] == longest2 ? 0 : shape.l[1] == longest2 ? 1 : 2;
        const tri_link link = m->tri[t].n[e];
        if (link == TRI_BEYOND)
            return wait_for_more(r, (tri_vertex_id[]){v[tri_next[e]], v[tri_prev[e]]});
        if (link < 0)
            return owns_split(r, ~link);
        t = tri_of(link);
    }
}

/* DONE: nobody else can make room for the split that has just been refused. See FLAT TRIANGLES. */
static enum outcome leave_to_others(struct tri_refiner *r, tri_triangle_id triangle)
{
    enum outcome outcome = DONE;
    if (!r->options->fence || r->placeless == TRI_NONE)
        return DONE;
    const struct tri_subsegment *sub = &r->mesh->sub[r->placeless];
    for (int side = 0; side < 2 && outcome == DONE; side++) {
        if (sub->side[side] == TRI_BEYOND)
            return wait_for_more(r, sub->v);
        if (sub->side[side] != TRI_NONE)
            outcome = owns_flats(r, tri_of(sub->side[side]));
    }
    return outcome == DEFERRED ? defer(r, triangle, &r->report->fenced) : outcome;
}

/* For sizes, where the usual point is refused: see inside.c, and FLAT TRIANGLES. */
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
    outcome = leave_to_others(r, triangle);
    outcome = outcome == DONE ? find_cavity(r, triangle, p) : outcome;
    return outcome == DONE ? insert_free(r, p, triangle, shape) : outcome;
}

/* Lowers the angle bound that the loop works for; what is already bad by the old one stays. */
static void lower_bound(struct tri_refiner *r, double degrees)
{
    assert(degrees >= 0 && degrees <= r->options->min_angle);
    double lens_cos2 = r->criterion.bounds.lens_cos2;
    r->criterion.bounds = tri_bounds_for(degrees, r->options->conforming);
    r->criterion.bounds.lens_cos2 = degrees > 0 ? r->criterion.bounds.lens_cos2 : lens_cos2;
}

/* A point for angles above the usual one: once what the mesh can afford has been spent, less is asked for. */
static void count_point(struct tri_refiner *r)
{
    if (r->stage < ABOVE_STAGE || r->sized)
        return;
    bool is_above = r->above >= 0;
    int64_t left = is_above ? --r->above : --r->back;
    if (left != -1)
        return;
    lower_bound(r, is_above ? BACK_ANGLE : 0);
    r->left_above = r->report->hit_cap = true;
}

static bool at_limit(struct tri_refiner *r)
{
    int64_t inserted = r->report->inserted_free + r->report->inserted_on_segments - r->uncounted;
    assert(r->options->max_steiner < 0 || inserted <= r->options->max_steiner);
    if (r->options->max_steiner < 0 || inserted < r->options->max_steiner)
        return false;
    return r->report->hit_limit = true;
}

/* Above the usual angle edges must be twice as long, so that afterwards there is room for better angles around
 * them. */
static bool is_hopeless(struct tri_refiner *r, tri_triangle_id triangle, const struct tri_shape *shape)
{
    const tri_vertex_id *v = r->mesh->tri[triangle].v;
    const double angle = tri_final_angle(r->options);
    int k = shape->shortest;
    if (tri_is_hopeless(r->mesh, angle, triangle, shape))
        return true;
    if (r->stage != ABOVE_STAGE || !tri_has_run_away(r->mesh, angle, v[tri_next[k]], v[tri_prev[k]], shape->l[k] / 4))
        return false;
    return r->left_above = r->report->hit_cap = true;
}

/* What the triangle's angle may claim of the credit. */
static enum tri_claim claim_of(const struct tri_refiner *r, const struct tri_shape *shape)
{
    double longer = tri_longer_product(shape->l[0], shape->l[1], shape->l[2]), area4 = shape->area2 * shape->area2;
    return area4 >= r->promised_sin2 * longer ? TRI_CLAIM_NEARLY_GOOD
           : area4 >= r->poor_sin2 * longer   ? TRI_CLAIM_FAIR
                                              : TRI_CLAIM_POOR;
}

/* Is there credit for it, where it must be paid for (credit.h)? */
static bool has_credit(struct tri_refiner *r, const struct tri_triangle *t, const struct tri_shape *shape)
{
    const struct tri_mesh *m = r->mesh;
    const int k = shape->shortest;
    const enum tri_claim claim = claim_of(r, shape);
    r->on_credit = gives_credit(r) && (claim == TRI_CLAIM_NEARLY_GOOD || tri_is_on_credit(m, t->v[tri_next[k]]) ||
                                       tri_is_on_credit(m, t->v[tri_prev[k]]));
    if (!r->on_credit || tri_has_credit(&r->credit, claim))
        return true;
    r->on_credit = false;
    r->report->hit_cap = true;
    return false;
}

/* Somebody asks for the end, or how far the work is: between two points the mesh is in order. */
static bool must_stop(struct tri_refiner *r)
{
    if (r->options->told && r->step_of_stop % TRI_STOP_STEPS == 0)
        r->options->told(r->options->told_user, r->mesh->n_triangles);
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
        if (tri_entry_set_holds(&r->walled_off, entry))
            return defer(r, entry.t, &r->report->fenced);
        r->sized = badness == TRI_BAD_SIZE;
        r->on_credit = false;
        if (r->options->fence && badness == TRI_BAD_ANGLE && gives_credit(r)) {
            if (!keeps_margin(r, t, &shape))
                return defer(r, entry.t, &r->report->fenced);
            if (!tri_meet_corners(&r->credit, r->mesh, t->v))
                return FAILED;
        }
        if (badness == TRI_BAD_ANGLE && (is_hopeless(r, entry.t, &shape) || !has_credit(r, t, &shape))) {
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
            r->on_credit = false;
            outcome = propose_inside(r, entry.t, &shape);
        }
        if (outcome == DONE || outcome == AGAIN) {
            count_point(r);
            if (gives_credit(r))
                tri_count_credit(&r->credit, r->on_credit);
        }
        if (outcome != AGAIN)
            return outcome == REFUSED ? give_up(r, entry.t, r->excuse) : outcome;
        if (must_stop(r))
            return FAILED;
    }
}

/* Is an end of the subsegment, or a vertex beside it, on credit? */
static bool is_among_credit(const struct tri_mesh *m, const struct tri_subsegment *s)
{
    bool is = tri_is_on_credit(m, s->v[0]) || tri_is_on_credit(m, s->v[1]);
    for (int side = 0; side < 2; side++)
        is = is || (s->side[side] != TRI_NONE && tri_is_on_credit(m, tri_apex(m, s->side[side])));
    return is;
}

/* Splits subsegment s, as `where` says, for the sake of the first apex in its circle. Where coordinates have no place
 * for that, they may have one for the sake of the apex on its other side. */
static enum outcome split_for_either(struct tri_refiner *r, tri_sub_id s, struct tri_disk_split where)
{
    const struct tri_mesh *m = r->mesh;
    const struct tri_subsegment *sub = &m->sub[s];
    const tri_halfedge left = sub->side[0], right = sub->side[1];
    const tri_triangle_id beside = tri_of(left == TRI_NONE ? right : left);
    assert(s >= 0 && tri_is_live(&m->tri[beside]));
    enum outcome outcome = split_at(r, s, where, beside);
    if (outcome != REFUSED || left == TRI_NONE || right == TRI_NONE || !tri_is_in_diametral_disk(m, sub, left))
        return outcome;
    return tri_is_encroached_from(m, sub, right, &where) ? split_at(r, s, where, beside) : outcome;
}

/* A pre-refinement ends each level that it begins (see tri_refine_options.urgent), whatever its limit. */
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
        if (!tri_is_encroached(r->mesh, sub, &where) || (!r->options->urgent && at_limit(r)))
            continue;
        r->sized = false;
        r->on_credit = is_among_credit(r->mesh, sub);
        enum outcome outcome = split_for_either(r, s, where);
        if (outcome == FAILED) {
            r->encroached[r->n_encroached++] = s; /* there is room: it was there a moment ago */
            return false;
        }
        if (outcome == DONE) {
            count_point(r);
            r->uncounted += r->options->urgent != NULL;
        }
        if (outcome == REFUSED)
            give_up(r, TRI_NONE, r->excuse);
    }
    return true;
}

/* With -Y alone that takes a look at all subsegments: in a call for the whole mesh. */
static bool may_none_split(const struct tri_mesh *mesh, const struct tri_refine_options *options)
{
    if (options->fence || options->part || options->protect != 1)
        return options->protect >= 2;
    for (int32_t s = 0; s < mesh->n_subs; s++)
        if (mesh->sub[s].parent != TRI_NONE && !tri_is_boundary(&mesh->sub[s]))
            return false;
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

/* Does the triangle ask for a point because of its angle, as it is? */
static bool asks_for_angle(struct tri_refiner *r, tri_triangle_id triangle)
{
    const struct tri_triangle *t = &r->mesh->tri[triangle];
    const struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
    const double longer = tri_longer_product(shape.l[0], shape.l[1], shape.l[2]);
    return shape.area2 * shape.area2 < r->criterion.bounds.sin2 * longer && tri_is_urgent(&r->criterion, t->v) &&
           !is_hopeless(r, triangle, &shape);
}

/* What the worklist grants (credit.h), where points may be on credit. */
static void grant_for_worklist(struct tri_refiner *r)
{
    struct tri_grantors listed_corners = {0};
    if (r->options->fence || !gives_credit(r))
        return;
    for (int32_t i = 0; i < r->n_worklist; i++) {
        const tri_triangle_id t = listed(r, i);
        if (tri_is_live(&r->mesh->tri[t]))
            tri_list_corners(&listed_corners, r->mesh, r->mesh->tri[t].v, asks_for_angle(r, t));
    }
    tri_grant(&r->credit, &listed_corners);
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
        grant_for_worklist(r);
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

/* Where areas decide on the mesh and the angle bound is above TRI_EASY_ANGLE, sizes come first, with an easy bound
 * (tri_sizes_come_first: up to a sixth fewer triangles). Above TRI_USUAL_ANGLE refinement feeds on itself, until edges
 * are as short as feature_size.c allows. So the whole mesh is refined for the usual angle; then for more, if it is
 * nearly reached (FEW_BAD), and as long as that adds less than half as many points again; where it did not end so, what
 * is left is mended for BACK_ANGLE (for the usual angle it would take several times as many points), and given up where
 * that is too dear, too. Within a fence there is only the usual stage. With a worklist there is no easy one: what it
 * makes bad for the next is not among them.
 *
 * THEOREM (above the usual angle). Whatever the bound, for angles above TRI_USUAL_ANGLE no more than 602 + 3/4 n
 * points are inserted, n being the triangles of the mesh at that angle. Proof: each is counted (count_point); after
 * 201 + n / 4 of them no triangle is bad by more than BACK_ANGLE, after 401 + n / 2 more none is bad by its angle.
 * So without sizes and -D the mesh has at most 2.5 n + 1204 triangles. Each of these points may make a triangle too
 * large for its bound, or encroach a subsegment under -D; what comes of that is finite by inside.c and disk.c.
 *
 * FEW_BAD. Each bad triangle is mended by a few points, or begets others until edges are too short, as luck has it.
 * With few of them all may be mended; with many some are not, and leave more triangles below the bound, and below the
 * usual one, than there were. Measured on 14 figures without sizes at 34.5 and 35 degrees: the bound was reached only
 * where no more than 13 were bad; of 17 cases with more than 16, 16 ended with more bad ones, in meshes 1.2 to 1.8
 * times as large. (About a hundredth of a mesh is bad at 34.5 degrees, a fiftieth at 35, a sixth at 36.) So where the
 * bound is out of reach the mesh stays that of the usual angle; what -r with the same bound makes of it is what it
 * makes for that angle: mostly nothing. Where there are sizes most triangles are good by far, and trying mends half of
 * the bad ones at 34.5 and 35 degrees: there it is tried whatever their number. */

/* Is no more than FEW_BAD of the listed triangles bad by its angle, and not to be given up? */
static bool is_nearly_reached(const struct tri_refiner *r)
{
    const double angle = tri_final_angle(r->options);
    int bad = 0;
    for (int32_t i = 0; bad <= FEW_BAD && i < listed_count(r); i++) {
        const struct tri_triangle *t = &r->mesh->tri[listed(r, i)];
        if (!tri_is_live(t))
            continue;
        struct tri_shape shape = tri_shape_of(r->mesh->xy, t->v);
        bad += tri_judge(&r->criterion, t, &shape) == TRI_BAD_ANGLE &&
               !tri_is_hopeless(r->mesh, angle, listed(r, i), &shape);
    }
    return bad <= FEW_BAD;
}

static void go_above(struct tri_refiner *r)
{
    assert(!r->options->fence && r->stage != EASY_STAGE);
    r->above = 200 + r->mesh->n_triangles / 4;
    r->back = 2 * r->above;
    lower_bound(r, r->options->min_angle);
    bool tried = tri_has_sizes(r->options) || is_nearly_reached(r);
    r->stage = tried ? ABOVE_STAGE : LAST_STAGE;
    r->report->hit_cap |= !tried;
}

static void begin_stages(struct tri_refiner *r)
{
    double usual = fmin(r->options->min_angle, TRI_USUAL_ANGLE);
    bool easy = !r->options->fence && !r->options->worklist && !r->options->above &&
                tri_sizes_come_first(r->mesh, r->options, NULL);
    assert(!r->options->above || (!r->options->worklist && r->options->min_angle > TRI_USUAL_ANGLE));
    r->stage = easy ? EASY_STAGE : USUAL_STAGE;
    r->criterion.bounds = tri_bounds_for(easy ? TRI_SIZES_ANGLE : usual, r->options->conforming);
    if (r->options->above)
        go_above(r);
}

static void next_stage(struct tri_refiner *r)
{
    r->step = NOT_BEGUN;
    switch (r->stage) {
    case EASY_STAGE:
        lower_bound(r, fmin(r->options->min_angle, TRI_USUAL_ANGLE));
        r->stage = USUAL_STAGE;
        return;
    case USUAL_STAGE:
        r->stage = LAST_STAGE;
        if (r->options->min_angle > TRI_USUAL_ANGLE && !r->options->fence)
            go_above(r);
        return;
    case ABOVE_STAGE:
        r->stage = LAST_STAGE;
        if (r->left_above && r->back >= 0) {
            r->above = -1;
            lower_bound(r, BACK_ANGLE);
            r->stage = BACK_STAGE;
        }
        return;
    default:
        r->stage = LAST_STAGE;
    }
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
    r->credit.granted = INT64_C(6) * (options->fence ? TRI_BLOCK_ALLOWANCE : TRI_ALLOWANCE);
    r->promised_sin2 = tri_bounds_for(TRI_PROMISED_ANGLE, options->conforming).sin2;
    r->poor_sin2 = tri_bounds_for(TRI_POOR_ANGLE, options->conforming).sin2;
    r->report = report;
    r->none_splits = may_none_split(mesh, options);
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
    tri_entry_set_free(&r->walled_off);
    tri_credit_free(&r->credit);
    free(r->searched);
    free(r->encroached);
    free(r);
}

void tri_refiner_show(const struct tri_refiner *r, struct tri_pause *pause)
{
    assert(!r->options->urgent);
    memset(pause, 0, sizeof *pause);
    memcpy(&pause->report, r->report, sizeof pause->report);
    pause->bounds = r->criterion.bounds;
    pause->above = r->above;
    pause->back = r->back;
    pause->left_above = r->left_above;
    pause->granted = r->credit.granted;
    pause->paid = r->credit.paid;
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
    pause->walled_off = r->walled_off;
    pause->met = r->credit.met;
}

void tri_refiner_leave(struct tri_refiner *r, struct tri_pause *pause)
{
    tri_refiner_show(r, pause);
    r->queue = (struct tri_bad_queue){0};
    r->encroached = NULL;
    r->n_encroached = r->encroached_capacity = 0;
    r->walled_off = r->credit.met = (struct tri_entry_set){0};
}

void tri_refiner_go_on(struct tri_refiner *r, struct tri_pause *pause)
{
    assert(r->step == NOT_BEGUN && r->n_encroached == 0 && !r->encroached);
    *r->report = pause->report;
    r->criterion.bounds = pause->bounds;
    r->above = pause->above;
    r->back = pause->back;
    r->left_above = pause->left_above != 0;
    r->credit.granted = pause->granted;
    r->credit.paid = pause->paid;
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
    r->walled_off = pause->walled_off;
    r->credit.met = pause->met;
    pause->queue = (struct tri_bad_queue){0};
    pause->encroached = NULL;
    pause->n_encroached = pause->encroached_capacity = 0;
    pause->walled_off = pause->met = (struct tri_entry_set){0};
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

