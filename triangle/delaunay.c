/* Incremental Delaunay triangulation in biased randomised Hilbert order.
 *
 * Rounds of geometrically growing random samples, each along the Hilbert curve (Amenta, Choi & Rote 2003): the next
 * point lies near the last one, so location is a walk of few steps, and no order of input makes cavities large on
 * average.
 *
 * The plane outside the hull is tiled by ghosts: triangles of a hull edge and a vertex at infinity (GHOST). The
 * "circumdisk" of a ghost is the open half plane beyond its hull edge, and the open edge itself; with that, insertion
 * knows no special case outside the hull. INVARIANT: every edge of every triangle, real or ghost, has a neighbour. At
 * the end ghosts become subsegments of the hull.
 *
 * Work is done on a copy of the points in insertion order, so that what is near in the plane is near in memory. */
#include "triangle/delaunay.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/hilbert.h"
#include "triangle/predicates.h"
#include "triangle/quality.h"

enum { GHOST = -2, FIRST_ROUND = 512, ROUND_GROWTH = 8 };

struct rim {
    int32_t outer, a;
};

struct pending {
    int32_t link, end;
};

/* The triangulation while it grows: points in order of insertion. */
struct builder {
    struct tri_point *xy;
    struct tri_triangle *tri;
    int32_t n_slots, last; /* last: a triangle near the point inserted last */
    int32_t n_cavity, n_rim, capacity;
    int32_t *cavity;
    struct rim *rim;
    struct pending *pending;
};

static bool grow(struct builder *b)
{
    int32_t capacity = b->capacity ? 2 * b->capacity : 256;
    size_t n = (size_t)capacity + 4;
    int32_t *cavity = realloc(b->cavity, n * sizeof *cavity);
    b->cavity = cavity ? cavity : b->cavity;
    struct rim *rim = realloc(b->rim, n * sizeof *rim);
    b->rim = rim ? rim : b->rim;
    struct pending *pending = realloc(b->pending, n * sizeof *pending);
    b->pending = pending ? pending : b->pending;
    if (!cavity || !rim || !pending)
        return false;
    b->capacity = capacity;
    return true;
}

static int ghost_corner(const struct tri_triangle *t)
{
    return t->v[0] == GHOST ? 0 : t->v[1] == GHOST ? 1 : t->v[2] == GHOST ? 2 : -1;
}

/* Strictly between a and b, where the three are collinear. */
static bool between(struct tri_point a, struct tri_point b, struct tri_point q)
{
    return a.x != b.x ? (a.x < q.x) != (b.x < q.x) && q.x != a.x && q.x != b.x
                      : (a.y < q.y) != (b.y < q.y) && q.y != a.y && q.y != b.y;
}

/* A ghost's hull edge runs from -> to with the outside on its left. */
static bool in_ghost(const struct builder *b, const struct tri_triangle *t, int ghost, struct tri_point q)
{
    struct tri_point from = b->xy[t->v[tri_next[ghost]]], to = b->xy[t->v[tri_prev[ghost]]];
    double side = tri_orient2d(from, to, q);
    return side > 0 || (side == 0 && between(from, to, q));
}

static inline bool in_disk(const struct builder *b, const struct tri_triangle *t, struct tri_point q)
{
    if ((t->v[0] | t->v[1] | t->v[2]) < 0)
        return in_ghost(b, t, ghost_corner(t), q);
    return tri_in_circle(b->xy[t->v[0]], b->xy[t->v[1]], b->xy[t->v[2]], q);
}

/* Walks by visibility from a real triangle to one whose disk holds q: it contains q, or is a ghost beyond the hull edge
 * that the walk leaves through. Exact orientations: the walk cannot cycle in a Delaunay triangulation. */
static int32_t locate(const struct builder *b, struct tri_point q)
{
    int32_t t = b->last;
    int from = -1;
    for (;;) {
        const struct tri_triangle *at = &b->tri[t];
        int k = 0;
        if (ghost_corner(at) >= 0)
            return t;
        for (; k < 3; k++)
            if (k != from && tri_orient2d(b->xy[at->v[tri_next[k]]], b->xy[at->v[tri_prev[k]]], q) < 0)
                break;
        if (k == 3)
            return t;
        t = tri_of(at->n[k]);
        from = tri_edge(at->n[k]);
    }
}

static bool explore(struct builder *b, struct tri_point q, int32_t link, int32_t a, int32_t end)
{
    int32_t n_pending = 0;
    for (;;) {
        const struct tri_triangle *t = &b->tri[tri_of(link)];
        int e = tri_edge(link);
        if (in_disk(b, t, q)) {
            if (b->n_cavity == b->capacity && !grow(b))
                return false;
            b->cavity[b->n_cavity++] = tri_of(link);
            b->pending[n_pending++] = (struct pending){t->n[tri_prev[e]], end};
            link = t->n[tri_next[e]];
            end = t->v[e];
            continue;
        }
        assert(b->n_rim < b->n_cavity + 2 && n_pending <= b->n_cavity);
        b->rim[b->n_rim++] = (struct rim){link, a};
        if (n_pending == 0)
            return true;
        a = end;
        link = b->pending[--n_pending].link;
        end = b->pending[n_pending].end;
    }
}

