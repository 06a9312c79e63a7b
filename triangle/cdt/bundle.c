/* Input segments that run along the same vertices are merged into common paths.
 *
 * RULE. Pieces are processed in order of decreasing length; each one that is not yet merged becomes a carrier. Its
 * stops are the vertices within TRI_BUNDLE_ALONG resolutions of its line, found along it and for as many triangles
 * again beyond its ends. Of two stops within TRI_VERTICES_APART of each other along the line, only the first is kept.
 * Pieces whose two ends are stops are routed through all stops between them. If some of these pieces overlap, they are
 * cut at the stops, and one copy of each elementary piece is kept (tri_share_stops).
 *
 * THEOREM (distance; docs/theory.md, bundles). A piece is cut only at vertices within 2 TRI_BUNDLE_ALONG resolutions of
 * its own line, measured at its larger end.
 *
 * COST. A carrier costs at most four times what it crosses. After MOST_IN_VAIN triangles for each piece and vertex have
 * been visited without a merge, the remaining pieces stay unchanged. */
#include "triangle/cdt/bundle.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/heap_sort.h"
#include "triangle/base/scatter.h"
#include "triangle/cdt/crossing.h"
#include "triangle/geometry/predicates.h"
#include "triangle/tunables.h"

enum { MOST_IN_VAIN = 64 };

struct bundles {
    const struct tri_mesh *mesh;
    struct tri_piece *piece; /* [n]; from == to: the piece has been merged */
    int32_t n, n_vertices;
    int32_t *carrier, n_carriers; /* [n] the pieces that are not edges, longest first */
    int32_t *first, *incident; /* pieces incident[first[v] .. first[v + 1] - 1] are listed at v */
    struct tri_point a, b;     /* the carrier's ends */
    tri_vertex_id *stop;       /* [n_vertices] the first n_stops are the stops, in order along the carrier */
    int32_t *place;            /* [n_vertices] index among the stops, or TRI_NONE */
    int32_t n_stops;
    int32_t *member;           /* [n] the pieces whose two ends are stops */
    int32_t (*reach)[2];       /* [n] first and last stop of each member */
    int32_t n_members;
    struct tri_piece *result;
    int32_t n_results, result_capacity;
    int64_t looked_at, in_vain;
    uint32_t step; /* counter for tri_stop_is_due */
};

/* --- pieces by vertex */

static tri_vertex_id listed_at(const struct bundles *b, const int32_t *degree, int32_t i)
{
    tri_vertex_id from = b->piece[i].from, to = b->piece[i].to;
    return degree[from] <= degree[to] ? from : to;
}

static void list_pieces(struct bundles *b, int32_t *degree)
{
    for (int32_t i = 0; i < b->n; i++) {
        degree[b->piece[i].from]++;
        degree[b->piece[i].to]++;
    }
    for (int32_t i = 0; i < b->n; i++)
        b->first[listed_at(b, degree, i)]++;
    for (tri_vertex_id v = 0; v < b->n_vertices; v++)
        b->first[v + 1] += b->first[v];
    for (int32_t i = b->n - 1; i >= 0; i--)
        b->incident[--b->first[listed_at(b, degree, i)]] = i;
}

/* --- stops */

static double along(const struct bundles *b, tri_vertex_id v)
{
    struct tri_point q = b->mesh->xy[v];
    return (b->b.x - b->a.x) * (q.x - b->a.x) + (b->b.y - b->a.y) * (q.y - b->a.y);
}

static void try_stop(struct bundles *b, tri_vertex_id v)
{
    if (v >= b->n_vertices || b->place[v] != TRI_NONE)
        return;
    struct tri_point q = b->mesh->xy[v];
    if (tri_line_distance(b->a, b->b, q) > TRI_BUNDLE_ALONG * tri_resolution(q))
        return;
    b->place[v] = b->n_stops;
    b->stop[b->n_stops++] = v;
}

/* Walks from one end through triangle t to the other end, and as far again beyond it. A vertex on the line counts as on
 * its right. */
