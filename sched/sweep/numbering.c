/* New numbers of vertices, subsegments and triangles; then all move.
 *
 * THEOREM. Each order is total: new vertices lie at different places; of the triangles that start at a corner each has
 * another second corner, since an edge has one triangle on its left; of the subsegments of a parent, which all run its
 * way, each starts at another vertex. So nothing is left to how the mesh came about.
 *
 * What belongs to a tile is found by one counting sort, in shares; what is sorted then fits the cache, and tiles are
 * tasks. A tile has an index here, in the order of tiles.
 *
 * All memory is asked for before anything moves. Triangles move in place, batch by batch of their new places, down from
 * the last: those of a batch are gathered in a buffer; those that stand in their places, and belong to batches to
 * come, are set aside; then the batch is put down. So a triangle is set aside only if it moves down, or, where more of
 * them do than up, and batches go up from the first, only if it moves up: at most half of them.
 *
 * A page that is touched for the first time costs as much as sorting what is in it: so memory serves several times, and
 * who works on tiles has one room for all of them. */
#include "sched/sweep/numbering.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/hilbert.h"
#include "triangle/radix.h"

/* A number with a corner, 31 bits: of a triangle its id or its place, with the corner that will be the first, or the
 * largest number of its corners. An item is such a code, or the id of a subsegment, with what it is sorted by above. */
enum { CORNER_BITS = 2, CODE_BITS = 31 };

enum {
    FEW = 24,        /* are sorted by insertion */
    BATCH = 1 << 18, /* triangles that move at once, in a large mesh: so many that threads wait for each other seldom */
    BATCHES = 16,    /* in a small one */
    BATCH_SHARES = 32
};

_Static_assert(INT64_C(1) << CODE_BITS == (int64_t)TRI_MAX_TRIANGLES << CORNER_BITS, "codes fill their bits");

static uint64_t item_of(int32_t key, int32_t code) { return (uint64_t)key << CODE_BITS | (uint64_t)code; }
static int32_t key_of(uint64_t item) { return (int32_t)(item >> CODE_BITS); }
static int32_t code_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << CODE_BITS) - 1)); }

static int32_t code_with(int32_t number, int corner) { return number << CORNER_BITS | corner; }
static int32_t number_in(int32_t pair) { return pair >> CORNER_BITS; }
static int corner_in(int32_t pair) { return pair & 3; }

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t most(uint64_t a, uint64_t b) { return a < b ? b : a; }

/* Things of each tile: so many of each in each share of where they are now, then where the next one goes. */
struct deal {
    int32_t *at;         /* [shares][n_tiles] */
    int32_t *start;      /* [n_tiles + 1] */
    size_t shares;
    int32_t n;           /* things that are dealt, free ones among them */
};

struct numbering {
    struct tri_mesh *mesh;
    const struct par_partition *partition;
    const struct tri_executor *executor;
    int32_t n_kept;    /* the vertices that keep their numbers */
    int32_t n_tiles;
    int32_t *kept_tile; /* [n_kept] */
    struct deal vertices, triangles; /* new vertices; all triangles */
    int32_t n_new;
    /* Memory that serves several times, by several names: each until the next is needed. */
    union {
        int32_t *order;   /* [n_vertices - n_kept] the new vertices, one after the other */
        int32_t *fan_end; /* of the triangles that start at each */
        struct tri_triangle *buffer; /* [batch] */
    };
    union {
        int32_t *tile_of; /* [n_vertices] of a new vertex; TRI_NONE: the id is free */
        int32_t *number;  /* the new one of each */
    };
    union {
        int32_t *key;     /* [n_triangles] the largest number of a corner, and which; FREE_KEY: the id is free */
        int32_t *place;   /* where it goes, and which corner will be the first; TRI_NONE */
    };
    int32_t *dealt;      /* [n_triangles] ids with their first corners: tile by tile, in the end in their new order */
    int32_t *sub_number; /* [n_subs] */
    struct tri_subsegment *sub; /* [n_subs] */
    void *scratch;       /* what is sorted, vertices on their way, what is set aside */
    int32_t batch;
    int32_t n_tri, n_subs;            /* live ones */
};

/* A key says, too, that the triangle's tile is another than that of its first corner. */
enum { FREE_KEY = TRI_NONE, STRAY_KEY = 1 << 30 };

_Static_assert((int64_t)TRI_MAX_VERTICES << CORNER_BITS <= STRAY_KEY, "a key has a bit left");

