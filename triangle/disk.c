/* Diametral circles.
 *
 * A vertex encroaches a subsegment that it sees at more than 90 degrees. (If any vertex that sees it does, so does the
 * apex of a triangle beside it.) An encroached subsegment is split; no new point in the plane ever enters a circle
 * (refine.c), and the circles of the parts lie in that of the whole. So the mesh is conforming once no subsegment is
 * encroached.
 *
 * RULE. The point of e level with a vertex v is that at the distance of v from o, where e and v lie on two parents with
 * the common end o; else the foot of the perpendicular from v. Let v be at distance h from a subsegment of length l,
 * and the point level with v at distance d from the nearer end a. The subsegment is split
 *   - level with v, if h <= d and h < l / NARROW;
 *   - d + h^2 / d from a, if h > d and that is less than
 *   - the usual place (tri_split_fraction) from a: where it is split in all other cases.
 *
 * THEOREM (levels part two parents for good). Let u, on e, be level with v, on f, and f be all on one side of the line
 * of e. Then v encroaches neither part of e, and u no part of f. Proof. With a common end, circles with a diameter on a
 * ray from o lie in the ring between the ends of the diameter, and meet its border on the ray alone; u and v lie on one
 * such border. Else v sees u and any point of e, and u sees v and any point of f, at no more than 90 degrees, since uv
 * is perpendicular to e. So two parents side by side, however near, take about as many points as they have vertices,
 * not length / width of them, and a vertex in a bundle of parents is handed on across it once. All rays from one vertex
 * share their levels: nothing spirals around it (concentric shells: Ruppert 1995).
 *
 * New levels, which the other parents of a bundle must take over and which may ask for more new ones, are for vertices
 * that are as near to a as to e: two levels nearer to each other than their parents. One split is enough for such a
 * vertex, too: it sees a and a point m from a at no more than 90 degrees if d (m - d) <= h^2, and that point and the
 * far end if m >= d. (Halving until the level is in the middle would make as many new levels as it takes halves, on
 * each parent others: in a bundle of a dozen that never ended.)
 *
 * THEOREM (end). No split makes a part shorter than half the shortest edge: the first takes d >= h, and h is that at
 * least, or else v lies on e; the second makes parts of 2 h and more, the third of a quarter of a subsegment of two
 * shortest edges and more. So there are finitely many splits, whatever the rest of refinement does.
 *
 * Rounding puts the point level with v an ulp beside its place; of the places about it the first is taken from which
 * neither lies in a circle of the other (refine.c). Where there is none, and h, the distance of v from e, is so small
 * that this leaves v in a circle (h^2 < ulp * length), only shorter parts help: length * ulp / h^2 of them. That is
 * done where MOST_PARTS are enough. Halving makes parts at most twice as short as that asks for: no edge of theirs is
 * 16 times shorter than it would be without rounding, which is no feature. With more of them the triangles on their
 * other sides would have edges too short to be refined (feature_size.c), and would be given up.
 *
 * COLUMNS. A place need not be level with v exactly, but within h^2 / length, which may be far less than an ulp. The
 * places beside the rounded one are few, and about as far from that as it. In each column of coordinates there is one
 * that is nearest to the line on which all is level with v; it is off by half a unit in the last place of the other
 * coordinate, or less where e is steep against it. The coordinate whose unit counts less along e is worked out, the
 * other one stepped: so no place near e that fits is passed over but for the width looked at. Where one coordinate is
 * much smaller than the other, its units are finer, and so is what can be level.
 *
 * LEMMA (new levels). Whether two points at distance r from o fit, without a circle of one holding the other, depends
 * on their difference alone: a vector of the lattice of coordinates, about h long, in a cone as wide as the angle of
 * the parents, that of their perpendiculars. Other places beside theirs offer few others. But where r changes by
 * ulp / h of itself, h changes by an ulp, and others are offered. So where the place of a new level on e has none
 * beside it on f, the next of MOST_SHIFTS radii, at most SHIFTED from it, is taken that has.
 *
 * RENEWAL. An input vertex cannot be moved: it, v or the end a, may be level with the other but for d < ulp, and h^2 <
 * d * length. Then a level is begun between a and the point h^2 / d from it, with places on e and f that fit: v sees a
 * and that place at no more than 90 degrees, and all parts beyond have a level without fault before them. So one level
 * mends what would take length * d / h^2 parts without it. By the LEMMA the chance that a radius has places that fit is
 * about 8 h^2 / (ulp * length); so many radii are tried that there should be one, or none. Where each of them was
 * inserted, or lies amid a parent (so that it is the place of a level, in a mesh that is read, too), or a third parent
 * must take the level over, nothing is renewed: a bundle has new levels that do not fit wherever a parent in it takes
 * one over, and each renewal would beget others.
 *
 * What stays: where v is nearer to e than the shortest edge, so that it lies on e as far as coordinates tell, or level
 * with an end of e up to rounding, and h too small to mend that. And where rounding leaves no room for the split point
 * (cavity.h); or in a bundle of three parents or more for the point level with one that cannot move; or where no radius
 * that was looked at has places that fit. */
