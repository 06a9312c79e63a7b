/* New numbers of vertices, subsegments and triangles; then all move.
 *
 * THEOREM. Each order is total: new vertices lie at different places; of the triangles that start at a corner each has
 * another second corner, since an edge has one triangle on its left; of the subsegments of a parent, which all run its
 * way, each starts at another vertex. So nothing is left to how the mesh came about.
 *
 * All memory is asked for before anything moves. A page that is touched for the first time costs as much as sorting
 * what is in it: so memory serves several times, and who works on tiles has one room for all of them. */
#include "sched/tiles/numbering.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/deal.h"
#include "sched/tunables.h"
#include "triangle/base/radix.h"
#include "triangle/geometry/hilbert.h"

/* A triangle is *turned* when it starts at another of its corners: then it is told by 31 bits, a number with the corner
 * that will be the first. An item is what is sorted, in the lower 31 bits, with the key that it is sorted by above.
 * A tile has an index here, in the order of tiles. */

enum { CORNER_BITS = 2, VALUE_BITS = 31 };

_Static_assert(INT64_C(1) << VALUE_BITS == (int64_t)TRI_MAX_TRIANGLES << CORNER_BITS, "turned triangles fill the bits");

static inline uint64_t item_of(int32_t key, int32_t value) { return (uint64_t)key << VALUE_BITS | (uint64_t)value; }
static inline int32_t key_of(uint64_t item) { return (int32_t)(item >> VALUE_BITS); }
static inline int32_t value_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << VALUE_BITS) - 1)); }

static inline int32_t turn(int32_t number, int corner) { return number << CORNER_BITS | corner; }
static inline int32_t number_in(int32_t turned) { return turned >> CORNER_BITS; }
static inline int corner_in(int32_t turned) { return turned & 3; }

struct par_numbered_subs {
    int32_t n;                   /* subsegments that are not free */
    int32_t *number;             /* [mesh->n_subs] the new number of each */
    struct tri_subsegment *item; /* [mesh->n_subs] in their new order, on their way back to the mesh */
};

struct par_numbering {
    struct tri_mesh *mesh;                 /* whose arrays move */
    const struct par_partition *partition; /* its tiles give the order */
    const struct tri_executor *executor;   /* runs shares and tiles; NULL: they run one after the other */
    int32_t n_kept;     /* the vertices that keep their numbers */
    int32_t *kept_tile; /* [n_kept] the tile of each of these */
    struct par_deal vertices, triangles; /* new vertices; all triangles */
    struct par_numbered_subs subs;         /* as many as the mesh has */
    /* Memory that serves several times, by several names: each until the next is needed. */
    union {
        int32_t *order;   /* [n_vertices - n_kept] the new vertices, one after the other */
        int32_t *fan_end; /* of the triangles that start at each */
        struct tri_triangle *buffer; /* [move_batch_size] those that move at once */
    };
    union {
        int32_t *tile_of; /* [n_vertices] of a new vertex; TRI_NONE: the id is free */
        int32_t *number;  /* the new one of each */
    };
    union {
        int32_t *key;     /* [n_triangles] see below: the order of triangles */
        int32_t *place;   /* turned: where it goes; TRI_NONE: the id is free */
    };
    int32_t *dealt;      /* [n_triangles] turned, tile by tile, in the end in their new order */
    void *scratch;       /* what is sorted, vertices on their way, triangles set aside */
};

/* The tile of a new number. */
static inline int32_t tile_of_number(const struct par_numbering *n, int32_t number)
{
    if (number < n->n_kept)
        return n->kept_tile[number];
    return par_holder_of(n->vertices.start, n->vertices.n_tiles, number - n->n_kept);
}

/* A half-edge where all triangles have their places. */
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

/* Returns how many new vertices there are. */
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

/* By start, then, since sorting keeps the order of equals, by parent, then by tile. */
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

