/* Inserts segments into a Delaunay triangulation. Each becomes a chain of subsegments, inserted piece by piece. Based
 * on snap rounding (Hobby 1999), without a grid.
 *
 * RULES (docs/theory.md, constraining segments). A piece ends at the first vertex on it (1), and at a vertex beside it
 * that rounding cannot distinguish from one on it (2). If a piece crosses a subsegment, both are cut at a common vertex
 * (3). After all insertions, a subsegment with an apex beside it is rerouted through that apex (4). No vertex ever
 * moves.
 *
 * INVARIANT. Between two insertions the mesh is a constrained Delaunay triangulation of the pieces inserted so far.
 * corner[v] is a live triangle at v, or TRI_NONE if v is in no triangle. The mesh fills the convex hull.
 *
 * THEOREM (end). The algorithm terminates, with all segments inserted or with an error that names one. Rules 1, 2 and 4
 * use a vertex between the ends of pieces, in the order along their first segment, and rule 3 is applied a bounded
 * number of times. Debug builds assert each comes_between. */
#include "triangle/cdt/constrain.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/cdt/bundle.h"
#include "triangle/cdt/crossing.h"
#include "triangle/cdt/flip.h"
#include "triangle/cdt/recover.h"
#include "triangle/geometry/predicates.h"
#include "triangle/mesh/cavity.h"
#include "triangle/mesh/locate.h"
#include "triangle/mesh/surface.h"
#include "triangle/tunables.h"

enum { WINDOW = 64 }; /* minimum number of further triangles searched after a vertex beside the piece is found */

static const struct tri_course NO_SEGMENT = {TRI_NONE, TRI_NONE, false};

struct builder {
    struct tri_mesh *mesh;
    const struct tri_pslg *pslg;
    struct tri_cavity cavity;
    struct tri_recovery recovery;
    struct tri_flips flips;
    tri_triangle_id *corner; /* [corner_capacity] a triangle at each vertex, or TRI_NONE */
    int32_t corner_capacity;
    struct tri_course *course; /* [course_capacity] the input segments along each subsegment */
    int32_t course_capacity;
    struct tri_piece *piece; /* stack of pieces to insert: the rest of the current segment, and removed subsegments */
    int32_t n_pieces, piece_capacity;
    int32_t segment; /* the current input segment */
    int64_t crossings, crossings_left; /* limit on applications of rule 3, and how many are left */
    bool runs_along; /* whether a piece has met a vertex before its end */
    uint32_t step; /* counter for tri_stop_is_due */
    struct tri_constrain_report *report;
    struct tri_error *error;
};

static enum tri_status no_memory(struct builder *l)
{
    return tri_fail(l->error, TRI_NO_MEMORY, NULL, 0, "out of memory for segment %d", (int)l->segment);
}

static bool push_piece(struct builder *l, tri_vertex_id from, tri_vertex_id to, struct tri_course course)
{
    assert(from >= 0 && from < l->mesh->n_vertices && to >= 0 && to < l->mesh->n_vertices);
    if (from == to)
        return true;
    bool room = tri_grow(&l->piece, &l->piece_capacity, l->n_pieces + 1, sizeof *l->piece);
    if (room)
        l->piece[l->n_pieces++] = (struct tri_piece){from, to, course};
    return room;
}

static int32_t marker_of(const struct builder *l, struct tri_course course)
{
    return course.marked == TRI_NONE ? 0 : l->pslg->segment_markers[course.marked];
}

static bool set_course(struct builder *l, tri_sub_id s, struct tri_course course)
{
    bool room = tri_grow(&l->course, &l->course_capacity, s + 1, sizeof *l->course);
    if (room)
        l->course[s] = course;
    return room;
}

static bool mark_edge(struct builder *l, tri_triangle_id t, int e, struct tri_course course)
{
    struct tri_mesh *mesh = l->mesh;
    tri_link link = mesh->tri[t].n[e];
    tri_vertex_id from = mesh->tri[t].v[tri_next[e]], to = mesh->tri[t].v[tri_prev[e]];
    if (link < 0) {
        assert(~link < mesh->n_subs);
        l->course[~link] = tri_course_both(l->course[~link], course);
        return true;
    }
    if (tri_mesh_reserve_subs(mesh, 1, l->error))
        return false;
    tri_sub_id s = tri_mesh_add_sub(mesh, from, to, 0, course.first);
    mesh->sub[s].side[0] = tri_code(t, e);
    mesh->sub[s].side[1] = link;
    mesh->tri[t].n[e] = ~s;
    *tri_link_at(mesh, link) = ~s;
    return set_course(l, s, course);
}

