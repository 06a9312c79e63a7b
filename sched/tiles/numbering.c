/* Computes the new numbers of vertices, subsegments and triangles, then moves them to their new places.
 *
 * THEOREM. Each order is total, so the result does not depend on the old numbers. New vertices have different
 * coordinates. Triangles that start at the same corner have different second corners, since an edge has one triangle on
 * its left. Subsegments of one parent all run in its direction, and start at different vertices.
 *
 * All memory is allocated before anything moves. The first access to a page costs as much as sorting its contents.
 * Memory is therefore reused: arrays are shared by several steps, and each worker uses one buffer for all its tiles. */
#include "sched/tiles/numbering.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/deal.h"
#include "sched/tunables.h"
#include "triangle/base/radix.h"
#include "triangle/geometry/hilbert.h"

/* A turned triangle has 31 bits: its number (old or new), and the index of the corner at which it will start. An item
 * for sorting has a value in its lower 31 bits, and above it the key by which it is sorted. A tile is identified by its
 * index in the order of tiles. */

enum { CORNER_BITS = 2, VALUE_BITS = 31 };

_Static_assert(INT64_C(1) << VALUE_BITS == (int64_t)TRI_MAX_TRIANGLES << CORNER_BITS, "turned triangles fill the bits");

static inline uint64_t item_of(int32_t key, int32_t value) { return (uint64_t)key << VALUE_BITS | (uint64_t)value; }
static inline int32_t key_of(uint64_t item) { return (int32_t)(item >> VALUE_BITS); }
static inline int32_t value_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << VALUE_BITS) - 1)); }

static inline int32_t turn(int32_t number, int corner) { return number << CORNER_BITS | corner; }
static inline int32_t number_in(int32_t turned) { return turned >> CORNER_BITS; }
static inline int corner_in(int32_t turned) { return turned & 3; }

struct par_numbered_subs {
    int32_t n;                   /* number of subsegments that are not free */
    int32_t *number;             /* [mesh->n_subs] the new number of each subsegment */
    struct tri_subsegment *item; /* [mesh->n_subs] the subsegments in their new order, before they are copied back */
};

struct par_numbering {
    struct tri_mesh *mesh;                 /* the mesh to be numbered */
    const struct par_partition *partition; /* its tiles give the order */
    const struct tri_executor *executor;   /* runs shares and tiles; NULL: they run one after the other */
    int32_t n_kept;     /* number of vertices that keep their numbers */
    int32_t *kept_tile; /* [n_kept] the tile of each kept vertex */
    struct par_deal vertices, triangles; /* assign the new vertices and all triangles to tiles */
    struct par_numbered_subs subs;         /* the subsegments of the mesh */
    /* Arrays that share memory: each step overwrites the array of the step before. */
    union {
        int32_t *order;   /* [n_vertices - n_kept] the new vertices in their new order */
        int32_t *fan_end; /* [n_vertices - n_kept] end of the fan of triangles that start at each new vertex */
        struct tri_triangle *buffer; /* [move_batch_size] triangles of the batch that moves */
    };
    union {
        int32_t *tile_of; /* [n_vertices] tile of each new vertex; TRI_NONE: the id is free */
        int32_t *number;  /* [n_vertices] new number of each vertex */
    };
    union {
        int32_t *key;     /* [n_triangles] sort key of each triangle (see FREE_KEY) */
        int32_t *place;   /* [n_triangles] new number of each triangle, turned; TRI_NONE: the id is free */
    };
    int32_t *dealt;      /* [n_triangles] old numbers of triangles, turned: by tile, at the end in their new order */
    void *scratch;       /* items to be sorted, then vertices that move, then triangles that are set aside */
};

/* Returns the tile of the vertex with this new number. */
static inline int32_t tile_of_number(const struct par_numbering *n, int32_t number)
{
    if (number < n->n_kept)
        return n->kept_tile[number];
    return par_holder_of(n->vertices.start, n->vertices.n_tiles, number - n->n_kept);
}

/* Converts the code of a half-edge to the new numbers of triangles. */
static inline tri_halfedge new_code(const int32_t *place_of_triangle, tri_halfedge code)
{
    static const uint8_t edge_of[4][4] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    int32_t place = place_of_triangle[tri_of(code)];
    return tri_code(number_in(place), edge_of[corner_in(place)][tri_edge(code)]);
}

/* --- vertices */