static void walk_along(struct bundles *b, tri_triangle_id t, tri_vertex_id from, tri_vertex_id to)
{
    const struct tri_mesh *mesh = b->mesh;
    const struct tri_point p = mesh->xy[from], q = mesh->xy[to];
    int e = tri_corner_of(&mesh->tri[t], from);
    if (tri_orient2d(p, q, mesh->xy[mesh->tri[t].v[tri_prev[e]]]) <= 0) { /* the line leaves along the left edge of t */
        tri_halfedge beyond = tri_across(mesh, tri_code(t, tri_next[e]));
        t = beyond == TRI_NONE ? t : tri_of(beyond);
        e = tri_corner_of(&mesh->tri[t], from);
    }
    const tri_vertex_id *v = mesh->tri[t].v;
    for (int k = 0; k < 3; k++)
        try_stop(b, v[k]);
    if (tri_orient2d(p, q, mesh->xy[v[tri_prev[e]]]) <= 0)
        return; /* the line runs along the hull, or leaves the mesh at once */
    for (int64_t step = 0, end = INT64_MAX; step < end; step++) {
        tri_halfedge code = tri_across(mesh, tri_code(t, e));
        if (code == TRI_NONE)
            return;
        t = tri_of(code);
        e = tri_edge(code);
        tri_vertex_id o = mesh->tri[t].v[e];
        b->looked_at++;
        try_stop(b, o);
        if (o == to)
            end = 2 * step + 2;
        e = tri_orient2d(p, q, mesh->xy[o]) > 0 ? tri_next[e] : tri_prev[e];
    }
}

static bool is_before(const void *context, int32_t v, int32_t w)
{
    const struct bundles *b = context;
    double at_v = along(b, v), at_w = along(b, w);
    return at_v != at_w ? at_v < at_w : v < w;
}

/* Sorts the stops along the carrier and drops those within TRI_VERTICES_APART of the previous one. */
static void sort_stops(struct bundles *b)
{
    double x = b->b.x - b->a.x, y = b->b.y - b->a.y, length = sqrt(x * x + y * y);
    int32_t kept = 0;
    tri_heap_sort(b->stop, b->n_stops, is_before, b);
    for (int32_t k = 0; k < b->n_stops; k++) {
        tri_vertex_id v = b->stop[k];
        double apart = TRI_VERTICES_APART * length * tri_resolution(b->mesh->xy[v]);
        b->place[v] = TRI_NONE;
        if (kept > 0 && along(b, v) - along(b, b->stop[kept - 1]) <= apart)
            continue;
        b->place[v] = kept;
        b->stop[kept++] = v;
    }
    b->n_stops = kept;
}

static void clear_stops(struct bundles *b)
{
    for (int32_t k = 0; k < b->n_stops; k++)
        b->place[b->stop[k]] = TRI_NONE;
    b->n_stops = 0;
}

/* --- bundles */

static bool is_earlier(const void *context, int32_t i, int32_t k)
{
    const struct tri_piece *piece = context;
    return piece[i].course.first < piece[k].course.first;
}

/* Finds the pieces whose two ends are stops, in order of their segments. Returns the number of elementary pieces that
 * they cover, counted with multiplicity. */
static int64_t find_members(struct bundles *b)
{
    int64_t sum = 0;
    b->n_members = 0;
    for (int32_t k = 0; k < b->n_stops; k++)
        for (int32_t i = b->first[b->stop[k]]; i < b->first[b->stop[k] + 1]; i++) {
            const struct tri_piece *piece = &b->piece[b->incident[i]];
            if (piece->from != piece->to && b->place[piece->from] != TRI_NONE && b->place[piece->to] != TRI_NONE)
                b->member[b->n_members++] = b->incident[i];
        }
    tri_heap_sort(b->member, b->n_members, is_earlier, b->piece);
    for (int32_t m = 0; m < b->n_members; m++) {
        int32_t p = b->place[b->piece[b->member[m]].from], q = b->place[b->piece[b->member[m]].to];
        b->reach[m][0] = p < q ? p : q;
        b->reach[m][1] = p < q ? q : p;
        sum += b->reach[m][1] - b->reach[m][0];
    }
    return sum;
}

