/* Segment recovery by edge flips (Sloan 1993), then Lawson flips to the constrained Delaunay triangulation.
 *
 * A segment a -> b is laid piece by piece. From a the walk along the segment meets first either an edge that lies on
 * it, a vertex on it, a subsegment across it, or b. What is met becomes the end of the piece; a subsegment across it is
 * split first, at the crossing. So the channel of a piece holds neither vertices nor subsegments, and flips can clear
 * it.
 *
 * INVARIANT: between two pieces the mesh is a constrained Delaunay triangulation of what has been laid, and corner[v]
 * is a live triangle at v (TRI_NONE for points that are in no triangle). */
#include "triangle/constrain.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>

#include "triangle/cavity.h"
#include "triangle/interpolate.h"
#include "triangle/predicates.h"

enum { MAX_PIECES = 1 << 20, MAX_PASSES = 10000 };

struct piece {
    int32_t from, to, segment, marker;
};

struct layer {
    struct tri_mesh *mesh;
    struct tri_cavity cavity;
    bool ties_stay;  /* an edge is flipped only where that makes a difference; else ties are broken by coordinates */
    int32_t *corner; /* [vertex_capacity] */
    int32_t corner_capacity;
    struct piece *piece; /* stack of what remains of the current segment, and of earlier ones that had to be taken up */
    int32_t n_pieces, piece_capacity;
    int32_t *touched; /* stack of edge codes to test for the Delaunay property */
    int32_t n_touched, touched_capacity;
    int32_t segment, marker;
    uint32_t step; /* see tri_stop_is_due */
    struct tri_constrain_report *report;
    struct tri_error *error;
};

static enum tri_status no_memory(struct layer *l)
{
    return tri_fail(l->error, TRI_NO_MEMORY, NULL, 0, "out of memory for segment %d", (int)l->segment);
}

static bool reserve(void *array, int32_t *capacity, int32_t need, size_t item)
{
    if (need <= *capacity)
        return true;
    int32_t wanted = need + need / 2 + 64;
    void **slot = array;
    void *fresh = realloc(*slot, (size_t)wanted * item);
    if (!fresh)
        return false;
    *slot = fresh;
    *capacity = wanted;
    return true;
}

static bool push_piece(struct layer *l, int32_t from, int32_t to, int32_t segment, int32_t marker)
{
    if (from == to)
        return true;
    void *array = l->piece;
    bool room = reserve(&array, &l->piece_capacity, l->n_pieces + 1, sizeof *l->piece);
    l->piece = array;
    if (room)
        l->piece[l->n_pieces++] = (struct piece){from, to, segment, marker};
    return room;
}

static bool touch(struct layer *l, int32_t t)
{
    void *array = l->touched;
    bool room = reserve(&array, &l->touched_capacity, l->n_touched + 3, sizeof *l->touched);
    l->touched = array;
    for (int e = 0; room && e < 3; e++)
        l->touched[l->n_touched++] = tri_code(t, e);
    return room;
}

static int corner_of(const struct tri_triangle *t, int32_t v)
{
    assert(t->v[0] == v || t->v[1] == v || t->v[2] == v);
    return t->v[0] == v ? 0 : t->v[1] == v ? 1 : 2;
}

/* The next triangle around v, counter-clockwise or clockwise; TRI_NONE at the boundary. */
static int32_t turn(const struct tri_mesh *mesh, int32_t t, int32_t v, bool left)
{
    int k = corner_of(&mesh->tri[t], v);
    int32_t code = tri_across(mesh, tri_code(t, left ? tri_next[k] : tri_prev[k]));
    return code == TRI_NONE ? TRI_NONE : tri_of(code);
}

/* Does the ray from a (corner k of t) to q leave through t: right edge included, left edge not? */
static bool leaves_through(const struct tri_mesh *mesh, int32_t t, int k, struct tri_point q)
{
    const struct tri_triangle *at = &mesh->tri[t];
    struct tri_point a = mesh->xy[at->v[k]], right = mesh->xy[at->v[tri_next[k]]], left = mesh->xy[at->v[tri_prev[k]]];
    double r = tri_orient2d(a, right, q), s = tri_orient2d(a, left, q);
    if (r == 0) /* on the line of the right edge: ahead, not behind? */
        return (right.x - a.x) * (q.x - a.x) + (right.y - a.y) * (q.y - a.y) > 0;
    return r > 0 && s < 0;
}