static int32_t find_tile(struct par_locator *last, const struct par_partition *p, struct tri_point q)
{
    return par_tile_of_block(p, par_locate(last, p, 0, q));
}

static void count_vertices(void *context, size_t share)
{
    const struct par_numbering *n = context;
    const struct tri_mesh *mesh = n->mesh;
    struct tri_range range = par_deal_share(&n->vertices, share);
    int32_t *count = par_deal_at(&n->vertices, share);
    struct par_locator finder = PAR_LOST;
    for (int32_t i = range.first; i < range.last; i++) {
        tri_vertex_id v = n->n_kept + i;
        n->tile_of[v] = TRI_NONE;
        if (mesh->on[v] != TRI_VERTEX_NONE)
            count[n->tile_of[v] = find_tile(&finder, n->partition, mesh->xy[v])]++;
    }
}

static void deal_vertices(void *context, size_t share)
{
    const struct par_numbering *n = context;
    struct tri_range range = par_deal_share(&n->vertices, share);
    int32_t *at = par_deal_at(&n->vertices, share);
    for (tri_vertex_id v = n->n_kept + range.first; v < n->n_kept + range.last; v++)
        if (n->tile_of[v] != TRI_NONE)
            n->order[at[n->tile_of[v]]++] = v;
}

static void number_tile(const void *context, size_t tile, uint64_t *room)
{
    const struct par_numbering *n = context;
    int32_t first = n->vertices.start[tile], end = n->vertices.start[tile + 1];
    tri_hilbert_order_coarse(n->mesh->xy, n->order + first, end - first, room);
    for (int32_t i = first; i < end; i++)
        n->number[n->order[i]] = n->n_kept + i;
}

static void find_kept(void *context, size_t share)
{
    const struct par_numbering *n = context;
    struct tri_range range = tri_share(share, n->n_kept);
    struct par_locator finder = PAR_LOST;
    for (tri_vertex_id v = range.first; v < range.last; v++) {
        n->number[v] = v;
        n->kept_tile[v] = find_tile(&finder, n->partition, n->mesh->xy[v]);
    }
}

/* Returns the number of new vertices. */
static int32_t number_vertices(struct par_numbering *n)
{
    tri_execute(n->executor, tri_shares(n->n_kept), find_kept, n);
    tri_execute(n->executor, n->vertices.shares, count_vertices, n);
    const int32_t n_new = par_deal_add_up(&n->vertices);
    tri_execute(n->executor, n->vertices.shares, deal_vertices, n);
    par_deal_work(&n->vertices, n->executor, n->scratch, number_tile, n);
    return n_new;
}

/* --- subsegments */

static void rename_subs(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2 && mesh->sub[s].v[k] != TRI_NONE; k++)
            mesh->sub[s].v[k] = n->number[mesh->sub[s].v[k]];
}

static void sort_subs(const struct par_numbering *n, int32_t limit)
{
    uint64_t *item = n->scratch;
    tri_radix_sort(item, item + n->mesh->n_subs, n->subs.n, VALUE_BITS, VALUE_BITS + tri_bits_of(limit), n->executor);
}

static int32_t tile_of_sub(const struct par_numbering *n, const struct tri_subsegment *s)
{
    int32_t a = tile_of_number(n, s->v[0]), b = tile_of_number(n, s->v[1]);
    return a > b ? a : b;
}

/* Sorts by start vertex, then by parent, then by tile. The sort is stable, so the last key takes precedence. */
static void number_subs(struct par_numbering *n)
{
    const struct tri_mesh *mesh = n->mesh;
    uint64_t *item = n->scratch;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->sub[s].v[0] != TRI_NONE)
            item[n->subs.n++] = item_of(mesh->sub[s].v[0], s);
    sort_subs(n, mesh->n_vertices);
    for (int32_t i = 0; i < n->subs.n; i++) {
        tri_parent_id parent = mesh->sub[value_of(item[i])].parent;
        assert(parent >= 0 && parent < mesh->n_parents);
        item[i] = item_of(parent, value_of(item[i]));
    }
    sort_subs(n, mesh->n_parents);
    for (int32_t i = 0; i < n->subs.n; i++)
        item[i] = item_of(tile_of_sub(n, &mesh->sub[value_of(item[i])]), value_of(item[i]));
    sort_subs(n, n->vertices.n_tiles);
    for (int32_t i = 0; i < n->subs.n; i++)
        n->subs.number[value_of(item[i])] = i;
}