/* Replaces the members by the pieces that they have been merged into. */
static bool store_shared(struct bundles *b, const struct tri_piece *shared, int32_t n)
{
    if (!tri_grow(&b->result, &b->result_capacity, b->n_results + n, sizeof *b->result))
        return false;
    memcpy(b->result + b->n_results, shared, (size_t)n * sizeof *shared);
    b->n_results += n;
    for (int32_t m = 0; m < b->n_members; m++)
        b->piece[b->member[m]].to = b->piece[b->member[m]].from;
    return true;
}

static bool merge_members(struct bundles *b)
{
    int64_t sum = find_members(b);
    int32_t n = b->n_members;
    if (n < 2)
        return true;
    struct tri_piece *shared = malloc((size_t)n * sizeof *shared);
    for (int32_t m = 0; shared && m < n; m++)
        shared[m] = b->piece[b->member[m]];
    bool room = shared && tri_share_stops(b->stop, b->n_stops, b->reach, &shared, &n);
    if (room && n < sum) /* otherwise they do not overlap */
        room = store_shared(b, shared, n);
    free(shared);
    return room;
}

/* --- carriers */

static bool is_longer(const void *context, int32_t i, int32_t k)
{
    const struct bundles *b = context;
    const struct tri_point *xy = b->mesh->xy;
    double li = tri_distance2(xy[b->piece[i].from], xy[b->piece[i].to]);
    double lk = tri_distance2(xy[b->piece[k].from], xy[b->piece[k].to]);
    return li != lk ? li > lk : i < k;
}

/* Finds the triangle through which the piece leaves its start. Returns false if there is none, or if the piece is
 * already an edge. */
static bool can_carry(const struct bundles *b, tri_exit *find_exit, void *context, tri_triangle_id *t,
                       tri_vertex_id *from, tri_vertex_id *to)
{
    *t = find_exit(context, from, to);
    const tri_vertex_id *v = *t == TRI_NONE ? NULL : b->mesh->tri[*t].v;
    return v && v[0] != *to && v[1] != *to && v[2] != *to;
}

/* Walks from both ends. The second walk continues beyond `from`, and takes the other side if the line runs through
 * vertices. If find_exit exchanges the ends, only one walk is possible. */
static bool process_carrier(struct bundles *b, int32_t carrier, tri_exit *find_exit, void *context)
{
    tri_vertex_id from = b->piece[carrier].from, to = b->piece[carrier].to;
    const int32_t n_results = b->n_results;
    const int64_t looked_at = b->looked_at;
    tri_triangle_id t;
    if (from == to || !can_carry(b, find_exit, context, &t, &from, &to))
        return true;
    b->a = b->mesh->xy[from];
    b->b = b->mesh->xy[to];
    walk_along(b, t, from, to);
    tri_vertex_id back_from = to, back_to = from;
    if (can_carry(b, find_exit, context, &t, &back_from, &back_to) && back_from != from)
        walk_along(b, t, back_from, back_to);
    sort_stops(b);
    bool room = merge_members(b);
    clear_stops(b);
    if (b->n_results == n_results)
        b->in_vain += b->looked_at - looked_at;
    return room;
}

static bool process_carriers(struct bundles *b, tri_exit *find_exit, void *context)
{
    const int64_t most = MOST_IN_VAIN * ((int64_t)b->n + b->n_vertices);
    bool room = true;
    for (int32_t i = 0; room && i < b->n_carriers && b->in_vain < most; i++) {
        if (tri_stop_is_due(b->mesh->stop, &b->step))
            break;
        room = process_carrier(b, b->carrier[i], find_exit, context);
    }
    return room;
}

static bool list_carriers(struct bundles *b, tri_exit *find_exit, void *context)
{
    b->carrier = malloc((size_t)b->n * sizeof *b->carrier);
    for (int32_t i = 0; b->carrier && i < b->n; i++) {
        tri_vertex_id from = b->piece[i].from, to = b->piece[i].to;
        tri_triangle_id t;
        if (can_carry(b, find_exit, context, &t, &from, &to))
            b->carrier[b->n_carriers++] = i;
    }
    if (b->carrier)
        tri_heap_sort(b->carrier, b->n_carriers, is_longer, b);
    return b->carrier;
}

