/* Inserts points (walk, cavity, fan), and sorts the finished triangles (tri_curve_sort). */
#include "triangle/cdt/delaunay.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/base/radix.h"
#include "triangle/geometry/predicates.h"

/* A boundary edge of the cavity: the half-edge of the triangle outside, and the corner at which the edge starts. */
struct tri_inserter_edge {
    tri_halfedge outer;
    tri_vertex_id a;
};

/* An edge that the search has not crossed yet; it starts where the last boundary edge ends. */
struct tri_inserter_pending {
    tri_link link;
    tri_vertex_id end;
};

void tri_inserter_free(struct tri_inserter *b)
{
    free(b->cavity);
    free(b->edge);
    free(b->pending);
}

/* A cavity has two more edges than triangles. */
enum { MORE_EDGES = 2 };

static bool grow(struct tri_inserter *b)
{
    const struct tri_growing arrays[] = {
        {&b->cavity, sizeof *b->cavity}, {&b->edge, sizeof *b->edge}, {&b->pending, sizeof *b->pending}};
    return tri_grow_together(arrays, 3, &b->capacity, b->capacity + 1, MORE_EDGES);
}

static inline bool is_in_stretch(const struct tri_inserter *b, tri_vertex_id v)
{
    return (uint32_t)(v - b->stretch.first) < (uint32_t)(b->stretch.last - b->stretch.first) || v == TRI_GHOST;
}

bool tri_inserter_owns(const struct tri_inserter *b, const struct tri_triangle *t)
{
    return is_in_stretch(b, t->v[0]) && is_in_stretch(b, t->v[1]) && is_in_stretch(b, t->v[2]);
}

/* Ghost e + 1 lies across edge e. Its edge from the end of the hull edge to infinity is shared with the ghost of the
 * hull edge that starts there. */
void tri_insert_first(const struct tri_point *xy, struct tri_triangle *tri, tri_triangle_id triangle,
                      const tri_vertex_id v[3])
{
    bool left = tri_orient2d(xy[v[0]], xy[v[1]], xy[v[2]]) > 0;
    assert(tri_orient2d(xy[v[0]], xy[v[1]], xy[v[2]]) != 0);
    const tri_vertex_id c[] = {v[left ? 0 : 1], v[left ? 1 : 0], v[2]};
    tri[triangle] = (struct tri_triangle){
        {c[0], c[1], c[2]}, {tri_code(triangle + 1, 0), tri_code(triangle + 2, 0), tri_code(triangle + 3, 0)}, 0, 0};
    for (int e = 0; e < 3; e++) {
        int f = tri_next[e], g = tri_prev[e];
        tri[triangle + e + 1] = (struct tri_triangle){
            {TRI_GHOST, c[g], c[f]},
            {tri_code(triangle, e), tri_code(triangle + g + 1, 2), tri_code(triangle + f + 1, 1)}, 0, 0};
    }
}

/* Is q strictly between a and b? The three points are collinear. */
static bool between(struct tri_point a, struct tri_point b, struct tri_point q)
{
    return a.x != b.x ? (a.x < q.x) != (b.x < q.x) && q.x != a.x && q.x != b.x
                      : (a.y < q.y) != (b.y < q.y) && q.y != a.y && q.y != b.y;
}

/* Is q in the disk of the ghost? Its hull edge runs from -> to with the outside on its left. */
static bool in_ghost(const struct tri_inserter *b, const struct tri_triangle *t, int ghost, struct tri_point q)
{
    assert(ghost >= 0 && t->v[tri_next[ghost]] >= 0 && t->v[tri_prev[ghost]] >= 0);
    struct tri_point from = b->xy[t->v[tri_next[ghost]]], to = b->xy[t->v[tri_prev[ghost]]];
    double side = tri_orient2d(from, to, q);
    return side > 0 || (side == 0 && between(from, to, q));
}