static bool along_left(const struct tri_mesh *mesh, int32_t t, int k, struct tri_point q)
{
    const struct tri_triangle *at = &mesh->tri[t];
    struct tri_point a = mesh->xy[at->v[k]], left = mesh->xy[at->v[tri_prev[k]]];
    return tri_orient2d(a, left, q) == 0 && (left.x - a.x) * (q.x - a.x) + (left.y - a.y) * (q.y - a.y) > 0;
}

/* The triangle at vertex a through which the ray to q leaves; its left edge counts only where nothing lies beyond it.
 * Remembered as a's corner, so that the spokes of a fan in order cost O(1) each. */
static int32_t find_exit(struct layer *l, int32_t a, struct tri_point q)
{
    const struct tri_mesh *mesh = l->mesh;
    int32_t start = l->corner[a], t = start;
    for (int way = 1; way >= 0; way--) {
        for (t = start; t != TRI_NONE;) {
            int k = corner_of(&mesh->tri[t], a);
            if (leaves_through(mesh, t, k, q) || along_left(mesh, t, k, q))
                return l->corner[a] = t;
            t = turn(mesh, t, a, way);
            if (t == start)
                return TRI_NONE;
        }
    }
    return TRI_NONE;
}

static bool mark_edge(struct layer *l, int32_t t, int e)
{
    struct tri_mesh *mesh = l->mesh;
    int32_t link = mesh->tri[t].n[e], from = mesh->tri[t].v[tri_next[e]], to = mesh->tri[t].v[tri_prev[e]];
    if (link < 0) {
        struct tri_subsegment *s = &mesh->sub[~link];
        if (mesh->parents[s->parent].segment == TRI_NONE)
            mesh->parents[s->parent].segment = l->segment;
        if (s->marker == 0)
            s->marker = l->marker;
        return true;
    }
    if (tri_mesh_reserve_subs(mesh, 1, l->error))
        return false;
    int32_t s = tri_mesh_add_sub(mesh, from, to, l->marker, l->segment);
    mesh->sub[s].side[0] = tri_code(t, e);
    mesh->sub[s].side[1] = link;
    mesh->tri[t].n[e] = ~s;
    mesh->tri[tri_of(link)].n[tri_edge(link)] = ~s;
    return true;
}

/* Flips edge e of t, whose quadrilateral is strictly convex. Near apex n, right r, far apex o, left s: t becomes (n, r,
 * o), the neighbour (n, o, s). Returns the neighbour. */
static int32_t flip(struct layer *l, int32_t t, int e)
{
    struct tri_mesh *mesh = l->mesh;
    struct tri_triangle *near = &mesh->tri[t];
    int32_t u = tri_of(near->n[e]);
    int f = tri_edge(near->n[e]);
    struct tri_triangle *far = &mesh->tri[u];
    assert(near->n[e] >= 0 && far->n[f] == tri_code(t, e));
    int32_t n = near->v[e], r = near->v[tri_next[e]], s = near->v[tri_prev[e]], o = far->v[f];
    int32_t nr = near->n[tri_prev[e]], sn = near->n[tri_next[e]], ro = far->n[tri_next[f]], os = far->n[tri_prev[f]];
    near->v[0] = n, near->v[1] = r, near->v[2] = o;
    near->n[0] = ro, near->n[1] = tri_code(u, 2), near->n[2] = nr;
    far->v[0] = n, far->v[1] = o, far->v[2] = s;
    far->n[0] = os, far->n[1] = sn, far->n[2] = tri_code(t, 1);
    tri_relink(mesh, ro, r, tri_code(t, 0));
    tri_relink(mesh, nr, n, tri_code(t, 2));
    tri_relink(mesh, os, o, tri_code(u, 0));
    tri_relink(mesh, sn, s, tri_code(u, 1));
    l->corner[n] = l->corner[r] = l->corner[o] = t;
    l->corner[s] = u;
    return u;
}

static bool is_convex(const struct tri_mesh *mesh, int32_t t, int e)
{
    const struct tri_triangle *near = &mesh->tri[t];
    struct tri_point n = mesh->xy[near->v[e]], r = mesh->xy[near->v[tri_next[e]]], s = mesh->xy[near->v[tri_prev[e]]];
    struct tri_point o = mesh->xy[mesh->tri[tri_of(near->n[e])].v[tri_edge(near->n[e])]];
    return tri_orient2d(n, r, o) > 0 && tri_orient2d(n, o, s) > 0;
}

