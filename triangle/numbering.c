/* Ranks of vertices, subsegments and triangles; then all move.
 *
 * THEOREM. Each order is total: new vertices lie at different places; of the triangles that start at a corner each has
 * another second corner, since an edge has one triangle on its left; of the subsegments of a parent, which all run its
 * way, each starts at another vertex. So nothing is left to how the mesh came about.
 *
 * All memory is asked for before anything moves. Items to be sorted take 16 bytes a triangle, and when they are
 * sorted links and regions wait there while corners move into the places of links: there is never a second copy of the
 * mesh. */
#include "triangle/numbering.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/hilbert.h"
#include "triangle/radix.h"

/* What is sorted: a vertex or parent, and the triangle or subsegment that is sorted by it. A triangle tells also which
 * of its corners is the first. */
enum { ID_BITS = 29, FIRST_BITS = 2, KEY_SHIFT = ID_BITS + FIRST_BITS };

_Static_assert(INT64_C(1) << ID_BITS == TRI_MAX_TRIANGLES, "ids fill their bits");

static uint64_t item_of(int32_t key, int first, int32_t id)
{
    return (uint64_t)key << KEY_SHIFT | (uint64_t)first << ID_BITS | (uint64_t)id;
}

static int32_t key_of(uint64_t item) { return (int32_t)(item >> KEY_SHIFT); }
static int first_of(uint64_t item) { return (int)(item >> ID_BITS & 3); }
static int32_t id_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << ID_BITS) - 1)); }

/* What a triangle has beside its corners, on the way to its new slot. */
struct parked {
    int32_t n[3];
    int32_t region;
};

struct numbering {
    struct tri_mesh *mesh;
    const struct tri_executor *executor;
    int32_t n_kept;    /* the vertices that keep their numbers */
    int32_t *order;    /* [n_vertices - n_kept] the new vertices, one after the other */
    int32_t *rank;     /* [n_vertices - n_kept] new number of vertex n_kept + i */
    int32_t n_new;
    int vertex_bits;   /* of the largest number of a vertex, and one more */
    int32_t *sub_rank; /* [n_subs] */
    struct tri_subsegment *sub; /* [n_subs] */
    int32_t *place;    /* [n_slots] first the second corner of a triangle, then where it goes */
    size_t n_items;    /* the larger of n_slots and n_subs */
    void *park;        /* [2 * n_items] items, or [n_items] struct parked */
    int32_t n_tri, n_subs;            /* live ones */
    int32_t fan[TRI_MOST_SHARES + 1]; /* items where the shares begin, so that none cuts a fan in two */
};

static uint64_t *items_of(const struct numbering *n) { return n->park; }

static int bits_of(int32_t number)
{
    int bits = 1;
    while (bits < 31 && number >> bits)
        bits++;
    return bits;
}

/* Sorts items with keys 0 .. limit. */
static void sort_items(const struct numbering *n, int32_t count, int32_t limit)
{
    tri_radix_sort(items_of(n), items_of(n) + n->n_items, count, KEY_SHIFT, KEY_SHIFT + bits_of(limit), n->executor);
}

/* Sorts items with keys below `none`, and with none for what is free, which is last then. Returns how many are not. */
static int32_t sort_live(const struct numbering *n, int32_t count, int32_t none)
{
    sort_items(n, count, none);
    while (count > 0 && key_of(items_of(n)[count - 1]) == none)
        count--;
    return count;
}

/* --- vertices */

static void rank_share(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = tri_share(share, n->n_new);
    for (int32_t i = range.first; i < range.last; i++)
        n->rank[n->order[i] - n->n_kept] = n->n_kept + i;
}

static void rank_vertices(struct numbering *n)
{
    const struct tri_mesh *mesh = n->mesh;
    for (int32_t v = n->n_kept; v < mesh->n_vertices; v++)
        if (mesh->on[v] != TRI_VERTEX_NONE)
            n->order[n->n_new++] = v;
    tri_hilbert_order(mesh->xy, n->order, n->n_new, n->park, n->executor);
    tri_execute(n->executor, tri_shares(n->n_new), rank_share, n);
}

static int32_t renamed(const struct numbering *n, int32_t v)
{
    return v < n->n_kept ? v : n->rank[v - n->n_kept];
}

/* --- subsegments */

static void rename_subs(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (int32_t s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2 && mesh->sub[s].v[k] != TRI_NONE; k++)
            mesh->sub[s].v[k] = renamed(n, mesh->sub[s].v[k]);
}