#include "triangle/disk.h"

#include <assert.h>
#include <float.h>

#include "triangle/predicates.h"
#include "triangle/small_angle.h"
#include "triangle/split.h"

bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code)
{
    assert(code >= 0 && tri_edge(code) < 3);
    struct tri_point apex = mesh->xy[tri_apex(mesh, code)];
    return tri_dot(mesh->xy[s->v[0]], mesh->xy[s->v[1]], apex) < 0;
}

/* A unit in the last place of the largest coordinate, in shortest edges. */
static const double ULP = 0x1p-5;

/* See the rule; the parts that rounding may ask for; the places tried for a level that renews another. */
enum { NARROW = 8, MOST_PARTS = 8, MOST_RENEWALS = TRI_RENEWALS / (2 * TRI_PLACES) };

static double distance(struct tri_point a, struct tri_point b) { return sqrt(tri_distance2(a, b)); }

/* Where on the subsegment from a to b is the point level with v? */
static double level_with(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], at = mesh->xy[v];
    tri_vertex_id end = tri_common_end(mesh, s->parent, v);
    if (end != TRI_NONE) {
        struct tri_point o = mesh->xy[end];
        double at_a = distance(o, a), at_b = distance(o, b);
        return (distance(o, at) - at_a) / (at_b - at_a);
    }
    double x = b.x - a.x, y = b.y - a.y;
    return ((at.x - a.x) * x + (at.y - a.y) * y) / (x * x + y * y);
}

/* Vertex v as a subsegment of length l sees it: see the rule. */
struct sight {
    double l, h, d;
    bool from_end; /* d is measured from the subsegment's second end */
};

static struct sight sight_of(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], at = mesh->xy[v];
    double x = b.x - a.x, y = b.y - a.y, l = sqrt(x * x + y * y), level = level_with(mesh, s, v);
    double nearer = level < 0.5 ? level : 1 - level;
    return (struct sight){l, fabs(x * (at.y - a.y) - y * (at.x - a.x)) / l, nearer * l, level >= 0.5};
}

/* Is the point level with the vertex the one to split at? Below the shortest edge d is rounding. */
static bool is_split_level(const struct sight *v, double shortest)
{
    return NARROW * v->h < v->l && v->d >= shortest && v->d >= v->h;
}

/* The fraction at which to split, by the rule. */
static double fraction_for(const struct sight *v, double usual, double shortest)
{
    double from_nearer = v->from_end ? 1 - usual : usual, far = (v->d + v->h * (v->h / v->d)) / v->l;
    if (NARROW * v->h >= v->l || v->d < shortest || (v->d < v->h && far >= from_nearer))
        return usual;
    double fraction = v->d < v->h ? far : v->d / v->l;
    return v->from_end ? 1 - fraction : fraction;
}