/* Does the apex beyond edge e of t lie inside the circle of t? */
static bool is_illegal(const struct layer *l, int32_t t, int e)
{
    const struct tri_mesh *mesh = l->mesh;
    const int32_t *v = mesh->tri[t].v;
    int32_t link = mesh->tri[t].n[e];
    struct tri_point a = mesh->xy[v[0]], b = mesh->xy[v[1]], c = mesh->xy[v[2]];
    struct tri_point apex = mesh->xy[mesh->tri[tri_of(link)].v[tri_edge(link)]];
    return l->ties_stay ? tri_incircle(a, b, c, apex) > 0 : tri_in_circle(a, b, c, apex);
}

/* Lawson: flips what is not Delaunay until everything touched is. */
static bool legalise(struct layer *l)
{
    struct tri_mesh *mesh = l->mesh;
    while (l->n_touched > 0) {
        int32_t code = l->touched[--l->n_touched], t = tri_of(code);
        int e = tri_edge(code);
        if (mesh->tri[t].n[e] < 0 || !is_illegal(l, t, e) || !is_convex(mesh, t, e))
            continue;
        int32_t u = flip(l, t, e);
        if (!touch(l, t) || !touch(l, u))
            return false;
    }
    return true;
}

/* What became of clearing a channel. */
enum clearing { CLEARED, NOT_YET, CLEARING_FAILED };

/* One walk through the channel from a to b that flips every crossing edge it can. CLEARED once edge ab exists;
 * CLEARING_FAILED where memory ran out. */
static enum clearing clear_pass(struct layer *l, int32_t a, int32_t b)
{
    struct tri_mesh *mesh = l->mesh;
    struct tri_point pa = mesh->xy[a], pb = mesh->xy[b];
    int32_t t = find_exit(l, a, pb);
    if (t == TRI_NONE)
        return NOT_YET;
    int e = corner_of(&mesh->tri[t], a);
    if (mesh->tri[t].v[tri_next[e]] == b || mesh->tri[t].v[tri_prev[e]] == b)
        return CLEARED;
    for (;;) {
        int32_t n = mesh->tri[t].v[e], u = tri_of(mesh->tri[t].n[e]);
        int f = tri_edge(mesh->tri[t].n[e]);
        int32_t o = mesh->tri[u].v[f];
        double side = o == b ? 0 : tri_orient2d(pa, pb, mesh->xy[o]);
        if (is_convex(mesh, t, e)) {
            u = flip(l, t, e);
            if (!touch(l, t) || !touch(l, u))
                return CLEARING_FAILED;
            if (n == a && o == b)
                return CLEARED;
            if (o == b)
                return NOT_YET;
            t = side > 0 ? t : u;
            e = 0;
        } else {
            if (o == b)
                return NOT_YET;
            t = u;
            e = side > 0 ? tri_next[f] : tri_prev[f]; /* the edge from right to o, or from o to left */
        }
    }
}

static enum clearing clear_channel(struct layer *l, int32_t a, int32_t b)
{
    for (int pass = 0; pass < MAX_PASSES; pass++) {
        enum clearing done = clear_pass(l, a, b);
        if (done != NOT_YET)
            return done;
    }
    return NOT_YET;
}

/* Makes the edge ab a subsegment after its channel is clear. */
static bool mark_piece(struct layer *l, int32_t a, int32_t b)
{
    int32_t t = find_exit(l, a, l->mesh->xy[b]);
    assert(t != TRI_NONE);
    int k = corner_of(&l->mesh->tri[t], a);
    bool right = l->mesh->tri[t].v[tri_next[k]] == b;
    assert(right || l->mesh->tri[t].v[tri_prev[k]] == b);
    return mark_edge(l, t, right ? tri_prev[k] : tri_next[k]);
}

static bool keep_corners(struct layer *l, int32_t v)
{
    void *array = l->corner;
    bool room = reserve(&array, &l->corner_capacity, l->mesh->n_vertices, sizeof *l->corner);
    l->corner = array;
    if (!room)
        return false;
    for (int32_t i = 0; i < l->cavity.n_rim; i++) {
        const struct tri_triangle *t = &l->mesh->tri[l->cavity.rim[i].slot];
        for (int k = 0; k < 3; k++)
            l->corner[t->v[k]] = l->cavity.rim[i].slot;
    }
    return l->corner[v] != TRI_NONE;
}

/* Where segment a -> b crosses subsegment s, as a fraction of s from its start. */
static double crossing_fraction(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b, int32_t s)
{
    double from = fabs(tri_orient2d(a, b, mesh->xy[mesh->sub[s].v[0]]));
    double to = fabs(tri_orient2d(a, b, mesh->xy[mesh->sub[s].v[1]]));
    return from / (from + to);
}