/* While triangles are sorted: the new number of the second corner of each; and items of the tiles that are being
 * sorted, behind these. */
static int32_t *second_of(const struct numbering *n) { return n->scratch; }
static uint64_t *items_of(const struct numbering *n) { return (uint64_t *)n->scratch + n->mesh->n_triangles / 2 + 1; }

/* Of triangles in their new order: this one has been set aside, and the number is its place there. */
static const int32_t ASIDE = INT32_MIN;

static struct tri_triangle *aside_of(const struct numbering *n) { return n->scratch; }

/* --- tiles */

/* Tiles are taken one by one by as many hands as there is room for, each for the largest tile: where one tile
 * holds nearly all, by a single one, which takes about twice the time of that tile at most. Where there are more
 * hands than threads, those that come first do all the work, and their room stays in the cache. */
struct hands {
    const struct numbering *n;
    void (*work)(const struct numbering *n, size_t tile, uint64_t *room);
    uint64_t *room;         /* [hands][each] */
    size_t each;
    atomic_size_t next;     /* tile */
};

static void take_tiles(void *context, size_t hand)
{
    struct hands *h = context;
    for (size_t tile; (tile = atomic_fetch_add(&h->next, 1)) < (size_t)h->n->n_tiles;)
        h->work(h->n, tile, h->room + hand * h->each);
}

/* Things of a deal, tile by tile, with room for two items of each. */
static void work_on_tiles(const struct numbering *n, const struct deal *deal, uint64_t *room,
                          void (*work)(const struct numbering *n, size_t tile, uint64_t *room))
{
    int32_t largest = 1;
    for (int32_t tile = 0; tile < n->n_tiles; tile++) {
        int32_t count = deal->start[tile + 1] - deal->start[tile];
        largest = count > largest ? count : largest;
    }
    struct hands hands = {n, work, room, 2 * (size_t)largest, 0};
    size_t most = (size_t)deal->n / (size_t)largest;
    tri_execute(n->executor, most < (size_t)n->n_tiles ? most : (size_t)n->n_tiles, take_tiles, &hands);
}

static struct tri_range share_of(const struct deal *d, size_t share) { return tri_share_of(share, d->shares, d->n); }

/* Counts become places: tile by tile, in each share by share. */
static int32_t add_up_counts(struct deal *d, int32_t n_tiles)
{
    int32_t sum = 0;
    for (int32_t tile = 0; tile < n_tiles; tile++) {
        d->start[tile] = sum;
        for (size_t share = 0; share < d->shares; share++) {
            int32_t *at = &d->at[share * (size_t)n_tiles + (size_t)tile], count = *at;
            *at = sum;
            sum += count;
        }
    }
    d->start[n_tiles] = sum;
    assert(sum <= d->n);
    return sum;
}

/* The tile of places that mostly lie in the same one as the last. */
struct tile_finder {
    struct par_locator locator;
    int32_t block, tile;
};

static const struct tile_finder LOST = {{{1, 1, 0, 0}, TRI_NONE}, TRI_NONE, TRI_NONE};

static int32_t find_tile(struct tile_finder *f, const struct par_partition *p, struct tri_point q)
{
    int32_t block = par_locate(&f->locator, p, 0, q);
    if (block != f->block) {
        f->block = block;
        f->tile = block / p->n_rows / 2 * (p->n_rows / 2) + block % p->n_rows / 2;
    }
    assert(tri_fence_holds(&f->locator.fence, q));
    return f->tile;
}

/* The tile of a new number. */
static int32_t tile_of_number(const struct numbering *n, int32_t number)
{
    if (number < n->n_kept)
        return n->kept_tile[number];
    int32_t low = 0, high = n->n_tiles, place = number - n->n_kept; /* start[low] <= place < start[high] */
    while (high - low > 1) {
        int32_t middle = low + (high - low) / 2;
        if (n->vertices.start[middle] <= place)
            low = middle;
        else
            high = middle;
    }
    return low;
}

/* --- vertices */

static void count_vertices(void *context, size_t share)
{
    const struct numbering *n = context;
    const struct tri_mesh *mesh = n->mesh;
    struct tri_range range = share_of(&n->vertices, share);
    int32_t *count = n->vertices.at + share * (size_t)n->n_tiles;
    struct tile_finder finder = LOST;
    for (int32_t i = range.first; i < range.last; i++) {
        tri_vertex_id v = n->n_kept + i;
        n->tile_of[v] = TRI_NONE;
        if (mesh->on[v] != TRI_VERTEX_NONE)
            count[n->tile_of[v] = find_tile(&finder, n->partition, mesh->xy[v])]++;
    }
}

