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
 * them do than up, and batches go up from the first, only if it moves up: at most half of them, in the memory of the
 * items that were sorted, and in what nobody touches otherwise. */
#include "sched/sweep/numbering.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/hilbert.h"
#include "triangle/radix.h"

/* What is sorted: a number or parent, and the triangle or subsegment that is sorted by it. A triangle tells also which
 * of its corners is the first, and whether its tile is another than that of its first corner. */
enum { ID_BITS = 29, FIRST_BITS = 2, KEY_SHIFT = ID_BITS + FIRST_BITS, STRAY_BIT = 63 };

enum {
    FEW = 24,        /* are sorted by insertion */
    BATCH = 1 << 18, /* triangles that move at once, in a large mesh: so many that threads wait for each other seldom */
    BATCHES = 16,    /* in a small one */
    BATCH_SHARES = 32
};

_Static_assert(INT64_C(1) << ID_BITS == TRI_MAX_TRIANGLES, "ids fill their bits");

static const uint64_t FREE = UINT64_MAX; /* the item of a number that is free */

static uint64_t item_of(int32_t key, int first, int32_t id)
{
    return (uint64_t)key << KEY_SHIFT | (uint64_t)first << ID_BITS | (uint64_t)id;
}

static uint64_t least(uint64_t a, uint64_t b) { return a < b ? a : b; }
static uint64_t most(uint64_t a, uint64_t b) { return a < b ? b : a; }

static int32_t key_of(uint64_t item) { return (int32_t)(item >> KEY_SHIFT); }
static int first_of(uint64_t item) { return (int)(item >> ID_BITS & 3); }
static int32_t id_of(uint64_t item) { return (int32_t)(item & ((UINT64_C(1) << ID_BITS) - 1)); }

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
    /* Memory that serves twice, by two names: the first until vertices have been put in order, and numbered; of a
     * triangle until its tile is sorted. */
    union {
        int32_t *order;   /* [n_vertices - n_kept] the new vertices, one after the other */
        int32_t *fan_end; /* of the triangles that start at each */
    };
    union {
        int32_t *tile_of; /* [n_vertices] of a new vertex; TRI_NONE: the id is free */
        int32_t *number;  /* the new one of each */
    };
    union {
        int32_t *second;  /* [n_triangles] the new number of the second corner; TRI_NONE: the id is free */
        int32_t *place;   /* where it goes; TRI_NONE */
    };
    int32_t *sub_number; /* [n_subs] */
    struct tri_subsegment *sub; /* [n_subs] */
    size_t n_items;    /* the larger of n_triangles and n_subs */
    void *scratch;     /* [3 * n_items] items: by tile, in the end in their new order; as they lie; what is aside */
    struct tri_triangle *buffer; /* [batch] */
    int32_t batch;
    int32_t n_tri, n_subs;            /* live ones */
};

static uint64_t *dealt_items(const struct numbering *n) { return n->scratch; } /* tile by tile, in the end sorted */
static uint64_t *items_of(const struct numbering *n) { return dealt_items(n) + n->n_items; }

/* Of items in their new order: the triangle has been set aside, and the id is its place there. */
enum { ASIDE_BIT = 63 };

static struct tri_triangle *aside_of(const struct numbering *n)
{
    return (struct tri_triangle *)(void *)items_of(n);
}

/* --- tiles */

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

static void number_tile(void *context, size_t tile)
{
    const struct numbering *n = context;
    int32_t first = n->vertices.start[tile], end = n->vertices.start[tile + 1];
    tri_hilbert_order_coarse(n->mesh->xy, n->order + first, end - first, (uint64_t *)n->scratch + 2 * (size_t)first);
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
    tri_execute(n->executor, (size_t)n->n_tiles, number_tile, n);
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
    tri_radix_sort(items_of(n), items_of(n) + n->n_items, n->n_subs, KEY_SHIFT, KEY_SHIFT + tri_bits_of(limit),
                   n->executor);
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
    uint64_t *item = items_of(n);
    for (tri_sub_id s = 0; s < mesh->n_subs; s++)
        if (mesh->sub[s].v[0] != TRI_NONE)
            item[n->n_subs++] = item_of(mesh->sub[s].v[0], 0, s);
    sort_subs(n, mesh->n_vertices);
    for (int32_t i = 0; i < n->n_subs; i++) {
        tri_parent_id parent = mesh->sub[id_of(item[i])].parent;
        assert(parent >= 0 && parent < mesh->n_parents);
        item[i] = item_of(parent, 0, id_of(item[i]));
    }
    sort_subs(n, mesh->n_parents);
    for (int32_t i = 0; i < n->n_subs; i++)
        item[i] = item_of(tile_of_sub(n, &mesh->sub[id_of(item[i])]), 0, id_of(item[i]));
    sort_subs(n, n->n_tiles);
    for (int32_t i = 0; i < n->n_subs; i++)
        n->sub_number[id_of(item[i])] = i;
}