/* Takes subsegment s, which has triangles on both sides, out of the mesh; the last one takes its number. */
static bool take_up(struct layer *l, int32_t s)
{
    struct tri_mesh *mesh = l->mesh;
    int32_t left = mesh->sub[s].side[0], right = mesh->sub[s].side[1];
    assert(left != TRI_NONE && right != TRI_NONE);
    mesh->tri[tri_of(left)].n[tri_edge(left)] = right;
    mesh->tri[tri_of(right)].n[tri_edge(right)] = left;
    int32_t last = --mesh->n_subs;
    mesh->sub[s] = mesh->sub[last];
    for (int side = 0; s != last && side < 2; side++)
        if (mesh->sub[s].side[side] != TRI_NONE)
            mesh->tri[tri_of(mesh->sub[s].side[side])].n[tri_edge(mesh->sub[s].side[side])] = ~s;
    return touch(l, tri_of(left)) && touch(l, tri_of(right)) && legalise(l);
}

static double squared(struct tri_point a, struct tri_point b)
{
    double x = b.x - a.x, y = b.y - a.y;
    return x * x + y * y;
}

/* Square of the distance up to which places on the segment from a to b count as one. */
static double rounding2(struct tri_point a, struct tri_point b)
{
    double size = fmax(fmax(fabs(a.x), fabs(a.y)), fmax(fabs(b.x), fabs(b.y)));
    return size * size * 0x1p-96;
}

static void try_nearer(const struct layer *l, int32_t v, struct tri_point p, int32_t *best)
{
    if (v != TRI_NONE && squared(l->mesh->xy[v], p) < squared(l->mesh->xy[*best], p))
        *best = v;
}

static int32_t apex_beside(const struct tri_mesh *mesh, const struct tri_subsegment *s, int side)
{
    return s->side[side] == TRI_NONE ? TRI_NONE : mesh->tri[tri_of(s->side[side])].v[tri_edge(s->side[side])];
}

/* Takes up s and lays it anew through vertex v. */
static enum tri_status lay_through(struct layer *l, int32_t s, int32_t v)
{
    const struct tri_subsegment old = l->mesh->sub[s];
    int32_t segment = l->mesh->parents[old.parent].segment;
    if (old.side[0] == TRI_NONE || old.side[1] == TRI_NONE)
        return TRI_OK;
    bool room = take_up(l, s) && push_piece(l, old.v[0], v, segment, old.marker) &&
                push_piece(l, v, old.v[1], segment, old.marker);
    return room ? TRI_OK : no_memory(l);
}

/* There is no room for a vertex at p, where a -> b crosses subsegment s. Either a vertex is as good as there: both
 * segments run through it. Or a triangle beside s is so flat that p, rounded, lies beyond it: then s runs through its
 * apex, and a -> b is laid again. */
static enum tri_status bend(struct layer *l, int32_t a, int32_t b, int32_t s, struct tri_point p, int32_t *end)
{
    const struct tri_mesh *mesh = l->mesh;
    const struct tri_subsegment *sub = &mesh->sub[s];
    int32_t near = sub->v[0], left = apex_beside(mesh, sub, 0), right = apex_beside(mesh, sub, 1);
    l->report->bent++;
    try_nearer(l, sub->v[1], p, &near);
    try_nearer(l, left, p, &near);
    try_nearer(l, right, p, &near);
    try_nearer(l, a, p, &near);
    try_nearer(l, b, p, &near);
    for (int32_t i = 0; i < l->cavity.n_rim; i++)
        try_nearer(l, l->cavity.rim[i].a, p, &near);
    *end = near;
    struct tri_point from = mesh->xy[sub->v[0]], to = mesh->xy[sub->v[1]];
    bool is_there = squared(mesh->xy[near], p) <= 4 * rounding2(from, to) || left == TRI_NONE || right == TRI_NONE;
    if (near == sub->v[0] || near == sub->v[1])
        return TRI_OK;
    if (is_there)
        return lay_through(l, s, near);
    *end = b;
    bool flat_left = fabs(tri_orient2d(from, to, mesh->xy[left])) < fabs(tri_orient2d(from, to, mesh->xy[right]));
    return lay_through(l, s, flat_left ? left : right);
}