static void move_subs(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        if (mesh->sub[s].v[0] == TRI_NONE)
            continue;
        struct tri_subsegment *to = &n->subs.item[n->subs.number[s]];
        *to = mesh->sub[s];
        for (int side = 0; side < 2; side++)
            if (to->side[side] != TRI_NONE)
                to->side[side] = new_code(n->place, to->side[side]);
    }
    if (n->subs.n > 0)
        memcpy(mesh->sub, n->subs.item, (size_t)n->subs.n * sizeof *n->subs.item);
}

/* --- The new order of triangles: by tile, then by the new numbers of their corners. The key of a triangle is the
 * largest new number among its corners, with the index of that corner. STRAY_KEY is added if the tile of the triangle
 * is not the tile of that corner. One counting sort assigns triangles to tiles. Each tile is then sorted as a task of
 * its own, and fits the cache. */

enum { FREE_KEY = TRI_NONE, STRAY_KEY = 1 << 30 };

_Static_assert((int64_t)TRI_MAX_VERTICES << CORNER_BITS <= STRAY_KEY, "a key has a bit left");

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t most(uint64_t a, uint64_t b) { return a < b ? b : a; }

/* Parts of `scratch` while triangles are sorted: the new number of the second corner of each triangle, followed by the
 * items of the tiles that are being sorted. */
static int32_t *second_of(const struct par_numbering *n) { return n->scratch; }
static uint64_t *items_of(const struct par_numbering *n)
{
    return (uint64_t *)n->scratch + n->mesh->n_triangles / 2 + 1;
}

/* Returns the last tile of three corners, which are given by their new numbers. */
static int32_t tile_of_triangle(const struct par_numbering *n, const tri_vertex_id v[3])
{
    int32_t last = 0;
    for (int k = 0; k < 3; k++) {
        int32_t tile = tile_of_number(n, v[k]);
        last = tile > last ? tile : last;
    }
    return last;
}

static int32_t tile_of_key(const struct par_numbering *n, tri_triangle_id t)
{
    int32_t v[3];
    if (!(n->key[t] & STRAY_KEY))
        return tile_of_number(n, number_in(n->key[t]));
    for (int k = 0; k < 3; k++)
        v[k] = n->number[n->mesh->tri[t].v[k]];
    return tile_of_triangle(n, v);
}

/* The new vertices of the last tile that was looked up. The next triangle mostly belongs to the same tile. */
struct tile_range {
    int32_t tile, first, count; /* the tile, its first vertex number, and the number of its vertices; all 0: none yet */
};

static bool is_within(const struct tile_range *range, int32_t number)
{
    return (uint32_t)(number - range->first) < (uint32_t)range->count; /* a number with STRAY_KEY is in no range */
}

/* Returns the tile of a triangle. *last: caches the tile of the previous triangle, if that was not stray. */
static inline int32_t tile_after(const struct par_numbering *n, struct tile_range *last, tri_triangle_id t)
{
    int32_t key = n->key[t];
    if (!is_within(last, number_in(key))) {
        int32_t tile = tile_of_key(n, t);
        if ((key & STRAY_KEY) || number_in(key) < n->n_kept)
            return tile;
        const int32_t *start = n->vertices.start;
        *last = (struct tile_range){tile, n->n_kept + start[tile], start[tile + 1] - start[tile]};
    }
    return last->tile;
}

/* Returns whether a triangle belongs to a later tile than its first corner, which has this number. Only a kept
 * vertex can be in a later tile, because new vertices with smaller numbers are in the same or an earlier one. */
static bool is_stray(const struct par_numbering *n, const struct tile_range *last, const tri_vertex_id v[3],
                     int32_t number)
{
    int32_t tile = is_within(last, number) ? last->tile : tile_of_number(n, number);
    bool stray = false;
    for (int k = 0; k < 3; k++)
        stray |= v[k] < n->n_kept && n->kept_tile[v[k]] > tile;
    return stray;
}

static inline int32_t greater(int32_t a, int32_t b) { return a < b ? b : a; }
static inline int32_t lesser(int32_t a, int32_t b) { return a < b ? a : b; }