/* By start, then, since sorting keeps the order of equals, by parent. */
static void rank_subs(struct numbering *n)
{
    const struct tri_mesh *mesh = n->mesh;
    uint64_t *item = items_of(n);
    for (int32_t s = 0; s < mesh->n_subs; s++)
        item[s] = item_of(mesh->sub[s].v[0] == TRI_NONE ? mesh->n_vertices : mesh->sub[s].v[0], 0, s);
    n->n_subs = sort_live(n, mesh->n_subs, mesh->n_vertices);
    for (int32_t i = 0; i < n->n_subs; i++) {
        int32_t parent = mesh->sub[id_of(item[i])].parent;
        assert(parent >= 0 && parent < mesh->n_parents);
        item[i] = item_of(parent, 0, id_of(item[i]));
    }
    sort_items(n, n->n_subs, mesh->n_parents);
    for (int32_t i = 0; i < n->n_subs; i++)
        n->sub_rank[id_of(item[i])] = i;
}

/* --- triangles. A place is the new number, and how far corners turn to bring the first to the front. */

static int32_t place_of(int32_t number, int first) { return number << 2 | first; }

static int32_t new_code(const struct numbering *n, int32_t code)
{
    int32_t place = n->place[tri_of(code)];
    int e = tri_edge(code) - (place & 3);
    return tri_code(place >> 2, e < 0 ? e + 3 : e);
}

static void rename_corners(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = tri_share(share, n->mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++) {
        int32_t *v = n->mesh->tri[t].v;
        if (v[0] == TRI_NONE) {
            items_of(n)[t] = item_of(n->mesh->n_vertices, 0, t);
            continue;
        }
        for (int k = 0; k < 3; k++)
            v[k] = renamed(n, v[k]);
        int first = v[1] > v[0] ? 1 : 0;
        first = v[2] > v[first] ? 2 : first;
        items_of(n)[t] = item_of(v[first], first, t);
        n->place[t] = v[tri_next[first]];
    }
}

/* A fan is the triangles that start at one corner. */
static void find_fans(struct numbering *n)
{
    size_t shares = tri_shares(n->n_tri);
    const uint64_t *item = items_of(n);
    for (size_t share = 0; share <= shares; share++) {
        int32_t at = share < shares ? tri_share(share, n->n_tri).first : n->n_tri;
        while (at > 0 && at < n->n_tri && key_of(item[at]) == key_of(item[at - 1]))
            at++;
        n->fan[share] = at;
    }
}

/* By second corner. */
static void sort_fan(const struct numbering *n, int32_t begin, int32_t end)
{
    uint64_t *item = items_of(n) + begin;
    for (int32_t i = 0; i < end - begin; i++)
        item[i] = item_of(n->place[id_of(item[i])], first_of(item[i]), id_of(item[i]));
    tri_radix_sort(item, item + n->n_items, end - begin, KEY_SHIFT, KEY_SHIFT + n->vertex_bits, NULL);
    for (int32_t i = 1; i < end - begin; i++)
        assert(key_of(item[i - 1]) < key_of(item[i]));
}

static void place_triangles(void *context, size_t share)
{
    const struct numbering *n = context;
    const uint64_t *item = items_of(n);
    for (int32_t begin = n->fan[share], end; begin < n->fan[share + 1]; begin = end) {
        for (end = begin + 1; end < n->fan[share + 1] && key_of(item[end]) == key_of(item[begin]);)
            end++;
        sort_fan(n, begin, end);
        for (int32_t i = begin; i < end; i++)
            n->place[id_of(item[i])] = place_of(i, first_of(item[i]));
    }
}

static void rank_triangles(struct numbering *n)
{
    tri_execute(n->executor, tri_shares(n->mesh->n_slots), rename_corners, n);
    n->n_tri = sort_live(n, n->mesh->n_slots, n->mesh->n_vertices);
    find_fans(n);
    tri_execute(n->executor, tri_shares(n->n_tri), place_triangles, n);
}

/* --- all move */

static void park_share(void *context, size_t share)
{
    const struct numbering *n = context;
    struct parked *park = n->park;
    struct tri_range range = tri_share(share, n->mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++) {
        const struct tri_triangle *from = &n->mesh->tri[t];
        if (!tri_is_live(from))
            continue;
        struct parked *to = &park[n->place[t] >> 2];
        for (int k = 0, old = n->place[t] & 3; k < 3; k++, old = tri_next[old])
            to->n[k] = from->n[old] >= 0 ? new_code(n, from->n[old]) : ~n->sub_rank[~from->n[old]];
        to->region = from->region;
    }
}

