/* Positions of split points.
 *
 * A split point is rounded, so it lies beside its subsegment. Without a rule, errors would add up over repeated
 * splits, and a boundary subsegment that moves outwards might touch another part of the boundary.
 *
 * RULE. The candidates are the point on the parent's line, rounded once, the neighbours of that point, and the
 * neighbours of the point on the subsegment. A neighbour differs by one unit in the precision of each coordinate, or
 * by one unit of the larger coordinate's precision. It is at most TRI_SPLIT_ASTRAY resolutions of the parent's
 * largest coordinate off the line (TRI_CHAIN_ASTRAY in a mesh read from files), because a subsegment whose end has
 * large coordinates is off by as much. The first candidate that sees its whole cavity is used.
 *
 * THEOREM (boundary; docs/theory.md, split points). Each parent on the boundary has an empty triangle outside the
 * mesh: its ends and its guard. Let every split point of a boundary subsegment lie on its inner side, in that
 * triangle, or between it and the parent's line. Then the boundary never touches itself or a vertex that is not its
 * own. */
#include "triangle/refine/split.h"

#include <assert.h>
#include <float.h>

#include "triangle/geometry/predicates.h"
#include "triangle/mesh/parents.h"
#include "triangle/size/gap.h"
#include "triangle/tunables.h"

static bool is_acute(const struct tri_mesh *mesh, tri_vertex_id v) { return mesh->on[v] == TRI_VERTEX_ACUTE; }

double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s)
{
    bool at_start = is_acute(mesh, s->v[0]), at_end = is_acute(mesh, s->v[1]);
    if (!at_start && !at_end)
        return 0.5;
    double length = sqrt(tri_distance2(mesh->xy[s->v[0]], mesh->xy[s->v[1]]));
    int exponent; /* half the length is mantissa * 2^exponent, mantissa in [0.5, 1) */
    double mantissa = frexp(0.5 * length, &exponent);
    double shell = ldexp(mantissa < 0.70710678118654752 ? 0.5 : 1, exponent);
    assert(shell > 0.35 * length && shell < 0.71 * length);
    return at_start ? shell / length : 1 - shell / length;
}

bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b)
{
    return tri_distance2(a, b) > 4 * mesh->limits.shortest2;
}

/* Is p on the line of the parent, or on the side of it that is to the left of the direction from `from` to `to`?
 * (Subsegments are far longer than their distance from the line.) */
static bool is_inside_line(struct tri_point a, struct tri_point b, struct tri_point from, struct tri_point to,
                           struct tri_point p)
{
    bool along = (b.x - a.x) * (to.x - from.x) + (b.y - a.y) * (to.y - from.y) > 0;
    return (along ? tri_orient2d(a, b, p) : tri_orient2d(b, a, p)) >= 0;
}

/* Is the parent a straight input segment? If not, it was found as a chain of edges in a mesh that was read. */
static bool began_as_line(const struct tri_mesh *mesh, const struct tri_parent *parent)
{
    return tri_compare_places(parent->guard, mesh->xy[parent->v[0]]) != 0;
}

/* May a boundary subsegment from `from` to `to`, with the mesh on its left, be split at p without touching the rest
 * of the boundary? */
static bool keeps_to_itself(const struct tri_mesh *mesh, const struct tri_parent *parent, struct tri_point from,
                            struct tri_point to, struct tri_point p)
{
    struct tri_point a = mesh->xy[parent->v[0]], b = mesh->xy[parent->v[1]], guard = parent->guard;
    if (tri_orient2d(from, to, p) >= 0 || isnan(guard.x))
        return true;
    return (began_as_line(mesh, parent) && is_inside_line(a, b, from, to, p)) || tri_is_inside(a, b, guard, p) ||
           tri_is_inside(b, a, guard, p);
}

/* May the subsegment be split at p, as far as the boundary is concerned? */
static bool is_allowed(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p)
{
    bool left = s->side[0] != TRI_NONE, boundary = !left || s->side[1] == TRI_NONE;
    struct tri_point from = mesh->xy[s->v[left ? 0 : 1]], to = mesh->xy[s->v[left ? 1 : 0]];
    return !boundary || keeps_to_itself(mesh, &mesh->parents[s->parent], from, to, p);
}

/* Does this candidate lie on the parent's line? If not, it lies on the subsegment, which may be off the line. */
static bool is_on_line(int choice) { return choice / TRI_PLACES % 2 == 0; }

/* Returns the offset of neighbour candidates from the rounded point, in each coordinate. */
static struct tri_point step(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point rounded,
                             int choice)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    struct tri_point grain = {0x1p-52 * fmax(fabs(a.x), fabs(b.x)), 0x1p-52 * fmax(fabs(a.y), fabs(b.y))};
    double coarse = tri_resolution(rounded);
    return choice < 2 * TRI_PLACES ? grain : (struct tri_point){coarse, coarse};
}

