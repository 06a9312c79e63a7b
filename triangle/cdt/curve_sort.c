/* Ghosts become subsegments; triangles are sorted and move.
 *
 * THEOREM. The order is total: of the triangles that begin at a vertex each has another second corner, since an edge
 * has one triangle on its left. So nothing is left to how the triangulation came about. */
#include "triangle/cdt/curve_sort.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/radix.h"
#include "triangle/cdt/insertion.h"

/* What is sorted: a vertex, and the triangle that is sorted by it, with the corner at which that begins. */
enum { ID_BITS = 29, CORNER_BITS = 2, KEY_SHIFT = ID_BITS + CORNER_BITS, FEW = 24 };

_Static_assert(INT64_C(1) << ID_BITS == TRI_MAX_TRIANGLES, "ids fill their bits");

struct sorting {
    struct tri_mesh *mesh;
    struct tri_triangle *tri; /* [n_triangles] */
    int32_t n_triangles, n_live;
    uint64_t *item, *scratch; /* [n_triangles] each */
    int32_t group[TRI_MOST_SHARES + 1]; /* items where shares begin, so that none cuts a group in two */
    int32_t *to;              /* [n_triangles] where a triangle goes: the code of what will be its first corner */
    int vertex_bits;          /* of the largest number of a vertex, and one more */
};

static uint64_t item_of(int32_t key, int corner, tri_triangle_id id)
{
    return (uint64_t)key << KEY_SHIFT | (uint64_t)corner << ID_BITS | (uint64_t)id;
}

static int32_t key_of(uint64_t item) { return (int32_t)(item >> KEY_SHIFT); }
static int corner_of(uint64_t item) { return (int)(item >> ID_BITS & 3); }
static tri_triangle_id id_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << ID_BITS) - 1)); }

/* --- the hull */

/* A ghost by the code of its corner at infinity; its hull edge, seen from inside, is start -> end. */
static tri_vertex_id hull_start(const struct tri_triangle *tri, tri_halfedge g)
{
    return tri[tri_of(g)].v[tri_prev[tri_edge(g)]];
}
static tri_vertex_id hull_end(const struct tri_triangle *tri, tri_halfedge g)
{
    return tri[tri_of(g)].v[tri_next[tri_edge(g)]];
}

/* The ghost across the edge from the end to infinity. */
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

/* Leaves no ghost. */
static enum tri_status take_hull(struct tri_mesh *mesh, struct tri_triangle *tri, struct tri_error *error)
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

/* The corner that is the lower end of the shortest edge, of several the lowest. Lengths are the same whatever corner
 * comes first, since differences are rounded alike in both directions. Without branches: they would be as good as
 * random. */
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

/* A group is the triangles that begin at one vertex. */
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

/* By the second corner. */
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

static void place_share(void *context, size_t share)
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
    tri_execute(executor, tri_shares(s->n_live), place_share, s);
}

/* --- all move */

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
        at->life = 0;
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

/* Items wait where triangles will be. */
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
    enum tri_status status = take_hull(mesh, tri, error);
    s.n_live -= mesh->n_subs; /* ghosts */
    return status ? status : sort(&s, executor, error);
}