/* Replaces the cavity by the fan of v; room for two more triangles exists. */
static void fill(struct builder *b, int32_t v)
{
    int32_t before = TRI_NONE, first = TRI_NONE;
    assert(b->n_rim == b->n_cavity + 2); /* a disk without a vertex inside */
    for (int32_t i = 0; i < b->n_rim; i++) {
        int32_t slot = i < b->n_cavity ? b->cavity[i] : b->n_slots++;
        int32_t outer = b->rim[i].outer, end = b->rim[i + 1 < b->n_rim ? i + 1 : 0].a;
        struct tri_triangle *t = &b->tri[slot];
        int32_t link = before == TRI_NONE ? TRI_NONE : tri_code(before, 1);
        *t = (struct tri_triangle){{v, b->rim[i].a, end}, {outer, TRI_NONE, link}, 0, 0};
        b->tri[tri_of(outer)].n[tri_edge(outer)] = tri_code(slot, 0);
        if (before != TRI_NONE)
            b->tri[before].n[1] = tri_code(slot, 2);
        else
            first = slot;
        before = slot;
    }
    b->tri[first].n[2] = tri_code(before, 1);
    b->tri[before].n[1] = tri_code(first, 2);
    int ghost = ghost_corner(&b->tri[first]);
    b->last = ghost < 0 ? first : tri_of(b->tri[first].n[ghost]);
}

static bool insert(struct builder *b, int32_t v)
{
    struct tri_point q = b->xy[v];
    int32_t t = locate(b, q);
    const struct tri_triangle start = b->tri[t];
    b->n_cavity = b->n_rim = 0;
    if (b->capacity == 0 && !grow(b))
        return false;
    b->cavity[b->n_cavity++] = t;
    for (int e = 0; e < 3; e++)
        if (!explore(b, q, start.n[e], start.v[tri_next[e]], start.v[tri_prev[e]]))
            return false;
    fill(b, v);
    return true;
}

/* The first triangle and its three ghosts, from vertices i, j, k counter-clockwise. Ghost e + 1 sees edge e the other
 * way round; its edge from the hull edge's far end to infinity is shared with the ghost of the edge that starts
 * there. */
static void begin(struct builder *b, int32_t i, int32_t j, int32_t k)
{
    int32_t v[3] = {i, j, k};
    b->tri[0] = (struct tri_triangle){{i, j, k}, {tri_code(1, 0), tri_code(2, 0), tri_code(3, 0)}, 0, 0};
    for (int e = 0; e < 3; e++) {
        int f = tri_next[e], g = tri_prev[e];
        b->tri[e + 1] = (struct tri_triangle){
            {GHOST, v[g], v[f]}, {tri_code(0, e), tri_code(g + 1, 2), tri_code(f + 1, 1)}, 0, 0};
    }
    b->n_slots = 4;
    b->last = 0;
}

/* Moves a vertex that spans a triangle with the first two to place 2; false where all are collinear. */
static bool find_triangle(struct builder *b, int32_t *order, int32_t n)
{
    for (int32_t i = 2; i < n; i++) {
        if (tri_orient2d(b->xy[0], b->xy[1], b->xy[i]) == 0)
            continue;
        struct tri_point q = b->xy[i];
        int32_t index = order[i];
        memmove(&b->xy[3], &b->xy[2], (size_t)(i - 2) * sizeof *b->xy);
        memmove(&order[3], &order[2], (size_t)(i - 2) * sizeof *order);
        b->xy[2] = q;
        order[2] = index;
        return true;
    }
    return false;
}

static uint32_t scatter(uint32_t i)
{
    i ^= i >> 16;
    i *= UINT32_C(0x7feb352d);
    i ^= i >> 15;
    i *= UINT32_C(0x846ca68b);
    return i ^ i >> 16;
}

/* Splits the curve order into rounds: round r of R holds one point in ROUND_GROWTH^(R - r), drawn by a fixed hash. */
static void arrange_rounds(const int32_t *order, int32_t n, int32_t *arranged)
{
    int rounds = 0;
    int32_t placed = 0;
    for (int64_t size = FIRST_ROUND; size < n; size *= ROUND_GROWTH)
        rounds++;
    for (int r = rounds; r >= 0; r--)
        for (int32_t i = 0; i < n; i++) {
            uint32_t draw = scatter((uint32_t)i);
            int level = 0; /* how many times in a row the draw says "earlier" */
            while (level < rounds && draw % ROUND_GROWTH == 0) {
                draw /= ROUND_GROWTH;
                level++;
            }
            if (level == r)
                arranged[placed++] = order[i];
        }
}