static struct tri_point end_of(const struct builder *l, int32_t segment, int k)
{
    assert(segment >= 0 && segment < l->pslg->n_segments);
    return l->mesh->xy[l->pslg->segments[2 * segment + k]];
}

/* Is v within `resolutions` resolutions of the line of an input segment, measured at the segment's larger end? */
static bool is_near_line(const struct builder *l, int32_t segment, tri_vertex_id v, double resolutions)
{
    const int32_t *ends = &l->pslg->segments[2 * segment];
    if (v == ends[0] || v == ends[1])
        return true; /* by far the most common case */
    struct tri_point a = end_of(l, segment, 0), b = end_of(l, segment, 1);
    double resolution = fmax(tri_resolution(a), tri_resolution(b));
    return tri_line_distance(a, b, l->mesh->xy[v]) <= resolutions * resolution;
}

/* Returns a value > 0 if q comes after p in the order along an input segment, and 0 if they are at the same place.
 * Points at the same distance along the segment are ordered by their position perpendicular to it. The sign is exact,
 * since tri_turn is; the first call rotates both points by 90 degrees. */
static double compare_along(const struct builder *l, int32_t segment, struct tri_point p, struct tri_point q)
{
    struct tri_point a = end_of(l, segment, 0), b = end_of(l, segment, 1), from = {-p.y, p.x}, to = {-q.y, q.x};
    double along = tri_turn(a, b, from, to);
    return along != 0 ? along : tri_turn(a, b, p, q);
}

/* Does q lie between the ends of the piece, in the order along its segment? See THEOREM (end). */
static bool comes_between(const struct builder *l, struct tri_point q, const struct tri_piece *piece)
{
    struct tri_point a = l->mesh->xy[piece->from], b = l->mesh->xy[piece->to];
    double first = compare_along(l, piece->course.first, a, q), second = compare_along(l, piece->course.first, q, b);
    return (first > 0 && second > 0) || (first < 0 && second < 0);
}

/* Does q lie between the ends of the piece, along the line of the piece itself? */
static bool lies_between(const struct builder *l, struct tri_point q, const struct tri_piece *piece)
{
    struct tri_point a = l->mesh->xy[piece->from], b = l->mesh->xy[piece->to];
    double x = b.x - a.x, y = b.y - a.y; /* relative to each end, since q may be close to one */
    return x * (q.x - a.x) + y * (q.y - a.y) > 0 && x * (q.x - b.x) + y * (q.y - b.y) < 0;
}

/* Reports a segment by its ends, because files may number from 0 or from 1. */
static enum tri_status fail_for_segment(const struct builder *l, int32_t segment)
{
    const double unit = l->mesh->unit; /* a power of two */
    struct tri_point a = end_of(l, segment, 0), b = end_of(l, segment, 1);
    return tri_fail(l->error, TRI_BAD_INPUT, NULL, 0,
                    "the segment from (%.17g, %.17g) to (%.17g, %.17g) cannot be kept to its line: "
                    "too much lies within rounding of it", unit * a.x, unit * a.y, unit * b.x, unit * b.y);
}

static enum tri_status check_distance(const struct builder *l, struct tri_course course, tri_vertex_id v)
{
    int32_t segment[2] = {course.first, course.marked};
    for (int k = 0; k < 2; k++)
        if (segment[k] != TRI_NONE && !is_near_line(l, segment[k], v, TRI_SEGMENT_ASTRAY))
            return fail_for_segment(l, segment[k]);
    return TRI_OK;
}