static void deal_vertices(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = share_of(&n->vertices, share);
    int32_t *at = n->vertices.at + share * (size_t)n->n_tiles;
    for (tri_vertex_id v = n->n_kept + range.first; v < n->n_kept + range.last; v++)
        if (n->tile_of[v] != TRI_NONE)
            n->order[at[n->tile_of[v]]++] = v;
}

static void number_tile(const struct numbering *n, size_t tile, uint64_t *room)
{
    int32_t first = n->vertices.start[tile], end = n->vertices.start[tile + 1];
    tri_hilbert_order_coarse(n->mesh->xy, n->order + first, end - first, room);
    for (int32_t i = first; i < end; i++)
        n->number[n->order[i]] = n->n_kept + i;
}

static void find_kept(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = tri_share(share, n->n_kept);
    struct tile_finder finder = LOST;
    for (tri_vertex_id v = range.first; v < range.last; v++) {
        n->number[v] = v;
        n->kept_tile[v] = find_tile(&finder, n->partition, n->mesh->xy[v]);
    }
}

static void number_vertices(struct numbering *n)
{
    tri_execute(n->executor, tri_shares(n->n_kept), find_kept, n);
    tri_execute(n->executor, n->vertices.shares, count_vertices, n);
    n->n_new = add_up_counts(&n->vertices, n->n_tiles);
    tri_execute(n->executor, n->vertices.shares, deal_vertices, n);
    work_on_tiles(n, &n->vertices, n->scratch, number_tile);
}

/* --- subsegments */

static void rename_subs(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        for (int k = 0; k < 2 && mesh->sub[s].v[k] != TRI_NONE; k++)
            mesh->sub[s].v[k] = n->number[mesh->sub[s].v[k]];
}

static void sort_subs(const struct numbering *n, int32_t limit)
{
    uint64_t *item = n->scratch;
    tri_radix_sort(item, item + n->mesh->n_subs, n->n_subs, CODE_BITS, CODE_BITS + tri_bits_of(limit), n->executor);
}

static int32_t tile_of_sub(const struct numbering *n, const struct tri_subsegment *s)
{
    int32_t a = tile_of_number(n, s->v[0]), b = tile_of_number(n, s->v[1]);
    return a > b ? a : b;
}

/* By start, then, since sorting keeps the order of equals, by parent, then by tile. */
static void number_subs(struct numbering *n)
{
    const struct tri_mesh *mesh = n->mesh;
    uint64_t *item = n->scratch;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->sub[s].v[0] != TRI_NONE)
            item[n->n_subs++] = item_of(mesh->sub[s].v[0], s);
    sort_subs(n, mesh->n_vertices);
    for (int32_t i = 0; i < n->n_subs; i++) {
        tri_parent_id parent = mesh->sub[code_of(item[i])].parent;
        assert(parent >= 0 && parent < mesh->n_parents);
        item[i] = item_of(parent, code_of(item[i]));
    }
    sort_subs(n, mesh->n_parents);
    for (int32_t i = 0; i < n->n_subs; i++)
        item[i] = item_of(tile_of_sub(n, &mesh->sub[code_of(item[i])]), code_of(item[i]));
    sort_subs(n, n->n_tiles);
    for (int32_t i = 0; i < n->n_subs; i++)
        n->sub_number[code_of(item[i])] = i;
}

/* --- triangles */

static inline tri_halfedge new_code(const int32_t *place_of_triangle, tri_halfedge code)
{
    static const uint8_t turned[4][4] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    int32_t place = place_of_triangle[tri_of(code)];
    return tri_code(number_in(place), turned[corner_in(place)][tri_edge(code)]);
}

/* The last tile of corners by their new numbers. */
static int32_t tile_of_triangle(const struct numbering *n, const tri_vertex_id v[3])
{
    int32_t last = 0;
    for (int k = 0; k < 3; k++) {
        int32_t tile = tile_of_number(n, v[k]);
        last = tile > last ? tile : last;
    }
    return last;
}

static int32_t tile_of_key(const struct numbering *n, tri_triangle_id t)
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