/* Where a slot keeps the corners of the triangle that it will hold, until its own triangle's corners have been read:
 * the links there have been parked already. */
static int32_t *waiting_corners(struct tri_triangle *slot) { return slot->n; }

static void move_corners(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = tri_share(share, n->mesh->n_slots);
    for (int32_t t = range.first; t < range.last; t++) {
        const int32_t *from = n->mesh->tri[t].v;
        if (from[0] == TRI_NONE)
            continue;
        int32_t *to = waiting_corners(&n->mesh->tri[n->place[t] >> 2]);
        for (int k = 0, old = n->place[t] & 3; k < 3; k++, old = tri_next[old])
            to[k] = from[old];
    }
}

static void settle_share(void *context, size_t share)
{
    const struct numbering *n = context;
    const struct parked *park = n->park;
    struct tri_range range = tri_share(share, n->n_tri);
    for (int32_t t = range.first; t < range.last; t++) {
        const int32_t *v = waiting_corners(&n->mesh->tri[t]);
        n->mesh->tri[t] = (struct tri_triangle){
            {v[0], v[1], v[2]}, {park[t].n[0], park[t].n[1], park[t].n[2]}, park[t].region, 0};
    }
}

static void move_subs(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (int32_t s = 0; s < mesh->n_subs; s++) {
        if (mesh->sub[s].v[0] == TRI_NONE)
            continue;
        struct tri_subsegment *to = &n->sub[n->sub_rank[s]];
        *to = mesh->sub[s];
        for (int side = 0; side < 2; side++)
            if (to->side[side] != TRI_NONE)
                to->side[side] = new_code(n, to->side[side]);
    }
    if (n->n_subs > 0)
        memcpy(mesh->sub, n->sub, (size_t)n->n_subs * sizeof *n->sub);
}

static enum tri_status allocate(struct numbering *n, struct tri_error *error)
{
    const struct tri_mesh *mesh = n->mesh;
    size_t vertices = (size_t)(mesh->n_vertices - n->n_kept), subs = (size_t)mesh->n_subs;
    n->n_items = (size_t)(mesh->n_slots > mesh->n_subs ? mesh->n_slots : mesh->n_subs);
    size_t for_vertices = vertices * tri_vertex_size(mesh), for_items = n->n_items * sizeof(struct parked);
    n->order = malloc((vertices + 1) * sizeof *n->order);
    n->rank = malloc((vertices + 1) * sizeof *n->rank);
    n->sub_rank = malloc((subs + 1) * sizeof *n->sub_rank);
    n->sub = malloc((subs + 1) * sizeof *n->sub);
    n->place = malloc(((size_t)mesh->n_slots + 1) * sizeof *n->place);
    n->park = malloc((for_vertices > for_items ? for_vertices : for_items) + 1);
    if (n->order && n->rank && n->sub_rank && n->sub && n->place && n->park)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for numbering %d triangles", (int)mesh->n_slots);
}

/* Cannot fail. */
static void renumber(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    rank_vertices(n);
    tri_mesh_gather_vertices(mesh, n->n_kept, n->order, n->n_new, n->park, n->executor);
    free(n->order);
    n->order = NULL;
    rename_subs(n);
    rank_subs(n);
    rank_triangles(n);
    tri_execute(n->executor, tri_shares(mesh->n_slots), park_share, n);
    tri_execute(n->executor, tri_shares(mesh->n_slots), move_corners, n);
    tri_execute(n->executor, tri_shares(n->n_tri), settle_share, n);
    move_subs(n);
    mesh->n_slots = n->n_tri;
    mesh->n_subs = n->n_subs;
    mesh->n_vertices = n->n_kept + n->n_new;
}

enum tri_status tri_number(struct tri_mesh *mesh, int32_t n_kept, const struct tri_executor *executor,
                           struct tri_error *error)
{
    assert(mesh->incidence.n_vertices <= n_kept && n_kept <= mesh->n_vertices);
    struct numbering n = {
        .mesh = mesh, .executor = executor, .n_kept = n_kept, .vertex_bits = bits_of(mesh->n_vertices)};
    enum tri_status status = tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(error) : allocate(&n, error);
    if (!status)
        renumber(&n);
    assert(status || tri_mesh_is_sound(mesh));
    free(n.order);
    free(n.rank);
    free(n.sub_rank);
    free(n.sub);
    free(n.place);
    free(n.park);
    return status;
}