/* Makes ab a subsegment. The edges between a and b that it crosses begin in triangle t. */
static enum tri_status insert_edge(struct builder *l, tri_triangle_id t, tri_vertex_id a, tri_vertex_id b,
                                struct tri_course course)
{
    struct tri_mesh *mesh = l->mesh;
    enum tri_status status = check_distance(l, course, a);
    status = status ? status : check_distance(l, course, b);
    if (status)
        return status;
    int k = tri_corner_of(&mesh->tri[t], a);
    bool right = mesh->tri[t].v[tri_next[k]] == b;
    if (right || mesh->tri[t].v[tri_prev[k]] == b)
        return mark_edge(l, t, right ? tri_prev[k] : tri_next[k], course) ? TRI_OK : no_memory(l);
    tri_halfedge code;
    status = tri_recover_edge(&l->recovery, mesh, t, a, b, &code, l->error);
    if (status)
        return status;
    for (int32_t i = 0; i < l->recovery.n_crossed; i++)
        for (int c = 0; c < 3; c++)
            l->corner[mesh->tri[tri_of(l->recovery.crossed[i])].v[c]] = tri_of(l->recovery.crossed[i]);
    l->corner[a] = l->corner[b] = tri_of(code);
    return mark_edge(l, tri_of(code), tri_edge(code), course) ? TRI_OK : no_memory(l);
}

static bool update_corners(struct builder *l, tri_vertex_id v)
{
    bool room = tri_grow(&l->corner, &l->corner_capacity, l->mesh->n_vertices, sizeof *l->corner);
    if (!room)
        return false;
    l->flips.corner = l->corner;
    for (int32_t i = 0; i < l->cavity.n_edges; i++) {
        const struct tri_triangle *t = &l->mesh->tri[l->cavity.tri[i]];
        for (int k = 0; k < 3; k++)
            l->corner[t->v[k]] = l->cavity.tri[i];
    }
    return l->corner[v] != TRI_NONE;
}

/* Removes subsegment s, which has triangles on both sides, from the mesh. The last subsegment gets its number. */
static bool remove_sub(struct builder *l, tri_sub_id s)
{
    struct tri_mesh *mesh = l->mesh;
    tri_halfedge left = mesh->sub[s].side[0], right = mesh->sub[s].side[1];
    assert(left != TRI_NONE && right != TRI_NONE);
    assert(*tri_link_at(mesh, left) == ~s && *tri_link_at(mesh, right) == ~s);
    *tri_link_at(mesh, left) = right;
    *tri_link_at(mesh, right) = left;
    tri_sub_id last = --mesh->n_subs;
    mesh->sub[s] = mesh->sub[last];
    l->course[s] = l->course[last];
    for (int side = 0; s != last && side < 2; side++)
        if (mesh->sub[s].side[side] != TRI_NONE)
            *tri_link_at(mesh, mesh->sub[s].side[side]) = ~s;
    return tri_flip_touch(&l->flips, tri_of(left)) && tri_flip_touch(&l->flips, tri_of(right)) &&
           tri_flip_legalise(&l->flips);
}

/* Returns the triangle that holds *p, not on the hull. If rounding has put *p on or beyond the hull, moves it by one
 * step. Returns TRI_NONE if no such place is found. */
static tri_triangle_id find_place(const struct builder *l, tri_vertex_id near, struct tri_point *p)
{
    const struct tri_point step = {tri_resolution(*p), tri_resolution(*p)};
    for (int i = 0; i < TRI_PLACES; i++) {
        struct tri_point q = tri_place_beside(*p, step, i);
        tri_triangle_id t = tri_walk_to(l->mesh, l->corner[near], q);
        tri_sub_id s = t == TRI_NONE ? TRI_NONE : tri_sub_under(l->mesh, t, q);
        if (t != TRI_NONE && (s == TRI_NONE || !tri_is_boundary(&l->mesh->sub[s]))) {
            *p = q;
            return t;
        }
    }
    return TRI_NONE;
}

/* Removes subsegment s and pushes it on the stack, to be cut at a vertex that is determined later (see cut_pieces). A
 * hull edge stays, but no segment runs along it any more. */
static bool remove_for_rerouting(struct builder *l, tri_sub_id s)
{
    const struct tri_subsegment old = l->mesh->sub[s];
    struct tri_course course = l->course[s];
    l->course[s] = NO_SEGMENT;
    return (tri_is_boundary(&old) || remove_sub(l, s)) && push_piece(l, old.v[0], old.v[1], course);
}

/* Cuts the pieces on the stack from number `first` on at vertex v. The first two, which cross at v, are always cut, the
 * others only if v lies between their ends. */