/* --- The new order of triangles: tile by tile, in each by their corners' new numbers.  A key is the largest number of
 * a triangle's corners, with that corner. A key says, too, that the triangle is *stray*: its tile is another than
 * that of its first corner. What belongs to a tile is found by one counting sort; its triangles then fit the
 * cache, and tiles are tasks. */

enum { FREE_KEY = TRI_NONE, STRAY_KEY = 1 << 30 };

_Static_assert((int64_t)TRI_MAX_VERTICES << CORNER_BITS <= STRAY_KEY, "a key has a bit left");

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t most(uint64_t a, uint64_t b) { return a < b ? b : a; }

/* While triangles are sorted: the new number of the second corner of each; and items of the tiles that are being
 * sorted, behind these. */
static int32_t *second_of(const struct par_numbering *n) { return n->scratch; }
static uint64_t *items_of(const struct par_numbering *n)
{
    return (uint64_t *)n->scratch + n->mesh->n_triangles / 2 + 1;
}

/* The last tile of corners by their new numbers. */
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

/* The same for triangles that mostly are of the same tile as the last. */
struct tile_range {
    int32_t tile, first, count; /* numbers of its vertices */
};

static bool is_within(const struct tile_range *range, int32_t number)
{
    return (uint32_t)(number - range->first) < (uint32_t)range->count; /* a stray's is out of all ranges */
}

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

/* Is the triangle's tile another than that of its first corner? A new vertex with a smaller number is in no later
 * one. */
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

/* No branch tells which corner has the largest number: it could not be predicted. */
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

/* Items by key, those of one tile. */
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

/* A tile that is being sorted. Most of its triangles start at one of its own new vertices: they are sorted by counting.
 * The others come before them. */
struct sorting {
    const struct par_numbering *n;
    int32_t *turned;            /* [count] of its triangles, then in their new order */
    uint64_t *item, *spare;     /* [count] */
    int32_t first, count;       /* of the triangles */
    int32_t first_own, n_own;   /* of the vertices */
    int32_t *end;               /* [n_own] of the fan at each */
    int32_t n_others;
};

/* The first corner's new number. */
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
        s->end[i] = sum; /* where it begins */
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

/* By the next corner, those that start at one. */
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

/* Four items in their order, without a branch that depends on it; all ones stand for those that are not there. */
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

/* Where four are written, fewer may be meant: the next fan overwrites the others. */
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
    n->triangles.at[tile] = down;
}

/* Returns how many triangles there are. */
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

/* --- Triangles move in place, batch by batch of their new places, down from the last: those of a batch are gathered
 * in a buffer; those that stand in their places, and belong to batches to come, are set aside; then the batch is
 * put down. So a triangle is set aside only if it moves down, or, where more of them do than up, and batches go up
 * from the first, only if it moves up: at most half of them. */

enum { BATCH_SHARES = 32 };

struct move {
    const struct par_numbering *n;
    struct tri_range batch;  /* of new places */
    bool down;               /* batches go down: what is below has not moved yet */
    int32_t n_aside;        /* before this batch */
    int32_t aside[BATCH_SHARES]; /* by each share */
};

static struct tri_range batch_share(const struct move *m, size_t share)
{
    struct tri_range range = tri_share_of(share, BATCH_SHARES, m->batch.last - m->batch.first);
    return (struct tri_range){m->batch.first + range.first, m->batch.first + range.last};
}

/* Of triangles in their new order: this one has been set aside, and the number is its place there. */
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

/* Something stands here that is to go to a batch to come. */
static bool stands_here(const struct move *m, tri_triangle_id t)
{
    int32_t place = m->n->place[t];
    return place != TRI_NONE && (m->down ? number_in(place) < m->batch.first : number_in(place) >= m->batch.last);
}

/* Those that come soon are fetched already, so that the memory works on many at once. */
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

/* How many triangles are to move at once. */
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

/* --- all of it */

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

/* Cannot fail. */
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