/* Is p within TRI_SPLIT_ASTRAY resolutions of the line of s's parent, and allowed by the boundary? */
static bool may_split_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p)
{
    const tri_vertex_id *end = mesh->parents[s->parent].v;
    return tri_line_distance(mesh->xy[end[0]], mesh->xy[end[1]], p) <= TRI_SPLIT_ASTRAY * tri_resolution(p) &&
           is_allowed(mesh, s, p);
}

struct tri_split_base tri_split_base(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction)
{
    assert(fraction > 0 && fraction < 1 && s->parent >= 0 && s->parent < mesh->n_parents);
    const tri_vertex_id *end = mesh->parents[s->parent].v;
    struct tri_point between = tri_point_between(mesh->xy[s->v[0]], mesh->xy[s->v[1]], fraction);
    return (struct tri_split_base){tri_onto_line(mesh->xy[end[0]], mesh->xy[end[1]], between), between};
}

/* Returns the ideal split point at the foot of the perpendicular from `at`. */
static struct tri_split_base split_base_level(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                                              struct tri_point at)
{
    assert(s->parent >= 0 && s->parent < mesh->n_parents);
    const tri_vertex_id *end = mesh->parents[s->parent].v;
    return (struct tri_split_base){tri_onto_line(mesh->xy[end[0]], mesh->xy[end[1]], at),
                                   tri_onto_line(mesh->xy[s->v[0]], mesh->xy[s->v[1]], at)};
}

bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_split_base *base,
                     int choice, struct tri_point *p)
{
    assert(choice >= 0 && choice < TRI_SPLIT_PLACES);
    const struct tri_parent *parent = &mesh->parents[s->parent];
    struct tri_point a = mesh->xy[parent->v[0]], b = mesh->xy[parent->v[1]];
    struct tri_point rounded = is_on_line(choice) ? base->on_line : base->on_sub;
    double most = began_as_line(mesh, parent) ? TRI_SPLIT_ASTRAY : TRI_CHAIN_ASTRAY;
    double astray = most * fmax(tri_resolution(a), tri_resolution(b));
    *p = tri_place_beside(rounded, step(mesh, s, rounded, choice), choice % TRI_PLACES);
    return is_allowed(mesh, s, *p) && (is_on_line(choice) || tri_line_distance(a, b, *p) <= astray);
}

/* Diametral circles: where to split a subsegment e with a vertex v in its diametral circle.
 *
 * RULE. The point of e that is level with v is defined in two cases. If e and v lie on two parents with a common end
 * o, it is the point of e that is as far from o as v is. Otherwise it is the foot of the perpendicular from v. Let l
 * be the length of e, h the distance of v from it, and d the distance of the level point from the nearer end a. Then
 * e is split
 *   - level with v, if 0.9 h <= d and h < l / TRI_NARROW;
 *   - at distance d + h^2 / d from a, if 0.9 h > d and this is less than the distance of the usual point
 *     (tri_split_fraction);
 *   - at the usual point in all other cases.
 * A split that rounding would undo is not made. Let g be the rounding error of a point along e. Then e is not split
 * if no candidate is level and g * l > TRI_NARROW * h^2. It is also not split if v lies across a gap that is not
 * filled (gap.h), and if the gap is longer than (TRI_NARROW * h)^2 / g.
 *
 * THEOREM (docs/theory.md, levels; concentric shells: Ruppert 1995). Level vertices separate two parents
 * permanently: two parallel parents need about as many points as they have vertices, and no part is shorter than
 * half the shortest edge. */

bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code)
{
    assert(code >= 0 && tri_edge(code) < 3);
    struct tri_point apex = mesh->xy[tri_apex(mesh, code)];
    return tri_dot(mesh->xy[s->v[0]], mesh->xy[s->v[1]], apex) < 0;
}

/* A unit in the last place of the largest coordinate, as a multiple of the shortest edge. */
static const double ULP = 0x1p-5;

static double distance(struct tri_point a, struct tri_point b) { return sqrt(tri_distance2(a, b)); }

/* Returns the fraction of the subsegment at which its point level with v lies. */
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

/* The quantities l, h and d of the rule, for one vertex and one subsegment. */
struct sight {
    double l, h, d; /* length; distance of v; distance of the level point from the nearer end */
    bool from_end; /* true: d is measured from the subsegment's second end */
    bool far;      /* true: d >= 0.9 h. With the bound h, rounding could make two parents split each other endlessly */
};

static struct sight sight_of(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], at = mesh->xy[v];
    double x = b.x - a.x, y = b.y - a.y, l = sqrt(x * x + y * y), level = level_with(mesh, s, v);
    double d = (level < 0.5 ? level : 1 - level) * l, h = fabs(x * (at.y - a.y) - y * (at.x - a.x)) / l;
    return (struct sight){l, h, d, level >= 0.5, d >= 0.9 * h};
}