static bool cut_pieces(struct builder *l, int32_t first, tri_vertex_id v)
{
    assert(first >= 0 && first < l->n_pieces && v != TRI_NONE);
    for (int32_t i = l->n_pieces - 1; i >= first; i--) {
        struct tri_piece whole = l->piece[i];
        if (whole.from == v || whole.to == v || (i > first + 1 && !lies_between(l, l->mesh->xy[v], &whole)))
            continue;
        l->piece[i].from = v;
        if (!push_piece(l, whole.from, v, whole.course))
            return false;
    }
    return true;
}

/* A candidate vertex that two crossing pieces can share instead of a new one. */
struct choice {
    tri_vertex_id vertex; /* TRI_NONE: none found */
    int n_outside;           /* for how many of the two pieces it does not lie between the ends */
    double distance;      /* squared distance from the crossing */
};

/* Replaces *best if v is a better choice. The crossing pieces are the first two from number `first` on. */
static void try_vertex(const struct builder *l, int32_t first, tri_vertex_id v, struct tri_point p, double within,
                       struct choice *best)
{
    struct choice now = {v, 0, tri_distance2(l->mesh->xy[v], p)};
    if (now.distance > within * within)
        return;
    for (int32_t i = first; i < first + 2; i++)
        now.n_outside += l->piece[i].from != v && l->piece[i].to != v && !lies_between(l, l->mesh->xy[v], &l->piece[i]);
    if (best->vertex == TRI_NONE || now.n_outside < best->n_outside ||
        (now.n_outside == best->n_outside && now.distance < best->distance))
        *best = now;
}

/* Chooses a vertex within a distance of p, from the ends of the pieces from number `first` on, the corners of triangle
 * t (if any) and the vertices around the cavity of p. Prefers one that lies between the ends of both crossing pieces,
 * then the nearest. */
static struct choice choose_vertex(const struct builder *l, int32_t first, tri_triangle_id t, struct tri_point p,
                                   double within)
{
    struct choice best = {TRI_NONE, 0, 0};
    assert(first + 2 <= l->n_pieces && within >= 0);
    for (int32_t i = first; i < l->n_pieces; i++) {
        try_vertex(l, first, l->piece[i].from, p, within, &best);
        try_vertex(l, first, l->piece[i].to, p, within, &best);
    }
    for (int k = 0; t != TRI_NONE && k < 3; k++)
        try_vertex(l, first, l->mesh->tri[t].v[k], p, within, &best);
    for (int32_t i = 0; t != TRI_NONE && i < l->cavity.n_edges; i++)
        try_vertex(l, first, l->cavity.edge[i].a->v, p, within, &best);
    return best;
}

/* Inserts a vertex at p, whose cavity has been found, with the marker and attributes of the piece `along`. */
static enum tri_status add_crossing(struct builder *l, struct tri_point p, const struct tri_piece *along,
                                    tri_vertex_id *vertex)
{
    struct tri_mesh *mesh = l->mesh;
    enum tri_status status = tri_mesh_reserve_vertices(mesh, 1, l->error);
    status = status ? status : tri_mesh_reserve_triangles(mesh, 2, l->error);
    if (status)
        return status;
    tri_vertex_id v = *vertex = mesh->n_vertices++;
    mesh->xy[v] = p;
    mesh->on[v] = TRI_VERTEX_INPUT;
    mesh->vertex_markers[v] = marker_of(l, along->course);
    if (mesh->n_attributes > 0)
        tri_interpolate_edge(mesh, along->from, along->to, p,
                             mesh->attributes + (size_t)v * (size_t)mesh->n_attributes);
    tri_cavity_fill(&l->cavity, mesh, v);
    l->report->crossings++;
    return update_corners(l, v) ? TRI_OK : no_memory(l);
}

/* Returns the point where the pieces cross: the crossing of their input segments, unless earlier bends have moved
 * it. */
static struct tri_point crossing_of(const struct builder *l, const struct tri_piece *a, const struct tri_piece *b)
{
    const struct tri_point *xy = l->mesh->xy;
    struct tri_point here = xy[a->from], there;
    int32_t s = a->course.first, t = b->course.first;
    bool crosses = tri_crossing(xy[a->from], xy[a->to], xy[b->from], xy[b->to], &here);
    assert(crosses);
    (void)crosses;
    if (s == t || s == TRI_NONE || t == TRI_NONE ||
        !tri_crossing(end_of(l, s, 0), end_of(l, s, 1), end_of(l, t, 0), end_of(l, t, 1), &there))
        return here;
    double reach = TRI_BESIDE * tri_resolution(here);
    return fabs(there.x - here.x) <= reach && fabs(there.y - here.y) <= reach ? there : here;
}