static inline bool in_disk(const struct tri_inserter *b, const struct tri_triangle *t, struct tri_point q)
{
    if ((t->v[0] | t->v[1] | t->v[2]) < 0)
        return in_ghost(b, t, tri_ghost_corner(t), q);
    return tri_in_circle(b->xy[t->v[0]], b->xy[t->v[1]], b->xy[t->v[2]], q);
}

/* Locates q by a visibility walk. Returns the triangle that contains q, or a ghost beyond the hull edge through which
 * the walk leaves. Orientations are exact, so the walk cannot cycle in a Delaunay triangulation. A neighbour of an
 * owned triangle is owned if its corner across the common edge is in the stretch. */
static inline tri_triangle_id locate(struct tri_inserter *b, struct tri_point q)
{
    tri_triangle_id t = b->last;
    int from = -1, ghost = tri_ghost_corner(&b->tri[t]);
    assert(tri_inserter_owns(b, &b->tri[t]));
    if (ghost >= 0)
        t = tri_of(b->tri[t].n[ghost]);
    if (ghost >= 0 && !tri_inserter_owns(b, &b->tri[t]))
        return TRI_NONE;
    for (;;) {
        const struct tri_triangle *at = &b->tri[t];
        int k = 0;
        if (from >= 0 && !is_in_stretch(b, at->v[from]))
            return TRI_NONE;
        if ((at->v[0] | at->v[1] | at->v[2]) < 0)
            return t;
        b->last = t;
        for (; k < 3; k++)
            if (k != from && tri_orient2d(b->xy[at->v[tri_next[k]]], b->xy[at->v[tri_prev[k]]], q) < 0)
                break;
        if (k == 3)
            return t;
        t = tri_of(at->n[k]);
        from = tri_edge(at->n[k]);
    }
}

tri_triangle_id tri_inserter_locate(struct tri_inserter *b, struct tri_point q) { return locate(b, q); }

/* Adds the triangles across one edge of the first triangle to the cavity. */
static enum tri_insertion explore(struct tri_inserter *b, struct tri_point q, tri_link link, tri_vertex_id a,
                                  tri_vertex_id end)
{
    int32_t n_pending = 0;
    for (;;) {
        const struct tri_triangle *t = &b->tri[tri_of(link)];
        int e = tri_edge(link);
        assert(link >= 0 && t->v[tri_next[e]] == end && t->v[tri_prev[e]] == a);
        if (in_disk(b, t, q)) {
            if (!is_in_stretch(b, t->v[e]))
                return TRI_NOT_OWNED;
            if (b->n_cavity == b->capacity && !grow(b))
                return TRI_INSERTION_NO_MEMORY;
            b->cavity[b->n_cavity++] = tri_of(link);
            b->pending[n_pending++] = (struct tri_inserter_pending){t->n[tri_prev[e]], end};
            link = t->n[tri_next[e]];
            end = t->v[e];
            continue;
        }
        assert(b->n_edges < b->n_cavity + 2 && n_pending <= b->n_cavity);
        b->edge[b->n_edges++] = (struct tri_inserter_edge){link, a};
        if (n_pending == 0)
            return TRI_INSERTED;
        a = end;
        link = b->pending[--n_pending].link;
        end = b->pending[n_pending].end;
    }
}

/* Replaces the cavity by the fan of v. */
static void fill_cavity(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id fresh)
{
    tri_triangle_id before = TRI_NONE, first = TRI_NONE;
    assert(b->n_edges == b->n_cavity + 2 && b->n_edges >= 3); /* Euler: a disk without a vertex inside */
    for (int32_t i = 0; i < b->n_edges; i++) {
        tri_triangle_id triangle = i < b->n_cavity ? b->cavity[i] : fresh++;
        tri_halfedge outer = b->edge[i].outer;
        tri_vertex_id end = b->edge[i + 1 < b->n_edges ? i + 1 : 0].a;
        struct tri_triangle *t = &b->tri[triangle];
        tri_link link = before == TRI_NONE ? TRI_NONE : tri_code(before, 1);
        *t = (struct tri_triangle){{v, b->edge[i].a, end}, {outer, TRI_NONE, link}, 0, 0};
        assert(tri_inserter_owns(b, t));
        b->tri[tri_of(outer)].n[tri_edge(outer)] = tri_code(triangle, 0);
        if (before != TRI_NONE)
            b->tri[before].n[1] = tri_code(triangle, 2);
        else
            first = triangle;
        before = triangle;
    }
    b->tri[first].n[2] = tri_code(before, 1);
    b->tri[before].n[1] = tri_code(first, 2);
    b->last = first;
}