/* Is p so near to a corner of its cavity that an edge between them would be all rounding? */
static bool is_crammed(const struct layer *l, int32_t s, struct tri_point p)
{
    const struct tri_mesh *mesh = l->mesh;
    double nearest = HUGE_VAL;
    for (int32_t i = 0; i < l->cavity.n_rim; i++)
        nearest = fmin(nearest, squared(mesh->xy[l->cavity.rim[i].a], p));
    return nearest <= rounding2(mesh->xy[mesh->sub[s].v[0]], mesh->xy[mesh->sub[s].v[1]]);
}

/* Splits subsegment s where a -> b crosses it. *end receives the new vertex or, where there is no room for one between
 * existing vertices, the nearest of those. */
static enum tri_status cut(struct layer *l, int32_t a, int32_t b, int32_t s, int32_t *end)
{
    struct tri_mesh *mesh = l->mesh;
    int32_t from = mesh->sub[s].v[0], to = mesh->sub[s].v[1], n_left;
    double fraction = crossing_fraction(mesh, mesh->xy[a], mesh->xy[b], s);
    struct tri_point p = tri_point_between(mesh->xy[from], mesh->xy[to], fraction);
    enum tri_search found = tri_cavity_search_split(&l->cavity, mesh, p, s, &n_left);
    if (found == TRI_SEARCH_NO_MEMORY)
        return no_memory(l);
    if (found != TRI_SEARCH_FOUND || is_crammed(l, s, p))
        return bend(l, a, b, s, p, end);
    enum tri_status status = tri_mesh_reserve_vertices(mesh, 1, l->error);
    status = status ? status : tri_mesh_reserve_triangles(mesh, 2, l->error);
    status = status ? status : tri_mesh_reserve_subs(mesh, 1, l->error);
    if (status)
        return status;
    int32_t v = mesh->n_vertices++;
    mesh->xy[v] = p;
    mesh->on[v] = TRI_VERTEX_INPUT;
    mesh->vertex_markers[v] = mesh->sub[s].marker;
    tri_interpolate_edge(mesh, from, to, fraction, v);
    tri_cavity_fill_split(&l->cavity, mesh, v, s, n_left);
    l->report->crossings++;
    *end = v;
    if (!keep_corners(l, v))
        return no_memory(l);
    for (int32_t i = 0; i < l->cavity.n_rim; i++)
        if (!touch(l, l->cavity.rim[i].slot))
            return no_memory(l);
    return legalise(l) ? TRI_OK : no_memory(l);
}

/* What the segment a -> b meets first: *s, a subsegment that lies across it, else *end, the vertex that ends the first
 * piece (vertices on the segment end a piece); the other becomes TRI_NONE, both where there is no way out of a. */
static void look_ahead(struct layer *l, int32_t a, int32_t b, int32_t *end, int32_t *s)
{
    const struct tri_mesh *mesh = l->mesh;
    struct tri_point pa = mesh->xy[a], pb = mesh->xy[b];
    int32_t t = find_exit(l, a, pb);
    *s = TRI_NONE;
    *end = TRI_NONE;
    if (t == TRI_NONE)
        return;
    int e = corner_of(&mesh->tri[t], a);
    int32_t right = mesh->tri[t].v[tri_next[e]], left = mesh->tri[t].v[tri_prev[e]];
    if (tri_orient2d(pa, mesh->xy[right], pb) == 0 || tri_orient2d(pa, mesh->xy[left], pb) == 0) {
        *end = tri_orient2d(pa, mesh->xy[right], pb) == 0 ? right : left;
        return;
    }
    for (;;) {
        int32_t link = mesh->tri[t].n[e];
        if (link < 0) {
            *s = ~link;
            return;
        }
        t = tri_of(link);
        e = tri_edge(link);
        int32_t o = mesh->tri[t].v[e];
        double side = o == b ? 0 : tri_orient2d(pa, pb, mesh->xy[o]);
        if (side == 0) {
            *end = o;
            return;
        }
        e = side > 0 ? tri_next[e] : tri_prev[e];
    }
}