/* Computes the key of a triangle. Finds the largest number without a branch, which could not be predicted. */
static inline void key_triangle(const struct par_numbering *n, const struct tile_range *last, const int32_t *old,
                                tri_triangle_id t)
{
    const int32_t *number = n->number;
    const int32_t v[3] = {number[old[0]], number[old[1]], number[old[2]]};
    int32_t key = greater(greater(turn(v[0], 0), turn(v[1], 1)), turn(v[2], 2));
    second_of(n)[t] = number[old[tri_next[corner_in(key)]]];
    if (lesser(lesser(v[0], v[1]), v[2]) < n->n_kept && is_stray(n, last, v, number_in(key)))
        key |= STRAY_KEY;
    n->key[t] = key;
}

static void key_share(void *context, size_t share)
{
    const struct par_numbering *n = context;
    const struct tri_triangle *tri = n->mesh->tri;
    struct tri_range range = par_deal_share(&n->triangles, share);
    struct tile_range last = {0};
    int32_t *count = par_deal_at(&n->triangles, share);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (!tri_is_live(&tri[t])) {
            n->key[t] = FREE_KEY;
            continue;
        }
        key_triangle(n, &last, tri[t].v, t);
        count[tile_after(n, &last, t)]++;
    }
}

static void deal_triangles(void *context, size_t share)
{
    const struct par_numbering *n = context;
    struct tri_range range = par_deal_share(&n->triangles, share);
    struct tile_range last = {0};
    int32_t *at = par_deal_at(&n->triangles, share);
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (n->key[t] == FREE_KEY)
            continue;
        n->dealt[at[tile_after(n, &last, t)]++] = turn(t, corner_in(n->key[t]));
        n->key[t] &= ~STRAY_KEY;
    }
}

/* Sorts items of one tile by key. */
static void sort_items(uint64_t *item, uint64_t *scratch, int32_t count)
{
    int32_t low = INT32_MAX, high = 0;
    for (int32_t i = 0; i < count; i++) {
        low = key_of(item[i]) < low ? key_of(item[i]) : low;
        high = key_of(item[i]) > high ? key_of(item[i]) : high;
    }
    for (int32_t i = 0; i < count; i++)
        item[i] -= (uint64_t)low << VALUE_BITS;
    tri_radix_sort(item, scratch, count, VALUE_BITS, VALUE_BITS + tri_bits_of(high - low), NULL);
}

static void insert_items(uint64_t *item, int32_t count)
{
    for (int32_t i = 1; i < count; i++) {
        uint64_t moving = item[i];
        int32_t at = i;
        for (; at > 0 && item[at - 1] > moving; at--)
            item[at] = item[at - 1];
        item[at] = moving;
    }
}

static uint64_t by_second(const struct par_numbering *n, int32_t turned)
{
    return item_of(second_of(n)[number_in(turned)], turned);
}

/* A tile whose triangles are being sorted. Most of them start at a new vertex of the tile, and are assigned to the fan
 * of this vertex by counting. The others come first. */
struct sorting {
    const struct par_numbering *n; /* the numbering of the mesh */
    int32_t *turned;            /* [count] triangles of the tile, at the end in their new order */
    uint64_t *item, *spare;     /* [count] the triangles as items; scratch memory for sorting */
    int32_t first, count;       /* new number of the first triangle of the tile; number of its triangles */
    int32_t first_own, n_own;   /* number of the first new vertex of the tile; number of these vertices */
    int32_t *end;               /* [n_own] index in `item` of the end of each fan; of its start until it is filled */
    int32_t n_others;           /* triangles that start at a vertex of an earlier tile or at a kept vertex */
};

/* Returns the new number of the first corner. */
static int32_t first_number(const struct sorting *s, int32_t turned)
{
    return number_in(s->n->key[number_in(turned)]);
}

static bool is_own(const struct sorting *s, int32_t number)
{
    return (uint32_t)(number - s->first_own) < (uint32_t)s->n_own;
}

static void count_fans(struct sorting *s)
{
    memset(s->end, 0, (size_t)s->n_own * sizeof *s->end);
    for (int32_t i = 0; i < s->count; i++) {
        int32_t number = first_number(s, s->turned[i]);
        if (is_own(s, number))
            s->end[number - s->first_own]++;
        else
            s->n_others++;
    }
    for (int32_t i = 0, sum = s->n_others; i < s->n_own; i++) {
        int32_t count = s->end[i];
        s->end[i] = sum; /* start of the fan; fill_fans advances it to the end */
        sum += count;
    }
}