enum tri_insertion tri_insert(struct tri_inserter *b, tri_vertex_id v, tri_triangle_id triangle)
{
    struct tri_point q = b->xy[v];
    tri_triangle_id t = locate(b, q);
    if (t == TRI_NONE)
        return TRI_NOT_OWNED;
    const struct tri_triangle start = b->tri[t];
    assert(is_in_stretch(b, v) && tri_inserter_owns(b, &start) && in_disk(b, &start, q));
    b->n_cavity = b->n_edges = 0;
    if (b->capacity == 0 && !grow(b))
        return TRI_INSERTION_NO_MEMORY;
    b->cavity[b->n_cavity++] = t;
    for (int e = 0; e < 3; e++) {
        enum tri_insertion found = explore(b, q, start.n[e], start.v[tri_next[e]], start.v[tri_prev[e]]);
        if (found != TRI_INSERTED)
            return found;
    }
    fill_cavity(b, v, triangle);
    return TRI_INSERTED;
}

/* Converts ghosts to subsegments, sorts the triangles and moves them.
 *
 * THEOREM. The order is total: triangles that begin at the same vertex have different second corners, since an edge has
 * one triangle on its left. So the order does not depend on the history of the triangulation. */

/* An item to sort: a vertex as the key, the triangle, and the corner at which the triangle will begin. */
enum { ID_BITS = 29, CORNER_BITS = 2, KEY_SHIFT = ID_BITS + CORNER_BITS, FEW = 24 };

_Static_assert(INT64_C(1) << ID_BITS == TRI_MAX_TRIANGLES, "ids fill their bits");

struct sorting {
    struct tri_mesh *mesh;
    struct tri_triangle *tri; /* [n_triangles] */
    int32_t n_triangles, n_live;
    uint64_t *item, *scratch; /* [n_triangles] each; scratch space is for sorting */
    int32_t group[TRI_MOST_SHARES + 1]; /* first item of each share, chosen so that no group is split */
    int32_t *to;              /* [n_triangles] new place of each triangle: the code of its new first corner */
    int vertex_bits;          /* bits of the largest vertex number plus one */
};

static uint64_t item_of(int32_t key, int corner, tri_triangle_id id)
{
    return (uint64_t)key << KEY_SHIFT | (uint64_t)corner << ID_BITS | (uint64_t)id;
}

static int32_t key_of(uint64_t item) { return (int32_t)(item >> KEY_SHIFT); }
static int corner_of(uint64_t item) { return (int)(item >> ID_BITS & 3); }
static tri_triangle_id id_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << ID_BITS) - 1)); }

/* --- the hull */

/* A ghost is given by the code of its corner at infinity; its hull edge, seen from inside, is start -> end. */
static tri_vertex_id hull_start(const struct tri_triangle *tri, tri_halfedge g)
{
    return tri[tri_of(g)].v[tri_prev[tri_edge(g)]];
}
static tri_vertex_id hull_end(const struct tri_triangle *tri, tri_halfedge g)
{
    return tri[tri_of(g)].v[tri_next[tri_edge(g)]];
}

/* Returns the next ghost along the hull. */
static tri_halfedge next_ghost(const struct tri_triangle *tri, tri_halfedge g)
{
    tri_link link = tri[tri_of(g)].n[tri_prev[tri_edge(g)]];
    return tri_code(tri_of(link), tri_prev[tri_edge(link)]);
}

static tri_halfedge any_ghost(const struct tri_triangle *tri)
{
    tri_triangle_id t = 0;
    while (tri[t].v[0] == TRI_NONE || tri_ghost_corner(&tri[t]) < 0)
        t++;
    return tri_code(t, tri_ghost_corner(&tri[t]));
}