static inline int32_t tile_after(const struct numbering *n, struct tile_range *last, tri_triangle_id t)
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
static bool is_stray(const struct numbering *n, const struct tile_range *last, const tri_vertex_id v[3],
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
static inline void key_triangle(const struct numbering *n, const struct tile_range *last, const int32_t *old,
                                tri_triangle_id t)
{
    const int32_t *number = n->number;
    const int32_t v[3] = {number[old[0]], number[old[1]], number[old[2]]};
    int32_t key = greater(greater(code_with(v[0], 0), code_with(v[1], 1)), code_with(v[2], 2));
    second_of(n)[t] = number[old[tri_next[corner_in(key)]]];
    if (lesser(lesser(v[0], v[1]), v[2]) < n->n_kept && is_stray(n, last, v, number_in(key)))
        key |= STRAY_KEY;
    n->key[t] = key;
}

static void key_share(void *context, size_t share)
{
    const struct numbering *n = context;
    const struct tri_triangle *tri = n->mesh->tri;
    struct tri_range range = share_of(&n->triangles, share);
    struct tile_range last = {0};
    int32_t *count = n->triangles.at + share * (size_t)n->n_tiles;
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
    const struct numbering *n = context;
    struct tri_range range = share_of(&n->triangles, share);
    struct tile_range last = {0};
    int32_t *at = n->triangles.at + share * (size_t)n->n_tiles;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (n->key[t] == FREE_KEY)
            continue;
        n->dealt[at[tile_after(n, &last, t)]++] = code_with(t, corner_in(n->key[t]));
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
        item[i] -= (uint64_t)low << CODE_BITS;
    tri_radix_sort(item, scratch, count, CODE_BITS, CODE_BITS + tri_bits_of(high - low), NULL);
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

static uint64_t by_second(const struct numbering *n, int32_t code)
{
    return item_of(second_of(n)[number_in(code)], code);
}

/* A tile that is being sorted. Most of its triangles start at one of its own new vertices: they are sorted by counting.
 * The others come before them. */
struct sorting {
    const struct numbering *n;
    int32_t *code;              /* [count] of its triangles, then in their new order */
    uint64_t *item, *spare;     /* [count] */
    int32_t first, count;       /* of the triangles */
    int32_t first_own, n_own;   /* of the vertices */
    int32_t *end;               /* [n_own] of the fan at each */
    int32_t n_others;
};

/* The first corner's new number. */
static int32_t first_number(const struct sorting *s, int32_t code)
{
    return number_in(s->n->key[number_in(code)]);
}

static bool is_own(const struct sorting *s, int32_t number)
{
    return (uint32_t)(number - s->first_own) < (uint32_t)s->n_own;
}

static void count_fans(struct sorting *s)
{
    memset(s->end, 0, (size_t)s->n_own * sizeof *s->end);
    for (int32_t i = 0; i < s->count; i++) {
        int32_t number = first_number(s, s->code[i]);
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
        int32_t code = s->code[i], number = first_number(s, code);
        if (is_own(s, number))
            s->item[s->end[number - s->first_own]++] = by_second(s->n, code);
        else
            s->item[other++] = item_of(number, code);
    }
}

static void take_codes(struct sorting *s, int32_t begin, int32_t end)
{
    for (int32_t i = begin; i < end; i++)
        s->code[i] = code_of(s->item[i]);
}

/* By the next corner, those that start at one. */
static void sort_fan(struct sorting *s, int32_t begin, int32_t end)
{
    if (end - begin <= FEW)
        insert_items(s->item + begin, end - begin);
    else
        sort_items(s->item + begin, s->spare, end - begin);
    take_codes(s, begin, end);
}

static void sort_others(struct sorting *s)
{
    uint64_t *item = s->item;
    if (s->n_others > 0)
        sort_items(item, s->spare, s->n_others);
    for (int32_t begin = 0, end; begin < s->n_others; begin = end) {
        int32_t number = key_of(item[begin]);
        for (end = begin; end < s->n_others && key_of(item[end]) == number; end++)
            item[end] = by_second(s->n, code_of(item[end]));
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
    to[0] = code_of(least(low, low_too));
    to[1] = code_of(least(second, third));
    to[2] = code_of(most(second, third));
    to[3] = code_of(most(high, high_too));
}

/* Where four are written, fewer may be meant: the next fan overwrites the others. */
static void sort_fans(struct sorting *s)
{
    for (int32_t i = 0, begin = s->n_others; i < s->n_own; begin = s->end[i++]) {
        int32_t count = s->end[i] - begin;
        if (count <= 4 && begin + 4 <= s->count)
            sort_four(s->item + begin, count, s->code + begin);
        else
            sort_fan(s, begin, s->end[i]);
    }
}

static void place_tile(const struct numbering *n, size_t tile, uint64_t *room)
{
    int32_t first = n->triangles.start[tile], own = n->vertices.start[tile], down = 0;
    struct sorting s = {.n = n, .code = n->dealt + first, .item = room, .first = first,
                        .count = n->triangles.start[tile + 1] - first, .first_own = n->n_kept + own,
                        .n_own = n->vertices.start[tile + 1] - own, .end = n->fan_end + own};
    s.spare = room + s.count;
    count_fans(&s);
    fill_fans(&s);
    sort_others(&s);
    sort_fans(&s);
    for (int32_t i = 0; i < s.count; i++) {
        tri_triangle_id t = number_in(s.code[i]);
        n->place[t] = code_with(first + i, corner_in(s.code[i]));
        down += first + i < t;
    }
    n->triangles.at[tile] = down;
}

static void number_triangles(struct numbering *n)
{
    tri_execute(n->executor, n->triangles.shares, key_share, n);
    n->n_tri = add_up_counts(&n->triangles, n->n_tiles);
    tri_execute(n->executor, n->triangles.shares, deal_triangles, n);
    work_on_tiles(n, &n->triangles, items_of(n), place_tile);
}

/* --- triangles move */

struct move {
    const struct numbering *n;
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

static inline const struct tri_triangle *source_of(const struct numbering *n, int32_t code)
{
    return (code < 0 ? aside_of(n) : n->mesh->tri) + number_in(code & ~ASIDE);
}

static inline tri_link new_link(const int32_t *place, const int32_t *sub_number, tri_link link)
{
    return link >= 0 ? new_code(place, link) : ~sub_number[~link];
}

static inline struct tri_triangle renamed(const struct numbering *n, const struct tri_triangle *t, int first)
{
    const int32_t *number = n->number, *place = n->place, *sub_number = n->sub_number;
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
    enum { AHEAD = 32 };
    struct move *m = context;
    const struct numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    struct tri_triangle *to = n->buffer - m->batch.first;
    const int32_t *code = n->dealt;
    int32_t aside = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        aside += stands_here(m, t);
        if (t + AHEAD < range.last)
            __builtin_prefetch(source_of(n, code[t + AHEAD]));
        to[t] = renamed(n, source_of(n, code[t]), corner_in(code[t]));
    }
    m->aside[share] = aside;
}

static void put_down(void *context, size_t share)
{
    const struct move *m = context;
    const struct numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    int32_t aside = m->aside[share];
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (stands_here(m, t)) {
            aside_of(n)[aside] = n->mesh->tri[t];
            n->dealt[number_in(n->place[t])] = ASIDE | code_with(aside++, corner_in(n->place[t]));
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

static void move_triangles(const struct numbering *n)
{
    int64_t down = 0;
    for (int32_t tile = 0; tile < n->n_tiles; tile++)
        down += n->triangles.at[tile];
    struct move m = {.n = n, .down = 2 * down <= n->n_tri};
    int32_t batches = n->n_tri / n->batch + 1;
    for (int32_t i = 0; i < batches; i++) {
        int32_t first = n->batch * (m.down ? batches - 1 - i : i), left = n->n_tri - first;
        m.batch = (struct tri_range){first, first + (left < n->batch ? left : n->batch)};
        move_batch(&m);
    }
    assert(m.n_aside <= n->mesh->n_triangles / 2);
}

/* --- subsegments move */

static void move_subs(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    for (tri_sub_id s = 0; s < mesh->n_subs; s++) {
        if (mesh->sub[s].v[0] == TRI_NONE)
            continue;
        struct tri_subsegment *to = &n->sub[n->sub_number[s]];
        *to = mesh->sub[s];
        for (int side = 0; side < 2; side++)
            if (to->side[side] != TRI_NONE)
                to->side[side] = new_code(n->place, to->side[side]);
    }
    if (n->n_subs > 0)
        memcpy(mesh->sub, n->sub, (size_t)n->n_subs * sizeof *n->sub);
}

/* Few enough shares for counts not to outgrow what is counted. */
static bool reserve_deal(struct deal *d, int32_t n, int32_t n_tiles)
{
    size_t most = (size_t)n / (size_t)n_tiles + 1, shares = tri_shares(n);
    *d = (struct deal){.n = n, .shares = shares < most ? shares : most};
    d->at = calloc(d->shares * (size_t)n_tiles, sizeof *d->at);
    d->start = malloc(((size_t)n_tiles + 1) * sizeof *d->start);
    return d->at && d->start;
}

static size_t most_bytes(size_t a, size_t b) { return a < b ? b : a; }

static size_t scratch_bytes(const struct tri_mesh *mesh, size_t vertices)
{
    const size_t two_items = 2 * sizeof(uint64_t);
    const size_t for_vertices = vertices * most_bytes(tri_vertex_size(mesh), two_items);
    const size_t for_triangles = (size_t)mesh->n_triangles * (sizeof(int32_t) + two_items) + two_items;
    const size_t for_subs = (size_t)mesh->n_subs * two_items;
    return most_bytes(most_bytes(for_vertices, for_triangles), for_subs) + sizeof(struct tri_triangle);
}

static enum tri_status allocate(struct numbering *n, struct tri_error *error)
{
    const struct tri_mesh *mesh = n->mesh;
    size_t vertices = (size_t)(mesh->n_vertices - n->n_kept), subs = (size_t)mesh->n_subs;
    bool deals = reserve_deal(&n->vertices, mesh->n_vertices - n->n_kept, n->n_tiles);
    deals = reserve_deal(&n->triangles, mesh->n_triangles, n->n_tiles) && deals;
    n->kept_tile = malloc(((size_t)n->n_kept + 1) * sizeof *n->kept_tile);
    n->batch = mesh->n_triangles / BATCHES < BATCH ? mesh->n_triangles / BATCHES + 1 : BATCH;
    n->order = tri_mesh_extra(mesh, most_bytes((vertices + 1) * sizeof *n->order,
                                               (size_t)n->batch * sizeof *n->buffer));
    n->number = tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *n->number);
    n->sub_number = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub_number);
    n->sub = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub);
    n->place = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->place);
    n->dealt = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->dealt);
    n->scratch = tri_mesh_extra(mesh, scratch_bytes(mesh, vertices));
    if (deals && n->kept_tile && n->order && n->number && n->sub_number && n->sub && n->place && n->dealt && n->scratch)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for numbering %d triangles", (int)mesh->n_triangles);
}