static void fill_fans(struct sorting *s)
{
    int32_t other = 0;
    for (int32_t i = 0; i < s->count; i++) {
        int32_t turned = s->turned[i], number = first_number(s, turned);
        if (is_own(s, number))
            s->item[s->end[number - s->first_own]++] = by_second(s->n, turned);
        else
            s->item[other++] = item_of(number, turned);
    }
}

static void take_values(struct sorting *s, int32_t begin, int32_t end)
{
    for (int32_t i = begin; i < end; i++)
        s->turned[i] = value_of(s->item[i]);
}

/* Sorts triangles that start at the same corner by their second corner. */
static void sort_fan(struct sorting *s, int32_t begin, int32_t end)
{
    if (end - begin <= PAR_FEW_IN_FAN)
        insert_items(s->item + begin, end - begin);
    else
        sort_items(s->item + begin, s->spare, end - begin);
    take_values(s, begin, end);
}

static void sort_others(struct sorting *s)
{
    uint64_t *item = s->item;
    if (s->n_others > 0)
        sort_items(item, s->spare, s->n_others);
    for (int32_t begin = 0, end; begin < s->n_others; begin = end) {
        int32_t number = key_of(item[begin]);
        for (end = begin; end < s->n_others && key_of(item[end]) == number; end++)
            item[end] = by_second(s->n, value_of(item[end]));
        sort_fan(s, begin, end);
    }
}

/* Sorts up to four items without a branch on their values, and always writes four. Missing items come last. */
static void sort_four(const uint64_t *item, int32_t count, int32_t *to)
{
    uint64_t a = item[0] | -(uint64_t)(count < 1), b = item[1] | -(uint64_t)(count < 2);
    uint64_t c = item[2] | -(uint64_t)(count < 3), d = item[3] | -(uint64_t)(count < 4);
    uint64_t low = least(a, b), high = most(a, b), low_too = least(c, d), high_too = most(c, d);
    uint64_t second = most(low, low_too), third = least(high, high_too);
    to[0] = value_of(least(low, low_too));
    to[1] = value_of(least(second, third));
    to[2] = value_of(most(second, third));
    to[3] = value_of(most(high, high_too));
}

/* Sorts all fans. sort_four writes four values even if the fan is smaller. The next fan overwrites the surplus. */
static void sort_fans(struct sorting *s)
{
    for (int32_t i = 0, begin = s->n_others; i < s->n_own; begin = s->end[i++]) {
        int32_t count = s->end[i] - begin;
        if (count <= 4 && begin + 4 <= s->count)
            sort_four(s->item + begin, count, s->turned + begin);
        else
            sort_fan(s, begin, s->end[i]);
    }
}

/* Sorts the triangles of one tile and stores their new places. Called on any thread. */
static void place_tile(const void *context, size_t tile, uint64_t *room)
{
    const struct par_numbering *n = context;
    int32_t first = n->triangles.start[tile], own = n->vertices.start[tile], down = 0;
    struct sorting s = {.n = n, .turned = n->dealt + first, .item = room, .first = first,
                        .count = n->triangles.start[tile + 1] - first, .first_own = n->n_kept + own,
                        .n_own = n->vertices.start[tile + 1] - own, .end = n->fan_end + own};
    s.spare = room + s.count;
    count_fans(&s);
    fill_fans(&s);
    sort_others(&s);
    sort_fans(&s);
    for (int32_t i = 0; i < s.count; i++) {
        tri_triangle_id t = number_in(s.turned[i]);
        n->place[t] = turn(first + i, corner_in(s.turned[i]));
        down += first + i < t;
    }
    n->triangles.at[tile] = down; /* triangles of the tile that move to smaller numbers */
}

/* Returns the number of triangles. */
static int32_t sort_triangles(struct par_numbering *n)
{
    tri_execute(n->executor, n->triangles.shares, key_share, n);
    const int32_t n_tri = par_deal_add_up(&n->triangles);
    tri_execute(n->executor, n->triangles.shares, deal_triangles, n);
    par_deal_work(&n->triangles, n->executor, items_of(n), place_tile, n);
    return n_tri;
}

static size_t sort_scratch(const struct tri_mesh *mesh)
{
    const size_t two_items = 2 * sizeof(uint64_t);
    return (size_t)mesh->n_triangles * (sizeof(int32_t) + two_items) + two_items;
}

/* --- Triangles move in place, in batches of new places, usually from the last batch to the first. The triangles of a
 * batch are gathered in a buffer. Triangles of later batches that still occupy these places are set aside. Then the
 * buffer is copied to its places. Only triangles that move down are set aside. If more triangles move down than up,
 * batches run from first to last, and only triangles that move up are set aside. This is at most half of them. */