static tri_halfedge lowest_ghost(const struct tri_triangle *tri, int32_t *count)
{
    int32_t end = any_ghost(tri), g = end, lowest = end;
    *count = 0;
    do {
        lowest = hull_start(tri, g) < hull_start(tri, lowest) ? g : lowest;
        g = next_ghost(tri, g);
        ++*count;
    } while (g != end);
    return lowest;
}

/* Makes the hull edges subsegments and frees the ghosts. */
static enum tri_status convert_hull(struct tri_mesh *mesh, struct tri_triangle *tri, struct tri_error *error)
{
    int32_t count, g = lowest_ghost(tri, &count);
    enum tri_status status = tri_mesh_reserve_subs(mesh, count, error);
    for (int32_t i = 0; !status && i < count; i++) {
        int32_t inner = tri[tri_of(g)].n[tri_edge(g)], next = next_ghost(tri, g);
        tri_sub_id s = tri_mesh_add_sub(mesh, hull_start(tri, g), hull_end(tri, g), 0, TRI_NONE);
        mesh->sub[s].side[0] = inner;
        tri[tri_of(inner)].n[tri_edge(inner)] = ~s;
        tri[tri_of(g)].v[0] = TRI_NONE;
        g = next;
    }
    return status;
}

/* --- the order */

/* Returns the corner at which the triangle will begin: the lower end of its shortest edge; of several such corners, the
 * one with the lowest number. An edge has the same computed length in both directions, since differences round
 * symmetrically. Avoids branches, which would be unpredictable. */
static int first_corner(const struct tri_point *xy, const tri_vertex_id v[3])
{
    double length2[3];
    int low[3], best = 0;
    for (int e = 0; e < 3; e++) {
        int a = tri_next[e], b = tri_prev[e];
        double x = xy[v[a]].x - xy[v[b]].x, y = xy[v[a]].y - xy[v[b]].y;
        length2[e] = x * x + y * y;
        low[e] = v[a] < v[b] ? a : b;
    }
    for (int e = 1; e < 3; e++) {
        bool tie = (length2[e] == length2[best]) & (v[low[e]] < v[low[best]]);
        best = ((length2[e] < length2[best]) | tie) ? e : best;
    }
    return low[best];
}

static void list_share(void *context, size_t share)
{
    const struct sorting *s = context;
    struct tri_range range = tri_share(share, s->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        const tri_vertex_id *v = s->tri[t].v;
        if (v[0] == TRI_NONE) {
            s->item[t] = item_of(s->mesh->n_vertices, 0, t);
            continue;
        }
        int first = first_corner(s->mesh->xy, v);
        s->item[t] = item_of(v[first], first, t);
    }
}

/* Computes s->group. A group is the triangles that begin at one vertex. */
static void find_groups(struct sorting *s)
{
    size_t shares = tri_shares(s->n_live);
    for (size_t share = 0; share <= shares; share++) {
        int32_t at = share < shares ? tri_share(share, s->n_live).first : s->n_live;
        while (at > 0 && at < s->n_live && key_of(s->item[at]) == key_of(s->item[at - 1]))
            at++;
        s->group[share] = at;
    }
}

/* Sorts a group by the second corner. */
static void sort_group(const struct sorting *s, uint64_t *item, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        uint64_t next = item_of(s->tri[id_of(item[i])].v[tri_next[corner_of(item[i])]], corner_of(item[i]),
                                id_of(item[i]));
        int32_t at = i;
        for (; n <= FEW && at > 0 && item[at - 1] > next; at--)
            item[at] = item[at - 1];
        item[at] = next;
    }
    if (n > FEW)
        tri_radix_sort(item, s->scratch + (item - s->item), n, KEY_SHIFT, KEY_SHIFT + s->vertex_bits, NULL);
    for (int32_t i = 1; i < n; i++)
        assert(key_of(item[i - 1]) < key_of(item[i]));
}