/* Returns whether v is near enough to this segment to be near enough to all segments of the same piece. Those segments
 * lie within TRI_BESIDE of this one. */
static bool is_near_common_line(const struct builder *l, int32_t segment, tri_vertex_id v)
{
    return segment == TRI_NONE || is_near_line(l, segment, v, TRI_SEGMENT_ASTRAY - TRI_BESIDE);
}

/* Sets *nearest and *least if the piece can be cut at `end`, an end of another piece, and that is nearer to it than
 * *least. The point must lie between the ends of the piece, near its segment, and also near the piece itself, because
 * other segments along it may have finer coordinates. */
static void try_end(const struct builder *l, const struct tri_piece *piece, tri_vertex_id end, tri_vertex_id *nearest,
                    double *least)
{
    if (!lies_between(l, l->mesh->xy[end], piece) || !is_near_common_line(l, piece->course.first, end) ||
        !is_near_common_line(l, piece->course.marked, end))
        return;
    double distance = tri_line_distance(l->mesh->xy[piece->from], l->mesh->xy[piece->to], l->mesh->xy[end]);
    if (distance < *least && distance <= (TRI_SEGMENT_ASTRAY - TRI_BESIDE) * tri_resolution(l->mesh->xy[end]))
        *nearest = end, *least = distance;
}

/* Piece number `first` crosses the pieces after it on the stack. Returns the nearest of their ends at which `first` can
 * be cut, so that they stay unchanged; otherwise an end of `first` at which one of them can be cut; otherwise
 * TRI_NONE. */
static tri_vertex_id nearest_end(const struct builder *l, int32_t first)
{
    tri_vertex_id nearest = TRI_NONE;
    double least = HUGE_VAL;
    const struct tri_piece *piece = &l->piece[first];
    for (int32_t i = first + 1; i < l->n_pieces; i++) {
        try_end(l, piece, l->piece[i].from, &nearest, &least);
        try_end(l, piece, l->piece[i].to, &nearest, &least);
    }
    for (int32_t i = first + 1; nearest == TRI_NONE && i < l->n_pieces; i++) {
        try_end(l, &l->piece[i], piece->from, &nearest, &least);
        try_end(l, &l->piece[i], piece->to, &nearest, &least);
    }
    return nearest;
}

/* Rule 3: the piece crosses subsegment s, and both are cut at a common vertex. */
static enum tri_status cut_at_crossing(struct builder *l, const struct tri_piece *piece, tri_sub_id s)
{
    assert(s >= 0 && s < l->mesh->n_subs && !tri_is_boundary(&l->mesh->sub[s])); /* pieces do not leave the hull */
    if (l->crossings_left-- == 0)
        return fail_for_segment(l, l->segment);
    const int32_t first = l->n_pieces;
    const tri_vertex_id near = l->mesh->sub[s].v[0];
    tri_sub_id on;
    tri_triangle_id t;
    if (!push_piece(l, piece->from, piece->to, piece->course) || !remove_for_rerouting(l, s))
        return no_memory(l);
    struct tri_point p = crossing_of(l, &l->piece[first], &l->piece[first + 1]);
    for (;;) {
        t = find_place(l, near, &p);
        on = t == TRI_NONE ? TRI_NONE : tri_sub_under(l->mesh, t, p);
        if (on == TRI_NONE)
            break;
        if (!remove_for_rerouting(l, on))
            return no_memory(l);
    }
    l->cavity.n_edges = 0;
    enum tri_search found = t == TRI_NONE ? TRI_SEARCH_OUTSIDE : tri_cavity_search(&l->cavity, l->mesh, p, t);
    if (found == TRI_SEARCH_NO_MEMORY)
        return no_memory(l);
    bool late = l->crossings_left < l->crossings / 2;
    bool room = found == TRI_SEARCH_FOUND && lies_between(l, p, &l->piece[first]) &&
                lies_between(l, p, &l->piece[first + 1]);
    struct choice shared = choose_vertex(l, first, t, p, TRI_VERTICES_APART * tri_resolution(p));
    tri_vertex_id v = late ? nearest_end(l, first) : TRI_NONE;
    if (v == TRI_NONE && shared.n_outside == 0)
        v = shared.vertex;
    if (v == TRI_NONE && !room) {
        v = shared.vertex == TRI_NONE && !late ? nearest_end(l, first) : shared.vertex;
        if (v == TRI_NONE)
            return fail_for_segment(l, l->segment);
    }
    if (v != TRI_NONE) {
        l->report->bent++;
    } else {
        bool later = l->piece[first].course.first > l->piece[first + 1].course.first;
        enum tri_status status = add_crossing(l, p, &l->piece[first + later], &v);
        if (status)
            return status;
    }
    return cut_pieces(l, first, v) ? TRI_OK : no_memory(l);
}

