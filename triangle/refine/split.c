/* Places of split points.
 *
 * A split point is rounded, so it lies beside its subsegment. Errors would add up from split to split, and a boundary
 * subsegment that moves outwards might meet another part of the boundary. RULE. The place is the one on the parent's
 * line, rounded once, or a neighbour of it or of the place on the subsegment. A neighbour is a unit away in each
 * coordinate's own measure, or else in the measure of the larger coordinate, and at most TRI_SPLIT_ASTRAY resolutions
 * of the parent's largest coordinate away from the line (TRI_CHAIN_ASTRAY in a mesh that was read): a part that begins
 * near a coarse end is as far off. The first place from which all of the cavity can be seen is taken.
 *
 * THEOREM (boundary; docs/theory.md, split points). Each parent on the boundary has an empty triangle of its own
 * outside: its ends and its guard. If every split point of a boundary subsegment lies on its inner side, in that
 * triangle, or between it and the parent's line, the boundary never meets itself, and passes no vertex not its own. */
#include "triangle/refine/split.h"

#include <assert.h>

#include "triangle/cdt/chain.h"
#include "triangle/geometry/predicates.h"
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

/* Is p on the line of the parent, or on the side of it that is left of the way from `from` to `to`? (Subsegments are
 * far longer than their distance from the line.) */
static bool is_inside_line(struct tri_point a, struct tri_point b, struct tri_point from, struct tri_point to,
                           struct tri_point p)
{
    bool along = (b.x - a.x) * (to.x - from.x) + (b.y - a.y) * (to.y - from.y) > 0;
    return (along ? tri_orient2d(a, b, p) : tri_orient2d(b, a, p)) >= 0;
}

/* Was the parent a straight line from the start? Else it belongs to a mesh that was read, and was found as a chain. */
static bool began_as_line(const struct tri_mesh *mesh, const struct tri_parent *parent)
{
    return tri_compare_places(parent->guard, mesh->xy[parent->v[0]]) != 0;
}

/* May a boundary subsegment from `from` to `to`, the mesh on its left, be split at p? */
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

/* Is this choice a place on the parent's line? Else it is one on the subsegment, which lies inside by now. */
static bool is_on_line(int choice) { return choice / TRI_PLACES % 2 == 0; }

/* How far a neighbour lies from the rounded place in each coordinate. */
static struct tri_point step(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point rounded,
                             int choice)
{
    struct tri_point a = mesh->xy[s->v[0]], b = mesh->xy[s->v[1]];
    struct tri_point grain = {0x1p-52 * fmax(fabs(a.x), fabs(b.x)), 0x1p-52 * fmax(fabs(a.y), fabs(b.y))};
    double coarse = tri_resolution(rounded);
    return choice < 2 * TRI_PLACES ? grain : (struct tri_point){coarse, coarse};
}

bool tri_may_split_at(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p)
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

struct tri_split_base tri_split_base_level(const struct tri_mesh *mesh, const struct tri_subsegment *s,
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