/* Returns where to split for vertex v, by the rule. A distance d below the shortest edge is a rounding error. */
static struct tri_disk_split split_for(const struct sight *s, tri_vertex_id v, double usual, double shortest)
{
    double from_nearer = s->from_end ? 1 - usual : usual, far = (s->d + s->h * (s->h / s->d)) / s->l;
    if (TRI_NARROW * s->h >= s->l || s->d < shortest || (!s->far && far >= from_nearer))
        return (struct tri_disk_split){usual, TRI_NONE};
    double fraction = s->far ? s->d / s->l : far;
    return (struct tri_disk_split){s->from_end ? 1 - fraction : fraction, s->far ? v : TRI_NONE};
}

/* Returns the unit in the last place of x. */
static double unit_of(double x)
{
    int exponent;
    frexp(x, &exponent);
    return x == 0 ? 0 : ldexp(1, exponent - DBL_MANT_DIG);
}

/* Returns how far rounding may move a split point along the subsegment. The coordinate whose unit moves it less
 * counts. */
static double grain_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point at)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    double x = fabs(b.x - a.x), y = fabs(b.y - a.y);
    return fmin(x * unit_of(at.x), y * unit_of(at.y)) / sqrt(x * x + y * y);
}

/* Does the subsegment have a candidate that is level with v in spite of rounding? */
static bool has_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v,
                      const struct sight *sight)
{
    double fraction = sight->d / sight->l;
    const struct tri_disk_split level = {sight->from_end ? 1 - fraction : fraction, v};
    const struct tri_split_base base = tri_disk_base(mesh, s, &level);
    struct tri_point p;
    for (int choice = 0; choice < TRI_DISK_PLACES; choice++)
        if (tri_place_disk_split(mesh, s, &level, &base, choice, &p) &&
            tri_leaves_disks_empty(mesh, s, p, mesh->xy[v]))
            return true;
    return false;
}

/* Should vertex v in its circle cause a split of the subsegment, and where? */
static bool is_split_for(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v,
                         struct tri_disk_split *split)
{
    const struct sight sight = sight_of(mesh, s, v);
    const double shortest = sqrt(mesh->limits.shortest2), h2 = sight.h * sight.h;
    if (!tri_is_resolved_from(mesh, s, v))
        return false;
    *split = split_for(&sight, v, tri_split_fraction(mesh, s), shortest);
    if (sight.d < shortest)
        return TRI_NARROW * sight.h >= sight.l || fmax(sight.d, ULP * shortest) * sight.l <= TRI_NARROW * h2;
    const double grain = grain_at(mesh, s, mesh->xy[v]);
    const double gap = tri_gap_across(mesh, s->parent, s->v[sight.from_end], v);
    return grain * gap <= TRI_NARROW * TRI_NARROW * sight.h &&
           (grain * sight.l <= TRI_NARROW * h2 || has_level(mesh, s, v, &sight));
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

/* If a split point level with a vertex lies within an ulp or two of the foot of the perpendicular, the foot is used:
 * it is level as well, and has been rounded only once. (These are ulps of the end from which the fraction was
 * computed.) */
struct tri_split_base tri_disk_base(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                                    const struct tri_disk_split *split)
{
    if (split->level == TRI_NONE)
        return tri_split_base(mesh, s, split->fraction);
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]], at = mesh->xy[split->level];
    struct tri_point between = tri_point_between(a, b, split->fraction);
    double x = b.x - a.x, y = b.y - a.y, l2 = x * x + y * y, near = 4 * fmax(tri_resolution(a), tri_resolution(b));
    double off = (x * (at.x - between.x) + y * (at.y - between.y));
    return off * off <= near * near * l2 ? split_base_level(mesh, s, at)
                                         : tri_split_base(mesh, s, split->fraction);
}

/* Returns the representable coordinate closest to a + d or, if `other`, the one on the opposite side of a + d. */
static double coordinate_beside(double a, double d, bool other)
{
    double x = a + d;
    return tri_round_coordinate(other ? nextafter(x, x - a > d ? -HUGE_VAL : HUGE_VAL) : x);
}

/* In each column of coordinates one point is closest to the line of points level with `at` (docs/theory.md). q: the
 * rounded point; end: the common end of the parents, or TRI_NONE. Returns whether the point is level and allowed. */
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
    return tri_leaves_disks_empty(mesh, s, q, at) && may_split_at(mesh, s, q);
}

bool tri_place_disk_split(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                          const struct tri_disk_split *split, const struct tri_split_base *base, int choice,
                          struct tri_point *p)
{
    if (choice < TRI_SPLIT_PLACES)
        return tri_place_split(mesh, s, base, choice, p);
    if (split->level == TRI_NONE)
        return false;
    tri_vertex_id end = tri_common_end(mesh, s->parent, split->level);
    tri_place_split(mesh, s, base, 0, p);
    return place_in_column(mesh, s, *p, mesh->xy[split->level], end, choice - TRI_SPLIT_PLACES, p);
}

bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    return tri_dot(a, p, at) >= 0 && tri_dot(p, b, at) >= 0;
}

bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split)
{
    for (int side = 0; side < 2; side++)
        if (s->side[side] != TRI_NONE && tri_is_encroached_from(mesh, s, s->side[side], split))
            return true;
    return false;
}