static void sort_groups_share(void *context, size_t share)
{
    const struct sorting *s = context;
    for (int32_t begin = s->group[share], end; begin < s->group[share + 1]; begin = end) {
        for (end = begin + 1; end < s->group[share + 1] && key_of(s->item[end]) == key_of(s->item[begin]);)
            end++;
        if (end - begin > 1)
            sort_group(s, s->item + begin, end - begin);
        for (int32_t i = begin; i < end; i++)
            s->to[id_of(s->item[i])] = tri_code(i, corner_of(s->item[i]));
    }
}

static void find_order(struct sorting *s, const struct tri_executor *executor)
{
    tri_execute(executor, tri_shares(s->n_triangles), list_share, s);
    tri_radix_sort(s->item, s->scratch, s->n_triangles, KEY_SHIFT, KEY_SHIFT + s->vertex_bits, executor);
    assert(key_of(s->item[s->n_live - 1]) < s->mesh->n_vertices);
    assert(s->n_live == s->n_triangles || key_of(s->item[s->n_live]) == s->mesh->n_vertices);
    find_groups(s);
    tri_execute(executor, tri_shares(s->n_live), sort_groups_share, s);
}

/* --- moving the triangles */

static tri_halfedge new_code(const struct sorting *s, tri_halfedge code)
{
    int32_t to = s->to[tri_of(code)];
    int e = tri_edge(code) - tri_edge(to);
    return tri_code(tri_of(to), e < 0 ? e + 3 : e);
}

static void move_share(void *context, size_t share)
{
    const struct sorting *s = context;
    struct tri_range range = tri_share(share, s->n_triangles);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        const struct tri_triangle *from = &s->tri[t];
        if (!tri_is_live(from))
            continue;
        struct tri_triangle *at = &s->mesh->tri[tri_of(s->to[t])];
        for (int k = 0, old = tri_edge(s->to[t]); k < 3; k++, old = tri_next[old]) {
            at->v[k] = from->v[old];
            at->n[k] = from->n[old] >= 0 ? new_code(s, from->n[old]) : from->n[old];
        }
        at->region = 0;
        at->generation = 0;
    }
}

static void move_all(const struct sorting *s, const struct tri_executor *executor)
{
    struct tri_mesh *mesh = s->mesh;
    tri_execute(executor, tri_shares(s->n_triangles), move_share, (void *)s);
    for (int32_t i = 0; i < mesh->n_subs; i++)
        mesh->sub[i].side[0] = new_code(s, mesh->sub[i].side[0]);
    mesh->n_triangles = s->n_live;
}

/* Sorts and moves the triangles. The items are stored in the memory of the mesh's new triangles. */
static enum tri_status sort(struct sorting *s, const struct tri_executor *executor, struct tri_error *error)
{
    _Static_assert(sizeof *s->tri == 4 * sizeof *s->item, "room for two lists of items in half as many triangles");
    int32_t room = s->n_triangles / 2 + 1;
    enum tri_status status = tri_mesh_reserve_triangles(s->mesh, s->n_live > room ? s->n_live : room, error);
    s->to = malloc((size_t)s->n_triangles * sizeof *s->to);
    if (!status && !s->to)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for sorting %d triangles", (int)s->n_triangles);
    if (!status) {
        s->item = (uint64_t *)(void *)s->mesh->tri;
        s->scratch = s->item + s->n_triangles;
        find_order(s, executor);
        move_all(s, executor);
    }
    free(s->to);
    return status;
}

enum tri_status tri_curve_sort(struct tri_mesh *mesh, struct tri_triangle *tri, int32_t n_triangles,
                               int32_t n_live, const struct tri_executor *executor, struct tri_error *error)
{
    struct sorting s = {.mesh = mesh, .tri = tri, .n_triangles = n_triangles, .n_live = n_live,
                        .vertex_bits = tri_bits_of(mesh->n_vertices)};
    enum tri_status status = convert_hull(mesh, tri, error);
    s.n_live -= mesh->n_subs; /* ghosts are not live any more */
    return status ? status : sort(&s, executor, error);
}