enum { BATCH_SHARES = 32 };

struct move {
    const struct par_numbering *n; /* the numbering of the mesh */
    struct tri_range batch;  /* new places of this batch */
    bool down;               /* batches run from last to first: places below this batch have not been filled yet */
    int32_t n_aside;        /* triangles set aside so far */
    int32_t aside[BATCH_SHARES]; /* triangles that each share sets aside, then the index of the first of them */
};

static struct tri_range batch_share(const struct move *m, size_t share)
{
    struct tri_range range = tri_share_of(share, BATCH_SHARES, m->batch.last - m->batch.first);
    return (struct tri_range){m->batch.first + range.first, m->batch.first + range.last};
}

/* A flag of an item of `dealt`: the triangle was set aside, and the number is its index among those set aside. */
static const int32_t ASIDE = INT32_MIN;

static struct tri_triangle *aside_of(const struct par_numbering *n) { return n->scratch; }

static inline const struct tri_triangle *source_of(const struct par_numbering *n, int32_t turned)
{
    return (turned < 0 ? aside_of(n) : n->mesh->tri) + number_in(turned & ~ASIDE);
}

static inline tri_link new_link(const int32_t *place, const int32_t *sub_number, tri_link link)
{
    return link >= 0 ? new_code(place, link) : ~sub_number[~link];
}

static inline struct tri_triangle renamed(const struct par_numbering *n, const struct tri_triangle *t, int first)
{
    const int32_t *number = n->number, *place = n->place, *sub_number = n->subs.number;
    int second = tri_next[first], third = tri_prev[first];
    return (struct tri_triangle){{number[t->v[first]], number[t->v[second]], number[t->v[third]]},
                                 {new_link(place, sub_number, t->n[first]), new_link(place, sub_number, t->n[second]),
                                  new_link(place, sub_number, t->n[third])},
                                 t->region,
                                 0};
}

/* Returns whether triangle t, which occupies a place of this batch, moves in a later batch. */
static bool stands_here(const struct move *m, tri_triangle_id t)
{
    int32_t place = m->n->place[t];
    return place != TRI_NONE && (m->down ? number_in(place) < m->batch.first : number_in(place) >= m->batch.last);
}

/* Copies the triangles of a share to the buffer, renumbered. Prefetches later ones, so that accesses overlap. */
static void gather_batch(void *context, size_t share)
{
    struct move *m = context;
    const struct par_numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    struct tri_triangle *to = n->buffer - m->batch.first;
    const int32_t *turned = n->dealt;
    int32_t aside = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        aside += stands_here(m, t);
        if (t + PAR_MOVED_AHEAD < range.last)
            __builtin_prefetch(source_of(n, turned[t + PAR_MOVED_AHEAD]));
        to[t] = renamed(n, source_of(n, turned[t]), corner_in(turned[t]));
    }
    m->aside[share] = aside;
}

/* Sets aside triangles that move in a later batch, and copies the buffer to its places. */
static void put_down(void *context, size_t share)
{
    const struct move *m = context;
    const struct par_numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    int32_t aside = m->aside[share];
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (stands_here(m, t)) {
            aside_of(n)[aside] = n->mesh->tri[t];
            n->dealt[number_in(n->place[t])] = ASIDE | turn(aside++, corner_in(n->place[t]));
        }
        n->mesh->tri[t] = n->buffer[t - m->batch.first];
    }
}

static void move_batch(struct move *m)
{
    memset(m->aside, 0, sizeof m->aside);
    tri_execute(m->n->executor, BATCH_SHARES, gather_batch, m);
    for (int share = 0; share < BATCH_SHARES; share++) {
        int32_t count = m->aside[share];
        m->aside[share] = m->n_aside;
        m->n_aside += count;
    }
    tri_execute(m->n->executor, BATCH_SHARES, put_down, m);
}

/* Returns the number of triangles in a batch. */
static int32_t move_batch_size(int32_t n_triangles)
{
    return n_triangles / PAR_FEWEST_BATCHES < PAR_MOST_MOVE ? n_triangles / PAR_FEWEST_BATCHES + 1 : PAR_MOST_MOVE;
}

