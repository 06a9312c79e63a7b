/* The new order of triangles: tile by tile, in each by their corners' new numbers.
 *
 * A key is the largest number of a triangle's corners, with that corner. A key says, too, that the triangle is *stray*:
 * its tile is another than that of its first corner. What belongs to a tile is found by one counting sort; its
 * triangles then fit the cache, and tiles are tasks. */
#include "sched/tiles/renumber.h"

#include <string.h>

#include "sched/tunables.h"
#include "triangle/base/radix.h"

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

void par_sort_triangles(struct par_numbering *n)
{
    tri_execute(n->executor, n->triangles.shares, key_share, n);
    n->n_tri = par_deal_add_up(&n->triangles);
    tri_execute(n->executor, n->triangles.shares, deal_triangles, n);
    par_deal_work(&n->triangles, n->executor, items_of(n), place_tile, n);
}

size_t par_sort_triangles_scratch(const struct tri_mesh *mesh)
{
    const size_t two_items = 2 * sizeof(uint64_t);
    return (size_t)mesh->n_triangles * (sizeof(int32_t) + two_items) + two_items;
}
