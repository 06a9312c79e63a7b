/* Edges: which half-edges are the two sides of one edge, and whether each has one other side at most.
 *
 * Half-edges are grouped by the lesser vertex of their edge (counting sort), each group sorted by the other vertex,
 * direction and name, in one number: other vertex << 33 | comes from the other << 32 | half-edge. What belongs to one
 * edge stands side by side then, in the same order whatever threads put it there, and a search takes O(log n), whatever
 * heap of triangles this may be. */
#include <assert.h>
#include <stdlib.h>

#include "triangle/check/internal.h"

enum { BAD = -2, SMALL_GROUP = 24 };

static int32_t lesser(int32_t a, int32_t b)
{
    return a < b ? a : b;
}

static uint64_t key_of(int32_t a, int32_t b)
{
    uint64_t other = (uint64_t)(a < b ? b : a);
    return other << 33 | (uint64_t)(a > b) << 32;
}

static void group(struct checker *c)
{
    int32_t n = c->mesh->n_points;
#pragma omp parallel for schedule(static)
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        int32_t v = lesser(check_org(c, h), check_dest(c, h));
#pragma omp atomic
        c->first[v + 1]++;
#pragma omp atomic write
        c->used[check_apex(c, h)] = 1;
    }
    for (int32_t i = 0; i < n; i++)
        c->first[i + 1] += c->first[i];
        /* While a group is filled its start moves to its end, which is the start of the next one: shift them back. */
#pragma omp parallel for schedule(static)
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        int32_t a = check_org(c, h), b = check_dest(c, h), at, *end = &c->first[lesser(a, b)];
#pragma omp atomic capture
        at = (*end)++;
        c->entry[at] = key_of(a, b) | (uint64_t)h;
    }
    for (int32_t i = n; i > 0; i--)
        c->first[i] = c->first[i - 1];
    c->first[0] = 0;
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

/* First entry of the group that is not below the key. */
static int32_t lower_bound(const struct checker *c, int32_t v, uint64_t key)
{
    int32_t low = c->first[v], high = c->first[v + 1];
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (c->entry[middle] < key)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

struct check_edge tri_check_find_edge(const struct checker *c, int32_t a, int32_t b)
{
    int32_t v = lesser(a, b);
    uint64_t there = key_of(a, b), back = key_of(b, a), one = (uint64_t)1 << 32;
    int32_t i = lower_bound(c, v, there), j = lower_bound(c, v, back);
    struct check_edge e = {-1, -1, lower_bound(c, v, there + one) - i, lower_bound(c, v, back + one) - j};
    if (e.n_there > 0)
        e.there = (int32_t)(c->entry[i] & (one - 1));
    if (e.n_back > 0)
        e.back = (int32_t)(c->entry[j] & (one - 1));
    return e;
}

/* Links the half-edges of one edge, which are entries i .. end - 1. */
static void link_edge(struct checker *c, int32_t i, int32_t end)
{
    int32_t h = (int32_t)(c->entry[i] & 0xffffffffu), n = end - i;
    bool two = n == 2 && (c->entry[i] ^ c->entry[i + 1]) >> 32 == 1;
    if (n == 1) {
        c->link[h] = -1;
    } else if (two) {
        int32_t g = (int32_t)(c->entry[i + 1] & 0xffffffffu);
        c->link[h] = g;
        c->link[g] = h;
    }
    for (; n > 1 && !two && i < end; i++)
        c->link[c->entry[i] & 0xffffffffu] = BAD;
}

static void link_group(struct checker *c, int32_t v)
{
    int32_t begin = c->first[v], end = c->first[v + 1];
    sort_group(c->entry + begin, end - begin);
    for (int32_t i = begin, next; i < end; i = next) {
        for (next = i + 1; next < end && c->entry[next] >> 33 == c->entry[i] >> 33; next++) {
        }
        link_edge(c, i, next);
    }
}

static bool is_bad(const struct checker *c, int32_t h)
{
    return c->link[h] == BAD;
}

static void tell_bad(struct checker *c, int32_t h)
{
    int32_t a = check_org(c, h), b = check_dest(c, h);
    struct check_edge e = tri_check_find_edge(c, a, b);
    tri_check_fault(c, TRI_CHECK_EDGES, "%ld triangles lie on the %s side of edge %ld-%ld of triangle %ld",
                    (long)(e.n_there > 1 ? e.n_there : e.n_back), e.n_there > 1 ? "same" : "other", check_number(c, a),
                    check_number(c, b), check_number(c, h / 3));
}

static int32_t neighbor(const struct checker *c, int32_t h)
{
    return c->link[h] < 0 ? -1 : c->link[h] / 3;
}

static bool is_other_neighbor(const struct checker *c, int32_t h)
{
    return c->mesh->neighbors[h] != neighbor(c, h);
}

static void tell_neighbor(struct checker *c, int32_t h)
{
    int32_t given = c->mesh->neighbors[h], expected = neighbor(c, h);
    tri_check_fault(c, TRI_CHECK_NEIGHBORS, "triangle %ld: neighbor across edge %ld-%ld is given as %ld, but is %ld",
                    check_number(c, h / 3), check_number(c, check_org(c, h)), check_number(c, check_dest(c, h)),
                    given < 0 ? -1L : check_number(c, given), expected < 0 ? -1L : check_number(c, expected));
}

static void count(struct checker *c)
{
    int64_t n_boundary = 0, n_used = 0;
#pragma omp parallel for schedule(static) reduction(+ : n_boundary)
    for (int32_t h = 0; h < c->n_half_edges; h++) {
        if (c->link[h] < 0)
            c->link[h] = -1, n_boundary++;
    }
#pragma omp parallel for schedule(static) reduction(+ : n_used)
    for (int32_t v = 0; v < c->mesh->n_points; v++)
        n_used += check_is_used(c, v);
    c->report->n_boundary_edges = n_boundary;
    c->report->n_edges = ((int64_t)c->n_half_edges + n_boundary) / 2;
    c->report->n_used_points = n_used;
}

enum tri_status tri_check_edges(struct checker *c)
{
    int32_t n = c->mesh->n_points;
    c->first = tri_check_zeros((int64_t)n + 1, sizeof *c->first);
    c->entry = tri_check_array(c->n_half_edges, sizeof *c->entry);
    c->link = tri_check_array(c->n_half_edges, sizeof *c->link);
    c->used = tri_check_zeros(n, 1);
    if (c->first == NULL || c->entry == NULL || c->link == NULL || c->used == NULL)
        return TRI_NO_MEMORY;
    group(c);
#pragma omp parallel for schedule(dynamic, 4096)
    for (int32_t v = 0; v < n; v++)
        link_group(c, v);
    tri_check_each(c, TRI_CHECK_EDGES, c->n_half_edges, is_bad, tell_bad);
    count(c);
    if (c->mesh->neighbors != NULL && check_good(c, TRI_CHECK_EDGES))
        tri_check_each(c, TRI_CHECK_NEIGHBORS, c->n_half_edges, is_other_neighbor, tell_neighbor);
    return TRI_OK;
}
