/* Pairs the half-edges of a part: finds the two half-edges of each edge.
 *
 * Half-edges are grouped by the smaller vertex of their edge (counting sort). Each group is sorted by one number,
 * made of the other vertex, direction and half-edge: other vertex << 33 | comes from the other << 32 | half-edge. So
 * the half-edges of one edge are adjacent, in an order that does not depend on the threads, and a search takes O(log
 * n) for any input, also an invalid one. */
#include <stdlib.h>
#include <string.h>

#include "triangle/check/internal.h"

enum { SMALL_GROUP = 24, MOST_RANGES = 4 };

static int32_t lesser(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static uint64_t key_of(int32_t a, int32_t b)
{
    uint64_t other = (uint64_t)(a < b ? b : a);
    return other << 33 | (uint64_t)(a > b) << 32;
}

/* A range of vertices whose half-edges one thread counts. Each thread reads all half-edges; that is cheaper than
 * atomic operations. */
struct range {
    int32_t first, end; /* vertices first .. end - 1 */
};

static bool holds(struct range r, int32_t v)
{
    return v >= r.first && v < r.end;
}

static void count(const struct checker *c, struct range r)
{
    const struct check_part *p = &c->part;
    for (int32_t h = 0; h < p->n_half_edges; h++) {
        int32_t v = lesser(check_org(c, h), check_dest(c, h));
        if (holds(r, v))
            p->entry_of[v + 1]++;
    }
}

static void fill(const struct checker *c, struct range r)
{
    const struct check_part *p = &c->part;
    for (int32_t h = 0; h < p->n_half_edges; h++) {
        int32_t a = check_org(c, h), b = check_dest(c, h);
        if (holds(r, lesser(a, b)))
            p->entry[p->entry_of[lesser(a, b)]++] = key_of(a, b) | (uint64_t)h;
    }
}

struct ranges {
    const struct checker *c;
    void (*look)(const struct checker *c, struct range r); /* called for each range */
    int32_t n;                                             /* number of ranges */
};

static void look_at_range(void *context, size_t i)
{
    const struct ranges *r = context;
    int64_t n = r->c->part.n_points, k = (int64_t)i;
    r->look(r->c, (struct range){(int32_t)(n * k / r->n), (int32_t)(n * (k + 1) / r->n)});
}

static void each_range(const struct checker *c, void (*look)(const struct checker *c, struct range r))
{
    int32_t threads = c->options->n_threads > 0 ? c->options->n_threads : 1;
    struct ranges ranges = {c, look, threads < MOST_RANGES ? threads : MOST_RANGES};
    tri_execute(c->options->executor, (size_t)ranges.n, look_at_range, &ranges);
}

static void group(struct checker *c)
{
    struct check_part *p = &c->part;
    int32_t n = p->n_points;
    each_range(c, count);
    for (int32_t i = 0; i < n; i++)
        p->entry_of[i + 1] += p->entry_of[i];
    /* Filling a group moves its start to its end, which is the start of the next group. Shift the starts back. */
    each_range(c, fill);
    memmove(p->entry_of + 1, p->entry_of, (size_t)n * sizeof *p->entry_of);
    p->entry_of[0] = 0;
}

static int compare_entries(const void *left, const void *right)
{
    uint64_t a = *(const uint64_t *)left, b = *(const uint64_t *)right;
    return (a > b) - (a < b);
}

static void sort_group(uint64_t *entry, int32_t n)
{
    if (n > SMALL_GROUP) {
        qsort(entry, (size_t)n, sizeof *entry, compare_entries);
        return;
    }
    for (int32_t i = 1; i < n; i++) {
        uint64_t e = entry[i];
        int32_t k = i;
        for (; k > 0 && entry[k - 1] > e; k--)
            entry[k] = entry[k - 1];
        entry[k] = e;
    }
}

/* Returns the first entry of the group that is not below the key. */
static int32_t lower_bound(const struct check_part *p, int32_t v, uint64_t key)
{
    int32_t low = p->entry_of[v], high = p->entry_of[v + 1];
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (p->entry[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* The half-edges of a part from one vertex to another, and in the opposite direction. O(log n). */
struct check_edge {
    int32_t there, back;     /* the first in each direction; -1: none */
    int32_t n_there, n_back; /* number in each direction */
};

static struct check_edge find_edge(const struct checker *c, int32_t a, int32_t b)
{
    const struct check_part *p = &c->part;
    int32_t v = lesser(a, b);
    uint64_t there = key_of(a, b), back = key_of(b, a), one = (uint64_t)1 << 32;
    int32_t i = lower_bound(p, v, there), j = lower_bound(p, v, back);
    struct check_edge e = {-1, -1, lower_bound(p, v, there + one) - i, lower_bound(p, v, back + one) - j};
    if (e.n_there > 0)
        e.there = (int32_t)(p->entry[i] & (one - 1));
    if (e.n_back > 0)
        e.back = (int32_t)(p->entry[j] & (one - 1));
    return e;
}

/* Links the half-edges in entries i .. end - 1, which all lie on one edge, if they are exactly two and opposite. */
static void link_edge(struct check_part *p, int32_t i, int32_t end)
{
    int32_t h = (int32_t)(p->entry[i] & 0xffffffffu);
    if (end - i == 2 && (p->entry[i] ^ p->entry[i + 1]) >> 32 == 1) {
        int32_t g = (int32_t)(p->entry[i + 1] & 0xffffffffu);
        p->link[h] = g;
        p->link[g] = h;
        return;
    }
    for (; i < end; i++)
        p->link[p->entry[i] & 0xffffffffu] = -1;
}

static void link_group(struct check_part *p, int32_t v)
{
    int32_t begin = p->entry_of[v], end = p->entry_of[v + 1];
    sort_group(p->entry + begin, end - begin);
    for (int32_t i = begin, next; i < end; i = next) {
        for (next = i + 1; next < end && p->entry[next] >> 33 == p->entry[i] >> 33; next++) {
        }
        link_edge(p, i, next);
    }
}

static void link_groups(void *part, const struct check_share *share)
{
    for (int64_t v = share->first; v < share->end; v++)
        link_group(part, (int32_t)v);
}

static void note_side(struct checker *c, struct check_side *side, int32_t h)
{
    if (h < 0)
        return;
    c->part.constrained[h >> 3] |= (uint8_t)(1u << (h & 7));
    int64_t half_edge = 3 * c->part.first + h;
    if (side->half_edge < 0)
        *side = (struct check_side){half_edge, check_attribute(c, h / 3)};
}

/* Marks the half-edges along listed subsegments. */
static void constrain(struct checker *c)
{
    memset(c->part.constrained, 0, (size_t)c->part.n_half_edges / 8 + 1);
    for (int64_t s = 0; check_is_listed(c) && s < c->source->n_segments; s++) {
        int64_t a = c->listed[2 * s], b = c->listed[2 * s + 1];
        int32_t u = a < 0 ? -1 : tri_check_local(c, a), v = u < 0 ? -1 : tri_check_local(c, b);
        if (v < 0)
            continue;
        struct check_edge e = find_edge(c, u, v);
        note_side(c, &c->sides[s][0], e.there);
        note_side(c, &c->sides[s][1], e.back);
    }
}

enum tri_status tri_check_pair(struct checker *c)
{
    struct check_part *p = &c->part;
    free(p->entry_of);
    p->entry_of = tri_check_zeros((int64_t)p->n_points + 1, sizeof *p->entry_of);
    if (p->entry_of == NULL)
        return TRI_NO_MEMORY;
    group(c);
    tri_check_in_shares(c, p->n_points, link_groups, p);
    constrain(c);
    return TRI_OK;
}

struct check_open tri_check_open(const struct checker *c, int32_t h)
{
    int32_t a = check_org(c, h), b = check_dest(c, h), v = check_apex(c, h);
    return (struct check_open){c->part.vertex[a], c->part.vertex[b], 3 * c->part.first + h, c->part.vertex[v],
                               c->part.neighbors != NULL ? c->part.neighbors[h] : -1, check_attribute(c, h / 3),
                               {check_place(c, a), check_place(c, b), check_place(c, v)}, check_is_constrained(c, h)};
}

enum tri_status tri_check_keep_open(struct checker *c)
{
    enum tri_status status = TRI_OK;
    for (int32_t h = 0; h < c->part.n_half_edges && status == TRI_OK; h++) {
        if (c->part.link[h] < 0)
            status = tri_check_store_add(c, tri_check_open(c, h));
    }
    return status;
}