/* The first obstacle on the way of a piece. */
struct hit {
    tri_vertex_id end; /* the first vertex on the piece, perhaps its own end; TRI_NONE: a subsegment comes first */
    tri_sub_id across; /* that subsegment, otherwise TRI_NONE */
    tri_vertex_id beside; /* the nearest vertex passed within rounding of the piece, or TRI_NONE */
    double distance;
};

/* Rule 2: sets met->beside to v if v is within rounding of the piece and nearer than the previous one. */
static void consider_beside(const struct builder *l, const struct tri_piece *piece, tri_vertex_id v, double det,
                     struct hit *met)
{
    const struct tri_point *xy = l->mesh->xy, a = xy[piece->from], b = xy[piece->to], q = xy[v];
    double x = b.x - a.x, y = b.y - a.y, length2 = x * x + y * y, at = x * (q.x - a.x) + y * (q.y - a.y);
    double far = fmax(tri_resolution(q), fmax(tri_resolution(a), tri_resolution(b)));
    if (v == piece->from || v == piece->to || !(at > 0 && at < length2) ||
        fabs(det) > 8 * far * (fabs(x) + fabs(y)))
        return;
    double distance = tri_line_distance(a, b, q), near = TRI_ON_SEGMENT * tri_resolution(q);
    if (distance > near || fmin(at, length2 - at) <= near * sqrt(length2) ||
        !is_near_line(l, piece->course.first, v, TRI_BESIDE) || !comes_between(l, q, piece) ||
        (met->beside != TRI_NONE && met->distance <= distance))
        return;
    met->beside = v;
    met->distance = distance;
}

/* Finds the first obstacle of the piece. t: the triangle through which the piece leaves its start. */
static struct hit find_hit(const struct builder *l, const struct tri_piece *piece, tri_triangle_id t)
{
    const struct tri_mesh *mesh = l->mesh;
    struct tri_point pa = mesh->xy[piece->from], pb = mesh->xy[piece->to];
    struct hit met = {TRI_NONE, TRI_NONE, TRI_NONE, 0};
    if (t == TRI_NONE)
        return met;
    int e = tri_corner_of(&mesh->tri[t], piece->from);
    tri_vertex_id right = mesh->tri[t].v[tri_next[e]], left = mesh->tri[t].v[tri_prev[e]];
    double at_right = right == piece->to ? 0 : tri_orient2d(pa, pb, mesh->xy[right]);
    double at_left = at_right == 0 || left == piece->to ? 0 : tri_orient2d(pa, pb, mesh->xy[left]);
    if (at_right == 0 || at_left == 0) {
        met.end = at_right == 0 ? right : left;
        return met;
    }
    consider_beside(l, piece, right, at_right, &met);
    consider_beside(l, piece, left, at_left, &met);
    for (int64_t step = 0, end = INT64_MAX; step < end; step++) {
        l->report->looked_at++;
        tri_link link = mesh->tri[t].n[e];
        if (link < 0) {
            met.across = ~link;
            return met;
        }
        t = tri_of(link);
        e = tri_edge(link);
        tri_vertex_id o = mesh->tri[t].v[e];
        double side = o == piece->to ? 0 : tri_orient2d(pa, pb, mesh->xy[o]);
        if (side == 0) {
            met.end = o;
            return met;
        }
        consider_beside(l, piece, o, side, &met);
        if (met.beside != TRI_NONE && end == INT64_MAX)
            end = 2 * step + WINDOW;
        e = side > 0 ? tri_next[e] : tri_prev[e];
    }
    return met;
}