/* Lays the first part of a piece and puts the rest back on the stack. */
static enum tri_status lay_piece(struct layer *l, const struct piece *piece)
{
    int32_t a = piece->from, b = piece->to, end, s;
    look_ahead(l, a, b, &end, &s);
    assert(a != b && (s == TRI_NONE || end == TRI_NONE));
    if (s != TRI_NONE) {
        enum tri_status status = cut(l, a, b, s, &end);
        if (status)
            return status;
        /* The rest first: the stack hands out the part from a next. */
        bool room = push_piece(l, end, b, piece->segment, piece->marker) &&
                    push_piece(l, a, end, piece->segment, piece->marker);
        return room ? TRI_OK : no_memory(l);
    }
    if (end == TRI_NONE) {
        l->report->lost++;
        return TRI_OK;
    }
    enum clearing cleared = clear_channel(l, a, end);
    if (cleared == CLEARING_FAILED)
        return no_memory(l);
    if (cleared == NOT_YET)
        l->report->lost++;
    if ((cleared == CLEARED && !mark_piece(l, a, end)) || !legalise(l) ||
        !push_piece(l, end, b, piece->segment, piece->marker))
        return no_memory(l);
    return TRI_OK;
}

static enum tri_status lay_segment(struct layer *l, int32_t a, int32_t b, int32_t segment, int32_t marker)
{
    l->n_pieces = 0;
    if (!push_piece(l, a, b, segment, marker))
        return no_memory(l);
    for (int32_t n = 0; l->n_pieces > 0; n++) {
        if (tri_stop_is_due(l->mesh->stop, &l->step))
            return tri_fail_stopped(l->error);
        struct piece next = l->piece[--l->n_pieces];
        if (n >= MAX_PIECES) {
            l->report->lost += l->n_pieces + 1;
            break;
        }
        if (l->corner[next.from] == TRI_NONE || l->corner[next.to] == TRI_NONE)
            continue;
        l->segment = next.segment;
        l->marker = next.marker;
        enum tri_status status = lay_piece(l, &next);
        if (status)
            return status;
    }
    return TRI_OK;
}

static enum tri_status lay_all(struct layer *l, const struct tri_pslg *pslg)
{
    const int32_t *twin = l->mesh->twin;
    for (int32_t k = 0; k < pslg->n_segments; k++) {
        int32_t a = pslg->segments[2 * k], b = pslg->segments[2 * k + 1];
        bool valid = a >= 0 && a < pslg->n_points && b >= 0 && b < pslg->n_points;
        if (valid && twin) {
            a = twin[a];
            b = twin[b];
        }
        if (!valid || a == b) {
            l->report->skipped++;
            continue;
        }
        enum tri_status status = lay_segment(l, a, b, k, pslg->segment_markers ? pslg->segment_markers[k] : 0);
        if (status)
            return status;
    }
    return TRI_OK;
}

static enum tri_status find_corners(struct layer *l)
{
    struct tri_mesh *mesh = l->mesh;
    l->corner_capacity = mesh->n_vertices + 64;
    l->corner = malloc((size_t)l->corner_capacity * sizeof *l->corner);
    if (!l->corner)
        return no_memory(l);
    for (int32_t v = 0; v < mesh->n_vertices; v++)
        l->corner[v] = TRI_NONE;
    for (int32_t t = 0; t < mesh->n_slots; t++)
        for (int k = 0; k < 3; k++)
            l->corner[mesh->tri[t].v[k]] = t;
    return TRI_OK;
}

static void free_layer(struct layer *l)
{
    tri_cavity_free(&l->cavity);
    free(l->corner);
    free(l->piece);
    free(l->touched);
}

enum tri_status tri_constrain(struct tri_mesh *mesh, const struct tri_pslg *pslg, struct tri_constrain_report *report,
                              struct tri_error *error)
{
    struct layer l = {.mesh = mesh, .cavity = {.flips_follow = true}, .report = report, .error = error};
    *report = (struct tri_constrain_report){0};
    enum tri_status status = find_corners(&l);
    status = status ? status : lay_all(&l, pslg);
    free_layer(&l);
    return status;
}

/* Touches the edges that lead to triangles of higher number: so each edge is touched by one of its two. */
static bool touch_upwards(struct layer *l, int32_t t)
{
    if (!touch(l, t))
        return false;
    l->n_touched -= 3;
    for (int e = 0; e < 3; e++)
        if (l->mesh->tri[t].n[e] > tri_code(t, e))
            l->touched[l->n_touched++] = tri_code(t, e);
    return true;
}

enum tri_status tri_flip_to_delaunay(struct tri_mesh *mesh, struct tri_error *error)
{
    struct layer l = {.mesh = mesh, .ties_stay = true, .error = error};
    enum tri_status status = find_corners(&l);
    for (int32_t t = 0; !status && t < mesh->n_slots; t++)
        if (tri_stop_is_due(mesh->stop, &l.step))
            status = tri_fail_stopped(error);
        else if (!touch_upwards(&l, t) || !legalise(&l))
            status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for flips");
    free_layer(&l);
    return status;
}