/* How far from the end that v is level with a level may begin that renews it: see RENEWAL. The usual place is not
 * passed. */
static double farthest_renewal(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct sight *v)
{
    double usual = tri_split_fraction(mesh, s), off = fabs(v->d);
    double most = (v->from_end ? 1 - usual : usual) * v->l;
    return off * most > v->h * v->h ? v->h * (v->h / off) : most;
}

static double nearest_renewal(const struct sight *v, double shortest) { return fmax(2 * v->h, 4 * shortest); }

/* Is it of the input, and not amid a parent? In a mesh that is read all are of the input. */
static bool is_fixed(const struct tri_mesh *mesh, tri_vertex_id v) { return v < mesh->n_input && mesh->on[v] < 0; }

/* Vertex v is level with an end of s but for rounding, which leaves it in the circle, and one of them is fixed. May a
 * new level mend that? */
static bool may_renew(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v,
                      const struct sight *sight, struct tri_disk_split *split)
{
    double most = farthest_renewal(mesh, s, sight), ulp = tri_resolution(mesh->xy[s->v[sight->from_end]]);
    if ((!is_fixed(mesh, v) && !is_fixed(mesh, s->v[sight->from_end])) ||
        !(most >= nearest_renewal(sight, sqrt(mesh->limits.shortest2))))
        return false;
    split->fraction = sight->from_end ? 1 - most / sight->l : most / sight->l;
    split->level = v;
    split->renews = true;
    return MOST_RENEWALS * sight->h * sight->h > ulp * sight->l;
}

/* Is the subsegment to be split for the sake of vertex v in its circle, and where? */
static bool is_split_for(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v,
                         struct tri_disk_split *split)
{
    const struct sight sight = sight_of(mesh, s, v);
    double shortest = sqrt(mesh->limits.shortest2), off = fmax(sight.d, ULP * shortest);
    if (!tri_is_resolved_from(mesh, s, v))
        return false;
    split->fraction = fraction_for(&sight, tri_split_fraction(mesh, s), shortest);
    split->level = is_split_level(&sight, shortest) ? v : TRI_NONE;
    split->renews = false;
    return NARROW * sight.h >= sight.l || off >= shortest || off * sight.l <= MOST_PARTS * sight.h * sight.h ||
           may_renew(mesh, s, v, &sight, split);
}

bool tri_is_resolved_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    return tri_can_split(mesh, a, b) && tri_line_distance(a, b, mesh->xy[v]) >= sqrt(mesh->limits.shortest2);
}

bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            struct tri_disk_split *split)
{
    bool is = tri_is_in_diametral_disk(mesh, s, code) && is_split_for(mesh, s, tri_apex(mesh, code), split);
    assert(!is || (split->fraction > 0 && split->fraction < 1));
    return is;
}

/* The place on subsegment s at this fraction, level with a point. Where a level is an ulp or two from the foot of the
 * perpendicular, ulps of the end to which the fraction was worked out, that is taken, which is level as well and has
 * been rounded once. */
static bool place_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction,
                        struct tri_point at, int choice, struct tri_point *p)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], between = tri_point_between(a, b, fraction);
    double x = b.x - a.x, y = b.y - a.y, l2 = x * x + y * y, near = 4 * fmax(tri_resolution(a), tri_resolution(b));
    double off = (x * (at.x - between.x) + y * (at.y - between.y));
    return off * off <= near * near * l2 ? tri_place_level(mesh, s, at, choice, p)
                                         : tri_place_split(mesh, s, fraction, choice, p);
}

/* A unit in the last place. */
static double unit_of(double x)
{
    int exponent;
    frexp(x, &exponent);
    return x == 0 ? 0 : ldexp(1, exponent - DBL_MANT_DIG);
}