/* Cannot fail. */
static void renumber(struct numbering *n)
{
    struct tri_mesh *mesh = n->mesh;
    number_vertices(n);
    tri_mesh_gather_vertices(mesh, n->n_kept, n->order, n->n_new, n->scratch, n->executor);
    rename_subs(n);
    number_subs(n);
    number_triangles(n);
    move_triangles(n);
    move_subs(n);
    mesh->n_triangles = n->n_tri;
    mesh->n_subs = n->n_subs;
    mesh->n_vertices = n->n_kept + n->n_new;
}

static void free_numbering(struct numbering *n)
{
    struct deal *deals[] = {&n->vertices, &n->triangles};
    for (int k = 0; k < 2; k++) {
        free(deals[k]->at);
        free(deals[k]->start);
    }
    free(n->kept_tile);
    tri_mesh_extra_free(n->mesh, n->order);
    tri_mesh_extra_free(n->mesh, n->number);
    tri_mesh_extra_free(n->mesh, n->sub_number);
    tri_mesh_extra_free(n->mesh, n->sub);
    tri_mesh_extra_free(n->mesh, n->place);
    tri_mesh_extra_free(n->mesh, n->dealt);
    tri_mesh_extra_free(n->mesh, n->scratch);
}

enum tri_status par_number(struct tri_mesh *mesh, const struct par_partition *partition, int32_t n_kept,
                           const struct tri_executor *executor, struct tri_error *error)
{
    assert(mesh->incidence.n_vertices <= n_kept && n_kept <= mesh->n_vertices);
    struct numbering n = {.mesh = mesh, .partition = partition, .executor = executor, .n_kept = n_kept,
                          .n_tiles = partition->n_columns / 2 * (partition->n_rows / 2)};
    enum tri_status status = tri_stop_is_asked(mesh->stop) ? tri_fail_stopped(error) : allocate(&n, error);
    if (!status)
        renumber(&n);
    assert(status || tri_mesh_is_sound(mesh));
    free_numbering(&n);
    return status;
}