static bool make_room(struct bundles *b)
{
    size_t vertices = (size_t)b->n_vertices, n = (size_t)b->n;
    b->first = calloc(vertices + 1, sizeof *b->first);
    b->incident = malloc(n * sizeof *b->incident);
    b->stop = malloc(vertices * sizeof *b->stop);
    b->place = calloc(vertices, sizeof *b->place);
    b->member = malloc(n * sizeof *b->member);
    b->reach = malloc(n * sizeof *b->reach);
    if (!b->first || !b->incident || !b->stop || !b->place || !b->member || !b->reach)
        return false;
    list_pieces(b, b->place); /* b->place holds degrees until here */
    for (size_t v = 0; v < vertices; v++)
        b->place[v] = TRI_NONE;
    return true;
}

/* Appends the pieces that no bundle contains to the merged ones. */
static bool add_others(struct bundles *b)
{
    if (!tri_grow(&b->result, &b->result_capacity, b->n_results + b->n, sizeof *b->result))
        return false;
    for (int32_t i = 0; i < b->n; i++)
        if (b->piece[i].from != b->piece[i].to)
            b->result[b->n_results++] = b->piece[i];
    return true;
}

static void free_bundles(struct bundles *b)
{
    free(b->carrier);
    free(b->first);
    free(b->incident);
    free(b->stop);
    free(b->place);
    free(b->member);
    free(b->reach);
    free(b->result);
}

bool tri_share_bundles(const struct tri_mesh *mesh, int32_t n_vertices, struct tri_piece **piece, int32_t *n,
                       tri_exit *find_exit, void *context, int64_t *looked_at)
{
    struct bundles b = {.mesh = mesh, .piece = *piece, .n = *n, .n_vertices = n_vertices};
    bool room = *n < 2 || list_carriers(&b, find_exit, context);
    if (room && b.n_carriers > 0)
        room = make_room(&b) && process_carriers(&b, find_exit, context) && add_others(&b);
    if (room && b.n_carriers > 0) {
        *piece = b.result;
        *n = b.n_results;
        b.result = b.piece;
    }
    *looked_at += b.looked_at;
    free_bundles(&b);
    return room;
}

/* Painting: in the order of the pieces, each one takes those elementary pieces of its range that are still free. A
 * union-find structure skips the others, so each elementary piece is visited once, regardless of how many pieces run
 * along it. */

struct sharing {
    const struct tri_piece *piece; /* [n] */
    const int32_t (*reach)[2];     /* [n] */
    int32_t n, n_stops;
    const tri_vertex_id *stop;     /* [n_stops] */
    int32_t *by_mark;              /* [n] pieces sorted by the first marked segment along them */
    int32_t *next;                 /* [n_stops] union-find: the next free elementary piece */
    int32_t *marked;               /* [n_stops] first segment with a marker along each elementary piece */
    bool *odd;                     /* [n_stops] whether an odd number of pieces runs along it */
    struct tri_piece *result;      /* [n_stops] */
    int32_t n_results;
};

static void free_all(struct sharing *s)
{
    for (int32_t k = 0; k < s->n_stops; k++)
        s->next[k] = k;
}

/* Returns the first free elementary piece at or after k. */
static int32_t find_free(const struct sharing *s, int32_t k)
{
    while (s->next[k] != k)
        k = s->next[k] = s->next[s->next[k]];
    return k;
}

static void paint_marked(struct sharing *s, int32_t i)
{
    if (s->piece[i].course.marked == TRI_NONE)
        return;
    for (int32_t k = s->reach[i][0]; (k = find_free(s, k)) < s->reach[i][1]; s->next[k] = k + 1)
        s->marked[k] = s->piece[i].course.marked;
}

static void paint_free(struct sharing *s, int32_t i)
{
    for (int32_t k = s->reach[i][0]; (k = find_free(s, k)) < s->reach[i][1]; s->next[k] = k + 1)
        s->result[s->n_results++] =
            (struct tri_piece){s->stop[k], s->stop[k + 1], {s->piece[i].course.first, s->marked[k], s->odd[k]}};
}