/* Of the two coordinates that lie next to a + d, the nearest, or the one on its other side. */
static double coordinate_beside(double a, double d, bool other)
{
    double x = a + d;
    return tri_round_coordinate(other ? nextafter(x, x - a > d ? -HUGE_VAL : HUGE_VAL) : x);
}

/* See COLUMNS. q: the rounded place; end: the common end of the parents, or TRI_NONE. Is it level, and may it be
 * there? */
static bool place_in_column(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point q,
                            struct tri_point at, tri_vertex_id end, int i, struct tri_point *p)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    double x = b.x - a.x, y = b.y - a.y, dx = unit_of(q.x), dy = unit_of(q.y);
    int column = i / 2 % 2 ? (i / 2 + 1) / 2 : -(i / 2 / 2);
    bool other = i % 2;
    if (end != TRI_NONE) {
        struct tri_point o = mesh->xy[end];
        x = (q.x - o.x) + (at.x - o.x);
        y = (q.y - o.y) + (at.y - o.y);
    }
    if (x == 0 || (y != 0 && fabs(y) * dy < fabs(x) * dx)) {
        q.x = tri_round_coordinate(q.x + column * dx);
        q.y = coordinate_beside(at.y, -(q.x - at.x) * (x / y), other);
    } else {
        q.y = tri_round_coordinate(q.y + column * dy);
        q.x = coordinate_beside(at.x, -(q.y - at.y) * (y / x), other);
    }
    *p = q;
    return tri_leaves_disks_empty(mesh, s, q, at) && tri_may_split_at(mesh, s, q);
}

bool tri_place_disk_split(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                          const struct tri_disk_split *split, int choice, struct tri_point *p)
{
    if (split->level == TRI_NONE)
        return choice < TRI_SPLIT_PLACES && tri_place_split(mesh, s, split->fraction, choice, p);
    struct tri_point at = mesh->xy[split->level];
    if (choice < TRI_SPLIT_PLACES)
        return place_level(mesh, s, split->fraction, at, choice, p);
    tri_vertex_id end = tri_common_end(mesh, s->parent, split->level);
    place_level(mesh, s, split->fraction, at, 0, p);
    return place_in_column(mesh, s, *p, at, end, choice - TRI_SPLIT_PLACES, p);
}

bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    return tri_dot(a, p, at) >= 0 && tri_dot(p, b, at) >= 0;
}

/* The radii tried for a new level, and how far they may lie from the first, in lengths of the shorter part. */
enum { MOST_SHIFTS = 512 };
static const double SHIFTED = 1.0 / 1024;

/* The common end of two parents; TRI_NONE: there is none, or they are the same. */
static tri_vertex_id end_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q)
{
    const tri_vertex_id *a = mesh->parents[p].v, *b = mesh->parents[q].v;
    for (int k = 0; p != q && k < 2; k++)
        if (a[k] == b[0] || a[k] == b[1])
            return a[k];
    return TRI_NONE;
}

/* The fraction of subsegment s that lies at distance r from o, a point of its line. */
static double fraction_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point o, double r)
{
    double at_a = distance(o, mesh->xy[s->v[0]]), at_b = distance(o, mesh->xy[s->v[1]]);
    return (r - at_a) / (at_b - at_a);
}

double tri_level_of(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                    const struct tri_subsegment *t)
{
    tri_vertex_id end = end_between(mesh, s->parent, t->parent);
    if (end != TRI_NONE)
        return fraction_at(mesh, t, mesh->xy[end], distance(mesh->xy[end], p));
    struct tri_point a = mesh->xy[t->v[0]], b = mesh->xy[t->v[1]];
    double x = b.x - a.x, y = b.y - a.y;
    return ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
}