/* Drops duplicates, which are neighbours in the order; returns how many points remain. */
static int32_t drop_duplicates(struct tri_mesh *mesh, int32_t *order, int32_t n)
{
    int32_t kept = 0;
    for (int32_t i = 0; i < n; i++) {
        int32_t last = kept ? order[kept - 1] : TRI_NONE;
        const struct tri_point *q = &mesh->xy[order[i]];
        if (last != TRI_NONE && mesh->xy[last].x == q->x && mesh->xy[last].y == q->y)
            mesh->twin[order[i]] = last;
        else
            order[kept++] = order[i];
    }
    return kept;
}

static enum tri_status build(struct builder *b, int32_t *order, int32_t n, const struct tri_stop *stop,
                             struct tri_error *error)
{
    uint32_t step = 0;
    if (n < 3 || !find_triangle(b, order, n))
        return TRI_OK;
    bool left = tri_orient2d(b->xy[0], b->xy[1], b->xy[2]) > 0;
    begin(b, left ? 0 : 1, left ? 1 : 0, 2);
    for (int32_t v = 3; v < n; v++) {
        if (tri_stop_is_due(stop, &step))
            return tri_fail_stopped(error);
        if (!insert(b, v))
            return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a cavity");
    }
    return TRI_OK;
}

/* Ghosts become subsegments, vertices get their own numbers back. */
static enum tri_status finish(struct tri_mesh *mesh, struct builder *b, const int32_t *order, struct tri_error *error)
{
    int32_t ghosts = 0;
    for (int32_t t = 0; t < b->n_slots; t++)
        ghosts += ghost_corner(&b->tri[t]) >= 0;
    enum tri_status status = tri_mesh_reserve_subs(mesh, ghosts, error);
    if (status)
        return status;
    mesh->n_slots = b->n_slots;
    assert(mesh->n_slots <= mesh->slot_capacity);
    for (int32_t t = 0; t < b->n_slots; t++) {
        struct tri_triangle *at = &mesh->tri[t];
        int ghost = ghost_corner(at);
        if (ghost < 0)
            continue;
        int32_t inner = at->n[ghost], from = at->v[tri_prev[ghost]], to = at->v[tri_next[ghost]];
        int32_t s = tri_mesh_add_sub(mesh, order[from], order[to], 0, TRI_NONE);
        mesh->sub[s].side[0] = inner;
        mesh->tri[tri_of(inner)].n[tri_edge(inner)] = ~s;
    }
    for (int32_t t = 0; t < b->n_slots; t++) {
        struct tri_triangle *at = &mesh->tri[t];
        bool ghost = ghost_corner(at) >= 0;
        for (int k = 0; k < 3; k++)
            at->v[k] = ghost ? TRI_NONE : order[at->v[k]];
    }
    tri_mesh_compact(mesh);
    return TRI_OK;
}

/* A sort of the triangles by their place on the curve. */
struct sorting {
    struct tri_mesh *mesh;
    const int32_t *rank;         /* of a vertex: its place on the curve; NULL: its number */
    int32_t *to;                 /* [n_slots] first the place of each triangle on the curve, then its new slot */
    struct tri_triangle *sorted; /* [n_slots] */
};

/* A triangle's place is that of its shortest edge: there is the work of refinement, however far the rest reaches. */
static void rank_share(void *context, size_t share)
{
    const struct sorting *s = context;
    struct tri_range range = tri_share(share, s->mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++) {
        const int32_t *v = s->mesh->tri[t].v;
        int k = tri_shape_of(s->mesh->xy, v).shortest;
        int32_t a = v[tri_next[k]], b = v[tri_prev[k]];
        a = s->rank ? s->rank[a] : a;
        b = s->rank ? s->rank[b] : b;
        s->to[t] = a < b ? a : b;
    }
}

static void move_share(void *context, size_t share)
{
    const struct sorting *s = context;
    struct tri_range range = tri_share(share, s->mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++) {
        struct tri_triangle *at = &s->sorted[s->to[t]];
        *at = s->mesh->tri[t];
        for (int e = 0; e < 3; e++)
            if (at->n[e] >= 0)
                at->n[e] = tri_code(s->to[tri_of(at->n[e])], tri_edge(at->n[e]));
    }
}