/* Computes parities by prefix sums: each piece flips the parity at its start and again at its end. */
static void find_odd(struct sharing *s)
{
    for (int32_t i = 0; i < s->n; i++) {
        s->odd[s->reach[i][0]] ^= s->piece[i].course.odd;
        s->odd[s->reach[i][1]] ^= s->piece[i].course.odd;
    }
    for (int32_t k = 1; k < s->n_stops; k++)
        s->odd[k] ^= s->odd[k - 1];
    assert(!s->odd[s->n_stops - 1]);
}

static bool is_marked_before(const void *context, int32_t a, int32_t b)
{
    const struct tri_piece *piece = context;
    return piece[a].course.marked != piece[b].course.marked ? piece[a].course.marked < piece[b].course.marked : a < b;
}

static void paint(struct sharing *s)
{
    for (int32_t i = 0; i < s->n; i++)
        s->by_mark[i] = i;
    tri_heap_sort(s->by_mark, s->n, is_marked_before, s->piece);
    for (int32_t k = 0; k < s->n_stops; k++)
        s->marked[k] = TRI_NONE;
    free_all(s);
    for (int32_t i = 0; i < s->n; i++)
        paint_marked(s, s->by_mark[i]);
    find_odd(s);
    free_all(s);
    for (int32_t i = 0; i < s->n; i++)
        paint_free(s, i);
}

bool tri_share_stops(const tri_vertex_id *stop, int32_t n_stops, int32_t (*reach)[2], struct tri_piece **piece,
                     int32_t *n)
{
    size_t stops = (size_t)n_stops;
    struct sharing s = {.piece = *piece, .reach = (const int32_t (*)[2])reach, .n = *n, .n_stops = n_stops,
                        .stop = stop,
                        .by_mark = malloc((size_t)*n * sizeof *s.by_mark),
                        .next = malloc(stops * sizeof *s.next),
                        .marked = malloc(stops * sizeof *s.marked),
                        .odd = calloc(stops, sizeof *s.odd),
                        .result = malloc(stops * sizeof *s.result)};
    bool room = s.by_mark && s.next && s.marked && s.odd && s.result;
    if (room) {
        paint(&s);
        free(*piece);
        *piece = s.result;
        *n = s.n_results;
    } else {
        free(s.result);
    }
    free(s.by_mark);
    free(s.next);
    free(s.marked);
    free(s.odd);
    return room;
}

/* Randomised insertion rounds (Amenta, Choi & Rote 2003). */

enum { ROUNDS = 24 }; /* enough to make the first round small for any input */

int32_t tri_list_pieces(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const tri_triangle_id *corner,
                        struct tri_piece *piece, int32_t *skipped)
{
    const int32_t *twin = mesh->twin, *markers = pslg->segment_markers;
    int32_t n = 0;
    for (int32_t k = 0; k < pslg->n_segments; k++) {
        tri_vertex_id a = pslg->segments[2 * k], b = pslg->segments[2 * k + 1];
        bool valid = a >= 0 && a < pslg->n_points && b >= 0 && b < pslg->n_points;
        if (valid && twin) {
            a = twin[a];
            b = twin[b];
        }
        if (!valid || a == b)
            ++*skipped;
        else if (corner[a] != TRI_NONE && corner[b] != TRI_NONE) /* otherwise all points are collinear */
            piece[n++] = (struct tri_piece){a, b, {k, markers && markers[k] ? k : TRI_NONE, true}};
    }
    return n;
}

/* Each round has about as many pieces as all rounds before it together. */
static int round_of(const struct tri_piece *piece)
{
    int round = ROUNDS - 1;
    for (uint32_t draw = tri_scatter((uint32_t)piece->course.first); round > 0 && draw % 2 == 0; draw /= 2)
        round--;
    return round;
}

bool tri_put_in_rounds(struct tri_piece **piece, int32_t n)
{
    int32_t at[ROUNDS + 1] = {0};
    struct tri_piece *sorted = malloc(((size_t)n + 1) * sizeof *sorted);
    if (!sorted)
        return false;
    for (int32_t i = 0; i < n; i++)
        at[round_of(&(*piece)[i]) + 1]++;
    for (int r = 0; r < ROUNDS; r++)
        at[r + 1] += at[r];
    for (int32_t i = 0; i < n; i++)
        sorted[at[round_of(&(*piece)[i])]++] = (*piece)[i];
    free(*piece);
    *piece = sorted;
    return true;
}