/* --- triangles. A place is the new number, and how far corners turn to bring the first to the front. */

static int32_t place_of(int32_t number, int first) { return number << 2 | first; }

static inline tri_halfedge new_code(const int32_t *place_of_triangle, tri_halfedge code)
{
    static const uint8_t turned[4][4] = {{0, 1, 2}, {2, 0, 1}, {1, 2, 0}};
    int32_t place = place_of_triangle[tri_of(code)];
    return (place & ~3) | turned[place & 3][tri_edge(code)];
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

static int32_t tile_of_item(const struct numbering *n, uint64_t item)
{
    int32_t v[3];
    if (!(item >> STRAY_BIT))
        return tile_of_number(n, key_of(item));
    for (int k = 0; k < 3; k++)
        v[k] = n->number[n->mesh->tri[id_of(item)].v[k]];
    return tile_of_triangle(n, v);
}

/* The same for items that mostly are of the same tile as the last. */
struct tile_range {
    int32_t tile, first, count; /* numbers of its vertices */
};

static inline int32_t tile_after(const struct numbering *n, struct tile_range *last, uint64_t item)
{
    uint64_t place = (item >> KEY_SHIFT) - (uint64_t)last->first; /* huge for a stray or an earlier number */
    if (place >= (uint64_t)last->count) {
        int32_t tile = tile_of_item(n, item);
        if (item >> STRAY_BIT || key_of(item) < n->n_kept)
            return tile;
        const int32_t *start = n->vertices.start;
        *last = (struct tile_range){tile, n->n_kept + start[tile], start[tile + 1] - start[tile]};
    }
    return last->tile;
}

/* Is the triangle's tile another than that of its first corner? A new vertex with a smaller number is in no later
 * one. */
static bool is_stray(const struct numbering *n, const struct tile_range *last, const tri_vertex_id v[3], uint64_t item)
{
    int32_t number = key_of(item);
    bool same = (uint32_t)(number - last->first) < (uint32_t)last->count;
    int32_t tile = same ? last->tile : tile_of_number(n, number);
    bool stray = false;
    for (int k = 0; k < 3; k++)
        stray |= v[k] < n->n_kept && n->kept_tile[v[k]] > tile;
    return stray;
}

/* The item of the corner with the largest number is the largest: no branch, which could not be predicted. */
static inline uint64_t key_triangle(const struct numbering *n, const struct tile_range *last, const int32_t *old,
                                    tri_triangle_id t)
{
    const int32_t *number = n->number;
    const int32_t v[3] = {number[old[0]], number[old[1]], number[old[2]]};
    uint64_t item = most(most(item_of(v[0], 0, t), item_of(v[1], 1, t)), item_of(v[2], 2, t));
    n->second[t] = number[old[tri_next[first_of(item)]]];
    if (((v[0] < n->n_kept) | (v[1] < n->n_kept) | (v[2] < n->n_kept)) && is_stray(n, last, v, item))
        item |= UINT64_C(1) << STRAY_BIT;
    return item;
}

static void key_share(void *context, size_t share)
{
    const struct numbering *n = context;
    const struct tri_triangle *tri = n->mesh->tri;
    struct tri_range range = share_of(&n->triangles, share);
    struct tile_range last = {0};
    uint64_t *items = items_of(n);
    int32_t *count = n->triangles.at + share * (size_t)n->n_tiles;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        if (!tri_is_live(&tri[t])) {
            items[t] = FREE;
            n->second[t] = TRI_NONE;
            continue;
        }
        uint64_t item = key_triangle(n, &last, tri[t].v, t);
        items[t] = item;
        count[tile_after(n, &last, item)]++;
    }
}