/* Is there a place on subsegment t, level with p on s, such that neither lies in a circle of the other? */
static bool fits(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                 const struct tri_subsegment *t)
{
    struct tri_point q, rounded;
    double fraction = tri_level_of(mesh, s, p, t);
    if (!(fraction > 0 && fraction < 1))
        return false;
    for (int choice = 0; choice < TRI_SPLIT_PLACES; choice++)
        if (place_level(mesh, t, fraction, p, choice, &q) && tri_leaves_disks_empty(mesh, t, q, p) &&
            tri_leaves_disks_empty(mesh, s, p, q))
            return true;
    tri_vertex_id end = end_between(mesh, s->parent, t->parent);
    place_level(mesh, t, fraction, p, 0, &rounded);
    for (int i = 0; i < 2 * TRI_COLUMNS; i++)
        if (place_in_column(mesh, t, rounded, p, end, i, &q) && tri_leaves_disks_empty(mesh, s, p, q))
            return true;
    return false;
}

bool tri_takes_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                     const struct tri_subsegment *t)
{
    struct tri_point a = mesh->xy[t->v[0]], b = mesh->xy[t->v[1]];
    if (s->parent == t->parent || tri_dot(a, b, p) >= 0)
        return false;
    double l = distance(a, b), h = tri_line_distance(a, b, p), level = tri_level_of(mesh, s, p, t);
    return NARROW * h < l && h >= sqrt(mesh->limits.shortest2) && level * l > h && (1 - level) * l > h;
}

bool tri_has_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                   const struct tri_subsegment *t)
{
    return !tri_takes_level(mesh, s, p, t) || fits(mesh, s, p, t);
}

/* By how much farther is s from the line of t, for each unit of length along it? Less than 0 where it comes nearer. */
static double widening(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t)
{
    struct tri_point a = mesh->xy[t->v[0]], b = mesh->xy[t->v[1]], from = mesh->xy[s->v[0]], to = mesh->xy[s->v[1]];
    return (tri_line_distance(a, b, to) - tri_line_distance(a, b, from)) / distance(from, to);
}

bool tri_shift_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t,
                     double *fraction, int *choice)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], first = tri_point_between(a, b, *fraction), p;
    double l = distance(a, b), room = SHIFTED * fmin(*fraction, 1 - *fraction), wide = widening(mesh, s, t);
    double step = fmin(fmax(tri_resolution(first) / (fabs(wide) * l), room / MOST_SHIFTS), 2 * room);
    for (int k = 0; k < MOST_SHIFTS && k * step <= room; k++) {
        double at = wide > 0 ? *fraction - k * step : *fraction + k * step;
        for (int i = 0; i < TRI_SPLIT_PLACES && at > 0 && at < 1; i++)
            if (tri_place_split(mesh, s, at, i, &p) && fits(mesh, s, p, t)) {
                *fraction = at;
                *choice = i;
                return true;
            }
    }
    return false;
}

bool tri_renew_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t,
                     struct tri_disk_split *split, int *trial)
{
    const struct sight v = sight_of(mesh, s, split->level);
    double least = nearest_renewal(&v, sqrt(mesh->limits.shortest2)), most = farthest_renewal(mesh, s, &v);
    struct tri_point p, at = mesh->xy[split->level];
    for (; *trial < TRI_RENEWALS; ++*trial) {
        int k = *trial / TRI_PLACES % MOST_RENEWALS, choice = tri_renewal_place(*trial);
        double d = most - k * ((most - least) / MOST_RENEWALS), fraction = v.from_end ? 1 - d / v.l : d / v.l;
        if (tri_place_split(mesh, s, fraction, choice, &p) && tri_leaves_disks_empty(mesh, s, p, at) &&
            (!t || fits(mesh, s, p, t))) {
            split->fraction = fraction;
            return true;
        }
    }
    return false;
}

bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split)
{
    for (int side = 0; side < 2; side++)
        if (s->side[side] != TRI_NONE && tri_is_encroached_from(mesh, s, s->side[side], split))
            return true;
    return false;
}