/* Cuts the piece at vertex v, and pushes both parts on the stack. */
static enum tri_status cut_at(struct builder *l, const struct tri_piece *piece, tri_vertex_id v)
{
    assert(comes_between(l, l->mesh->xy[v], piece));
    bool room = push_piece(l, v, piece->to, piece->course) && push_piece(l, piece->from, v, piece->course);
    return room ? TRI_OK : no_memory(l);
}

/* Inserts the first part of a piece, or cuts the piece, and pushes the rest on the stack. May exchange its ends. */
static enum tri_status insert_piece(struct builder *l, struct tri_piece piece)
{
    tri_triangle_id t = tri_find_exit(l->mesh, l->corner, &piece.from, &piece.to);
    struct hit met = find_hit(l, &piece, t);
    assert(piece.from != piece.to && (met.end == TRI_NONE || met.across == TRI_NONE));
    l->runs_along |= met.beside != TRI_NONE || (met.end != TRI_NONE && met.end != piece.to);
    if (met.beside != TRI_NONE && (met.end == TRI_NONE || met.end == piece.to)) {
        l->report->bent++;
        return cut_at(l, &piece, met.beside);
    }
    if (met.beside != TRI_NONE)
        return cut_at(l, &piece, met.end);
    if (met.across != TRI_NONE)
        return cut_at_crossing(l, &piece, met.across);
    assert(met.end != TRI_NONE); /* because the hull is convex */
    assert(met.end == piece.to || comes_between(l, l->mesh->xy[met.end], &piece));
    enum tri_status status = insert_edge(l, t, piece.from, met.end, piece.course);
    if (status)
        return status;
    return push_piece(l, met.end, piece.to, piece.course) ? TRI_OK : no_memory(l);
}

static void allow_crossings(struct builder *l)
{
    /* Limits rule 3. Usually, each subsegment crossed takes one application. */
    l->crossings = l->crossings_left = 200 + 10 * ((int64_t)l->mesh->n_subs + l->mesh->n_vertices);
}

static enum tri_status insert_pieces(struct builder *l)
{
    while (l->n_pieces > 0) {
        if (tri_stop_is_due(l->mesh->stop, &l->step))
            return tri_fail_stopped(l->error);
        enum tri_status status = insert_piece(l, l->piece[--l->n_pieces]);
        if (status)
            return status;
    }
    return TRI_OK;
}

static enum tri_status insert_segment(struct builder *l, const struct tri_piece *segment)
{
    l->n_pieces = 0;
    l->segment = segment->course.first;
    allow_crossings(l);
    return push_piece(l, segment->from, segment->to, segment->course) ? insert_pieces(l) : no_memory(l);
}

/* Rule 4: returns the nearer apex that is beside subsegment s within rounding; TRI_NONE: there is none. */
static tri_vertex_id find_beside(const struct builder *l, tri_sub_id s)
{
    const struct tri_mesh *mesh = l->mesh;
    const struct tri_subsegment *sub = &mesh->sub[s];
    struct hit met = {TRI_NONE, TRI_NONE, TRI_NONE, 0};
    struct tri_piece piece = {sub->v[0], sub->v[1], l->course[s]};
    for (int side = 0; side < 2 && piece.course.first != TRI_NONE; side++) {
        if (sub->side[side] == TRI_NONE)
            continue;
        tri_vertex_id v = tri_apex(mesh, sub->side[side]);
        struct tri_relative a = tri_relative(&mesh->xy[piece.from], mesh->xy[v]);
        struct tri_relative b = tri_relative(&mesh->xy[piece.to], mesh->xy[v]);
        consider_beside(l, &piece, v, tri_cross(a, b), &met);
    }
    return met.beside;
}

static enum tri_status reroute_through(struct builder *l, tri_sub_id s, tri_vertex_id v)
{
    l->n_pieces = 0;
    l->segment = l->course[s].first;
    l->report->bent++;
    return remove_for_rerouting(l, s) && cut_pieces(l, 0, v) ? insert_pieces(l) : no_memory(l);
}

static enum tri_status reroute_subs(struct builder *l)
{
    allow_crossings(l);
    for (bool again = true; again;) {
        again = false;
        for (tri_sub_id s = 0; s < l->mesh->n_subs;) {
            tri_vertex_id v = find_beside(l, s);
            enum tri_status status = v == TRI_NONE ? TRI_OK : reroute_through(l, s, v);
            if (status)
                return status;
            again = again || v != TRI_NONE;
            s += v == TRI_NONE;
        }
    }
    return TRI_OK;
}