static void move_triangles(const struct par_numbering *n, int32_t n_tri)
{
    const int32_t size = move_batch_size(n->mesh->n_triangles), batches = n_tri / size + 1;
    int64_t down = 0;
    for (int32_t tile = 0; tile < n->triangles.n_tiles; tile++)
        down += n->triangles.at[tile];
    struct move m = {.n = n, .down = 2 * down <= n_tri};
    for (int32_t i = 0; i < batches; i++) {
        int32_t first = size * (m.down ? batches - 1 - i : i), left = n_tri - first;
        m.batch = (struct tri_range){first, first + (left < size ? left : size)};
        move_batch(&m);
    }
    assert(m.n_aside <= n->mesh->n_triangles / 2);
}

/* --- allocation and the complete numbering */

static size_t most_bytes(size_t a, size_t b) { return a < b ? b : a; }

static size_t scratch_bytes(const struct tri_mesh *mesh, size_t vertices)
{
    const size_t two_items = 2 * sizeof(uint64_t);
    const size_t for_vertices = vertices * most_bytes(tri_vertex_size(mesh), two_items);
    const size_t for_subs = (size_t)mesh->n_subs * two_items;
    const size_t aside = ((size_t)mesh->n_triangles / 2 + 1) * sizeof(struct tri_triangle);
    return most_bytes(most_bytes(for_vertices, for_subs), most_bytes(sort_scratch(mesh), aside));
}

static enum tri_status allocate(struct par_numbering *n, struct tri_error *error)
{
    const struct tri_mesh *mesh = n->mesh;
    size_t vertices = (size_t)(mesh->n_vertices - n->n_kept), subs = (size_t)mesh->n_subs;
    const int32_t n_tiles = par_tile_columns(n->partition) * par_tile_rows(n->partition);
    bool deals = par_deal_reserve(&n->vertices, mesh->n_vertices - n->n_kept, n_tiles);
    deals = par_deal_reserve(&n->triangles, mesh->n_triangles, n_tiles) && deals;
    n->kept_tile = malloc(((size_t)n->n_kept + 1) * sizeof *n->kept_tile);
    n->order = tri_mesh_extra(mesh, most_bytes((vertices + 1) * sizeof *n->order,
                                               (size_t)move_batch_size(mesh->n_triangles) * sizeof *n->buffer));
    n->number = tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *n->number);
    n->subs.number = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->subs.number);
    n->subs.item = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->subs.item);
    n->place = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->place);
    n->dealt = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->dealt);
    n->scratch = tri_mesh_extra(mesh, scratch_bytes(mesh, vertices));
    if (deals && n->kept_tile && n->order && n->number && n->subs.number && n->subs.item && n->place && n->dealt &&
        n->scratch)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for numbering %d triangles", (int)mesh->n_triangles);
}

/* Numbers the mesh; all memory has been allocated. Cannot fail. */
static void renumber(struct par_numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    const int32_t n_new = number_vertices(n);
    tri_mesh_gather_vertices(mesh, n->n_kept, n->order, n_new, n->scratch, n->executor);
    rename_subs(n);
    number_subs(n);
    const int32_t n_tri = sort_triangles(n);
    move_triangles(n, n_tri);
    move_subs(n);
    mesh->n_triangles = n_tri;
    mesh->n_subs = n->subs.n;
    mesh->n_vertices = n->n_kept + n_new;
}

static void free_numbering(struct par_numbering *n)
{
    par_deal_free(&n->vertices);
    par_deal_free(&n->triangles);
    free(n->kept_tile);
    tri_mesh_extra_free(n->mesh, n->order);
    tri_mesh_extra_free(n->mesh, n->number);
    tri_mesh_extra_free(n->mesh, n->subs.number);
    tri_mesh_extra_free(n->mesh, n->subs.item);
    tri_mesh_extra_free(n->mesh, n->place);
    tri_mesh_extra_free(n->mesh, n->dealt);
    tri_mesh_extra_free(n->mesh, n->scratch);
}

enum tri_status par_number(struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept,
                           const struct tri_executor *executor, struct tri_error *error)
{
    assert(mesh->incidence.n_vertices <= n_kept && n_kept <= mesh->n_vertices);
    struct par_numbering n = {.mesh = mesh, .partition = partition, .executor = executor, .n_kept = n_kept};
    enum tri_status status = tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(error) : allocate(&n, error);
    if (!status)
        renumber(&n);
    assert(status || tri_mesh_is_sound(mesh));
    free_numbering(&n);
    return status;
}