/* Places become slots: a counting sort. start[n_vertices] is zero. */
static void assign_slots(const struct sorting *s, int32_t *start)
{
    for (int32_t t = 0; t < s->mesh->n_slots; t++)
        start[s->to[t]]++;
    for (int32_t v = 0, sum = 0; v < s->mesh->n_vertices; v++) {
        int32_t count = start[v];
        start[v] = sum;
        sum += count;
    }
    for (int32_t t = 0; t < s->mesh->n_slots; t++)
        s->to[t] = start[s->to[t]]++;
}

/* Insertion has left triangles where cavities of all rounds were; every later stage runs faster where neighbours are
 * near in memory. O(n). */
static enum tri_status sort_triangles(struct tri_mesh *mesh, const int32_t *rank, const struct tri_executor *executor,
                                      struct tri_error *error)
{
    size_t n = (size_t)mesh->n_slots;
    int32_t *start = calloc((size_t)mesh->n_vertices + 1, sizeof *start);
    struct sorting s = {mesh, rank, malloc((n + 1) * sizeof *s.to), malloc((n + 1) * sizeof *s.sorted)};
    bool done = start && s.to && s.sorted;
    if (done) {
        tri_execute(executor, tri_shares(mesh->n_slots), rank_share, &s);
        assign_slots(&s, start);
        tri_execute(executor, tri_shares(mesh->n_slots), move_share, &s);
        memcpy(mesh->tri, s.sorted, n * sizeof *s.sorted);
        for (int32_t i = 0; i < mesh->n_subs; i++) {
            int32_t *side = mesh->sub[i].side;
            assert(side[0] != TRI_NONE && side[1] == TRI_NONE); /* hull edges, no others */
            side[0] = tri_code(s.to[tri_of(side[0])], tri_edge(side[0]));
        }
    }
    free(start);
    free(s.to);
    free(s.sorted);
    return done ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d triangles", (int)n);
}

static enum tri_status build_from(struct tri_mesh *mesh, const int32_t *order, int32_t *arranged, int32_t n,
                                  struct tri_error *error)
{
    enum tri_status status = tri_mesh_reserve_triangles(mesh, n < 3 ? 8 : 2 * n, error);
    struct builder b = {.tri = mesh->tri, .last = TRI_NONE, .xy = malloc(((size_t)n + 1) * sizeof *b.xy)};
    if (!status && !b.xy)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    if (!status) {
        arrange_rounds(order, n, arranged);
        for (int32_t i = 0; i < n; i++)
            b.xy[i] = mesh->xy[arranged[i]];
        status = build(&b, arranged, n, mesh->stop, error);
    }
    if (!status)
        status = finish(mesh, &b, arranged, error);
    free(b.xy);
    free(b.cavity);
    free(b.rim);
    free(b.pending);
    return status;
}

/* The vertices along the curve; they are already where the mesh knows their origin. */
static enum tri_status order_vertices(const struct tri_mesh *mesh, int32_t *order, const struct tri_executor *executor,
                                      struct tri_error *error)
{
    int32_t n = mesh->n_vertices;
    for (int32_t v = 0; v < n; v++)
        order[v] = v;
    if (mesh->origin)
        return TRI_OK;
    uint64_t *scratch = malloc((2 * (size_t)n + 1) * sizeof *scratch);
    if (!scratch)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d points", (int)n);
    tri_hilbert_order(mesh->xy, order, n, scratch, executor);
    free(scratch);
    return TRI_OK;
}

static enum tri_status triangulate(struct tri_mesh *mesh, int32_t *order, int32_t *scratch,
                                   const struct tri_executor *executor, struct tri_error *error)
{
    bool in_order = mesh->origin;
    enum tri_status status = order_vertices(mesh, order, executor, error);
    if (status)
        return status;
    int32_t n = drop_duplicates(mesh, order, mesh->n_vertices);
    if (n == mesh->n_vertices) {
        free(mesh->twin);
        mesh->twin = NULL;
    }
    status = build_from(mesh, order, scratch, n, error);
    if (status || mesh->n_slots == 0)
        return status;
    int32_t *rank = in_order ? NULL : scratch;
    for (int32_t i = 0; rank && i < n; i++)
        rank[order[i]] = i;
    return sort_triangles(mesh, rank, executor, error);
}

enum tri_status tri_delaunay(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error)
{
    int32_t n = mesh->n_vertices;
    assert(mesh->n_slots == 0 && mesh->n_subs == 0);
    int32_t *order = malloc(((size_t)n + 1) * sizeof *order), *scratch = malloc(((size_t)n + 1) * sizeof *scratch);
    mesh->twin = malloc(((size_t)n + 1) * sizeof *mesh->twin);
    enum tri_status status = TRI_OK;
    if (!order || !scratch || !mesh->twin) {
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d points", (int)n);
    } else {
        for (int32_t i = 0; i < n; i++)
            mesh->twin[i] = i;
        status = triangulate(mesh, order, scratch, executor, error);
    }
    free(order);
    free(scratch);
    return status;
}