static tri_triangle_id find_exit(void *context, tri_vertex_id *from, tri_vertex_id *to)
{
    const struct builder *l = context;
    return tri_find_exit(l->mesh, l->corner, from, to);
}

/* After a piece has met a vertex before its end, others may run along the same vertices, so the remaining pieces are
 * merged first (bundle.h). */
static enum tri_status insert_list(struct builder *l, struct tri_piece **piece, int32_t *n)
{
    int32_t k = 0;
    enum tri_status status = TRI_OK;
    for (; !status && k < *n && !l->runs_along; k++)
        status = insert_segment(l, &(*piece)[k]);
    *n -= k;
    memmove(*piece, *piece + k, (size_t)*n * sizeof **piece);
    if (!status && !tri_share_bundles(l->mesh, l->pslg->n_points, piece, n, find_exit, l, &l->report->looked_at))
        status = no_memory(l);
    for (k = 0; !status && k < *n; k++)
        status = insert_segment(l, &(*piece)[k]);
    return status;
}

static enum tri_status insert_all(struct builder *l)
{
    struct tri_piece *piece = malloc(((size_t)l->pslg->n_segments + 1) * sizeof *piece);
    int32_t n = piece ? tri_list_pieces(l->mesh, l->pslg, l->corner, piece, &l->report->skipped) : 0;
    enum tri_status status = piece && tri_put_in_rounds(&piece, n) ? TRI_OK : no_memory(l);
    status = status ? status : insert_list(l, &piece, &n);
    free(piece);
    return status ? status : reroute_subs(l);
}

static enum tri_status find_corners(struct builder *l)
{
    struct tri_mesh *mesh = l->mesh;
    l->corner_capacity = mesh->n_vertices + 64;
    l->corner = l->flips.corner = malloc((size_t)l->corner_capacity * sizeof *l->corner);
    if (!l->corner)
        return no_memory(l);
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        l->corner[v] = TRI_NONE;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3; k++)
            l->corner[mesh->tri[t].v[k]] = t;
    return TRI_OK;
}

static void free_builder(struct builder *l)
{
    tri_cavity_free(&l->cavity);
    tri_recovery_free(&l->recovery);
    free(l->corner);
    free(l->course);
    free(l->piece);
    tri_flips_free(&l->flips);
}

/* Initialises the hull edges: no segment runs along them yet. */
static enum tri_status init_courses(struct builder *l)
{
    for (tri_sub_id s = 0; s < l->mesh->n_subs; s++)
        if (!set_course(l, s, NO_SEGMENT))
            return no_memory(l);
    return TRI_OK;
}

/* Sets the marker of each subsegment and gives it its own parent. There are enough parents: each subsegment came with
 * one. */
static void finish_subs(struct builder *l)
{
    struct tri_mesh *mesh = l->mesh;
    assert(mesh->n_subs <= mesh->n_parents && mesh->n_subs <= l->course_capacity);
    mesh->n_parents = 0;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        struct tri_subsegment *sub = &mesh->sub[s];
        sub->marker = marker_of(l, l->course[s]);
        sub->parent = mesh->n_parents++;
        const int32_t segment = l->course[s].first;
        const bool reversed = segment != TRI_NONE &&
                              compare_along(l, segment, mesh->xy[sub->v[0]], mesh->xy[sub->v[1]]) < 0;
        mesh->parents[sub->parent] = (struct tri_parent){{sub->v[0], sub->v[1]}, segment, l->course[s].odd, reversed,
                                                         {NAN, NAN}};
    }
}

enum tri_status tri_constrain(struct tri_mesh *mesh, const struct tri_pslg *pslg, struct tri_constrain_report *report,
                              struct tri_error *error)
{
    struct builder l = {.mesh = mesh, .flips.mesh = mesh, .pslg = pslg, .report = report, .error = error};
    *report = (struct tri_constrain_report){0};
    enum tri_status status = find_corners(&l);
    status = status ? status : init_courses(&l);
    status = status ? status : insert_all(&l);
    if (!status)
        finish_subs(&l);
    free_builder(&l);
    return status;
}