static void deal_triangles(void *context, size_t share)
{
    const struct numbering *n = context;
    struct tri_range range = share_of(&n->triangles, share);
    struct tile_range last = {0};
    const uint64_t *items = items_of(n);
    uint64_t *dealt = dealt_items(n);
    int32_t *at = n->triangles.at + share * (size_t)n->n_tiles;
    for (tri_triangle_id t = range.first; t < range.last; t++)
        if (items[t] != FREE)
            dealt[at[tile_after(n, &last, items[t])]++] = items[t] & ~(UINT64_C(1) << STRAY_BIT);
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
        item[i] -= (uint64_t)low << KEY_SHIFT;
    tri_radix_sort(item, scratch, count, KEY_SHIFT, KEY_SHIFT + tri_bits_of(high - low), NULL);
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

/* By the next corner, which is the key here, those that start at one. */
static void sort_fan(uint64_t *item, uint64_t *scratch, int32_t count)
{
    if (count <= FEW)
        insert_items(item, count);
    else
        sort_items(item, scratch, count);
}

static uint64_t by_second(const struct numbering *n, uint64_t item)
{
    return item_of(n->second[id_of(item)], first_of(item), id_of(item));
}

/* A tile that is being sorted. Most of its triangles start at one of its own new vertices: they are sorted by counting.
 * The others come before them. Items go from one array to the other, and back. */
struct sorting {
    uint64_t *item, *sorted;
    int32_t first, count;       /* of the triangles */
    int32_t first_own, n_own;   /* of the vertices */
    int32_t *end;               /* [n_own] of the fan at each */
    int32_t n_others;
};

static bool is_own(const struct sorting *s, uint64_t item)
{
    return (uint32_t)(key_of(item) - s->first_own) < (uint32_t)s->n_own;
}

static void count_fans(struct sorting *s)
{
    memset(s->end, 0, (size_t)s->n_own * sizeof *s->end);
    for (int32_t i = 0; i < s->count; i++)
        if (is_own(s, s->item[i]))
            s->end[key_of(s->item[i]) - s->first_own]++;
        else
            s->n_others++;
    for (int32_t i = 0, sum = s->n_others; i < s->n_own; i++) {
        int32_t count = s->end[i];
        s->end[i] = sum; /* where it begins */
        sum += count;
    }
}

static void fill_fans(const struct numbering *n, struct sorting *s)
{
    int32_t other = 0;
    for (int32_t i = 0; i < s->count; i++)
        if (is_own(s, s->item[i]))
            s->sorted[s->end[key_of(s->item[i]) - s->first_own]++] = by_second(n, s->item[i]);
        else
            s->sorted[other++] = s->item[i];
}

static void sort_others(const struct numbering *n, struct sorting *s)
{
    uint64_t *item = s->sorted;
    if (s->n_others > 0)
        sort_items(item, s->item, s->n_others);
    for (int32_t begin = 0, end; begin < s->n_others; begin = end) {
        int32_t key = key_of(item[begin]);
        for (end = begin; end < s->n_others && key_of(item[end]) == key; end++)
            ;
        for (int32_t i = begin; i < end; i++)
            item[i] = by_second(n, item[i]);
        sort_fan(item + begin, s->item, end - begin);
    }
}

/* The first of four items in their order, without a branch that depends on it; all ones stand for the others. */
static void sort_four(const uint64_t *item, int32_t count, uint64_t *to)
{
    uint64_t a = item[0] | -(uint64_t)(count < 1), b = item[1] | -(uint64_t)(count < 2);
    uint64_t c = item[2] | -(uint64_t)(count < 3), d = item[3] | -(uint64_t)(count < 4);
    uint64_t low = least(a, b), high = most(a, b), low_too = least(c, d), high_too = most(c, d);
    uint64_t second = most(low, low_too), third = least(high, high_too);
    to[0] = least(low, low_too);
    to[1] = least(second, third);
    to[2] = most(second, third);
    to[3] = most(high, high_too);
}

/* Where four are written, fewer may be meant: the next fan overwrites the others. */
static void sort_fans(struct sorting *s)
{
    memcpy(s->item, s->sorted, (size_t)s->n_others * sizeof *s->item);
    for (int32_t i = 0, begin = s->n_others; i < s->n_own; begin = s->end[i++]) {
        int32_t count = s->end[i] - begin;
        if (count <= 4 && begin + 4 <= s->count) {
            sort_four(s->sorted + begin, count, s->item + begin);
            continue;
        }
        sort_fan(s->sorted + begin, s->item + begin, count);
        memcpy(s->item + begin, s->sorted + begin, (size_t)count * sizeof *s->item);
    }
}

static void place_tile(void *context, size_t tile)
{
    const struct numbering *n = context;
    int32_t first = n->triangles.start[tile], own = n->vertices.start[tile], down = 0;
    struct sorting s = {.item = dealt_items(n) + first, .sorted = items_of(n) + first, .first = first,
                        .count = n->triangles.start[tile + 1] - first, .first_own = n->n_kept + own,
                        .n_own = n->vertices.start[tile + 1] - own, .end = n->fan_end + own};
    count_fans(&s);
    fill_fans(n, &s);
    sort_others(n, &s);
    sort_fans(&s);
    for (int32_t i = 0; i < s.count; i++) {
        tri_triangle_id t = id_of(s.item[i]);
        n->place[t] = place_of(first + i, first_of(s.item[i]));
        down += first + i < t;
    }
    n->triangles.at[tile] = down;
}

static void number_triangles(struct numbering *n)
{
    tri_execute(n->executor, n->triangles.shares, key_share, n);
    n->n_tri = add_up_counts(&n->triangles, n->n_tiles);
    tri_execute(n->executor, n->triangles.shares, deal_triangles, n);
    tri_execute(n->executor, (size_t)n->n_tiles, place_tile, n);
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

static const struct tri_triangle *source_of(const struct numbering *n, uint64_t item)
{
    return (item >> ASIDE_BIT ? aside_of(n) : n->mesh->tri) + id_of(item);
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
    return place != TRI_NONE && (m->down ? place >> 2 < m->batch.first : place >> 2 >= m->batch.last);
}

/* Those that come soon are fetched already, so that the memory works on many at once. */
static void gather_batch(void *context, size_t share)
{
    enum { AHEAD = 32 };
    struct move *m = context;
    const struct numbering *n = m->n;
    struct tri_range range = batch_share(m, share);
    struct tri_triangle *to = n->buffer - m->batch.first;
    const uint64_t *item = dealt_items(n);
    int32_t aside = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        aside += stands_here(m, t);
        if (t + AHEAD < range.last)
            __builtin_prefetch(source_of(n, item[t + AHEAD]));
        to[t] = renamed(n, source_of(n, item[t]), first_of(item[t]));
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
            dealt_items(n)[n->place[t] >> 2] = UINT64_C(1) << ASIDE_BIT | item_of(0, n->place[t] & 3, aside++);
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
    assert((size_t)m.n_aside <= n->n_items / 2);
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

static enum tri_status allocate(struct numbering *n, struct tri_error *error)
{
    const struct tri_mesh *mesh = n->mesh;
    size_t vertices = (size_t)(mesh->n_vertices - n->n_kept), subs = (size_t)mesh->n_subs;
    n->n_items = (size_t)(mesh->n_triangles > mesh->n_subs ? mesh->n_triangles : mesh->n_subs);
    size_t for_vertices = vertices * tri_vertex_size(mesh), for_items = 3 * n->n_items * sizeof(uint64_t);
    bool deals = reserve_deal(&n->vertices, mesh->n_vertices - n->n_kept, n->n_tiles);
    deals = reserve_deal(&n->triangles, mesh->n_triangles, n->n_tiles) && deals;
    n->kept_tile = malloc(((size_t)n->n_kept + 1) * sizeof *n->kept_tile);
    n->order = tri_mesh_extra(mesh, (vertices + 1) * sizeof *n->order);
    n->number = tri_mesh_extra(mesh, ((size_t)mesh->n_vertices + 1) * sizeof *n->number);
    n->sub_number = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub_number);
    n->sub = tri_mesh_extra(mesh, (subs + 1) * sizeof *n->sub);
    n->place = tri_mesh_extra(mesh, ((size_t)mesh->n_triangles + 1) * sizeof *n->place);
    n->scratch = tri_mesh_extra(mesh, (for_vertices > for_items ? for_vertices : for_items) +
                                          sizeof(struct tri_triangle));
    n->batch = mesh->n_triangles / BATCHES < BATCH ? mesh->n_triangles / BATCHES + 1 : BATCH;
    n->buffer = tri_mesh_extra(mesh, (size_t)n->batch * sizeof *n->buffer);
    if (deals && n->kept_tile && n->order && n->number && n->sub_number && n->sub && n->place && n->scratch &&
        n->buffer)
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
    tri_mesh_extra_free(n->mesh, n->order); /* before the buffer's pages are asked for */
    n->order = NULL;
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
    tri_mesh_extra_free(n->mesh, n->scratch);
    tri_mesh_extra_free(n->mesh, n->buffer);
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
