/* INVARIANT: The ring of level k is the ring of level k - 1 without the items of height k. The sentinel is in all
 * rings. */
#include "triangle/base/order.h"

#include <assert.h>
#include <stdlib.h>

/* Number of levels of an item. Each further level has a probability of 1/3. */
static int height(int32_t s)
{
    uint32_t x = (uint32_t)s * 0x9e3779b1u;
    x ^= x >> 15;
    x *= 0x85ebca77u;
    x ^= x >> 13;
    int levels = 1;
    for (; (x & 3) == 0 && levels < TRI_ORDER_LEVELS; x >>= 2)
        levels++;
    return levels;
}

static int32_t *below_of(const struct tri_order *o, int32_t s, int level)
{
    return &o->link[o->first[s] + level].below;
}

static int32_t *above_of(const struct tri_order *o, int32_t s, int level)
{
    return &o->link[o->first[s] + level].above;
}

enum tri_status tri_order_init(struct tri_order *o, int32_t n)
{
    *o = (struct tri_order){.n = n, .first = malloc(((size_t)n + 1) * sizeof *o->first)};
    int64_t n_links = 0;
    for (int32_t s = 0; s < n && o->first != NULL; s++) {
        o->first[s] = n_links;
        n_links += height(s);
    }
    o->link = malloc((size_t)(n_links + TRI_ORDER_LEVELS) * sizeof *o->link);
    if (o->first == NULL || o->link == NULL)
        return TRI_NO_MEMORY;
    o->first[n] = n_links;
    for (int level = 0; level < TRI_ORDER_LEVELS; level++)
        *below_of(o, n, level) = *above_of(o, n, level) = n;
    return TRI_OK;
}

void tri_order_clear(struct tri_order *o)
{
    free(o->first);
    free(o->link);
    *o = (struct tri_order){0};
}

int32_t tri_order_above(const struct tri_order *o, int32_t s)
{
    int32_t above = *above_of(o, s < 0 ? o->n : s, 0);
    return above < o->n ? above : -1;
}

int32_t tri_order_find(const struct tri_order *o, bool (*is_below)(const void *user, int32_t s),
                             const void *user)
{
    int32_t at = o->n;
    for (int level = TRI_ORDER_LEVELS - 1; level >= 0; level--) {
        int32_t above = *above_of(o, at, level);
        for (; above < o->n && is_below(user, above); above = *above_of(o, at, level))
            at = above;
    }
    return at < o->n ? at : -1;
}

void tri_order_insert(struct tri_order *o, int32_t s, int32_t below)
{
    int32_t at = below < 0 ? o->n : below;
    for (int level = 0, top = height(s); level < top; level++) {
        while (at < o->n && height(at) <= level) /* the nearest item below in this ring */
            at = *below_of(o, at, level - 1);
        int32_t above = *above_of(o, at, level);
        *below_of(o, s, level) = at;
        *above_of(o, s, level) = above;
        *above_of(o, at, level) = *below_of(o, above, level) = s;
    }
}

void tri_order_remove(struct tri_order *o, int32_t s)
{
    assert(s >= 0 && s < o->n);
    for (int level = 0, top = height(s); level < top; level++) {
        int32_t below = *below_of(o, s, level), above = *above_of(o, s, level);
        *above_of(o, below, level) = above;
        *below_of(o, above, level) = below;
    }
}
