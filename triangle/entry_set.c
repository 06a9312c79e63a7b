/* Linear probing from a multiplicative hash. A triangle's entry is replaced by a later one. */
#include "triangle/entry_set.h"

#include <assert.h>
#include <stdlib.h>

enum { FEWEST_BITS = 10 };

static const struct tri_entry FREE = {TRI_NONE, 0};

/* Where the triangle is, or would be put. */
static struct tri_entry *find(const struct tri_entry_set *set, tri_triangle_id t)
{
    const uint32_t mask = (1u << set->bits) - 1;
    assert(set->slot && t >= 0);
    uint32_t i = (uint32_t)t * 0x9E3779B1u >> (32 - set->bits);
    while (set->slot[i].t != t && set->slot[i].t != TRI_NONE)
        i = (i + 1) & mask;
    return &set->slot[i];
}

static bool make_set(struct tri_entry_set *set, int bits)
{
    *set = (struct tri_entry_set){malloc(sizeof *set->slot << bits), 0, bits};
    for (uint32_t i = 0; set->slot && i < 1u << bits; i++)
        set->slot[i] = FREE;
    return set->slot;
}

static bool enlarge(struct tri_entry_set *set)
{
    struct tri_entry_set larger;
    if (!make_set(&larger, set->slot ? set->bits + 1 : FEWEST_BITS))
        return false;
    for (uint32_t i = 0; set->slot && i < 1u << set->bits; i++)
        if (set->slot[i].t != TRI_NONE)
            *find(&larger, set->slot[i].t) = set->slot[i];
    larger.n = set->n;
    free(set->slot);
    *set = larger;
    return true;
}

bool tri_entry_set_add(struct tri_entry_set *set, struct tri_entry entry)
{
    if ((!set->slot || set->n >= 1 << (set->bits - 1)) && !enlarge(set))
        return false;
    struct tri_entry *slot = find(set, entry.t);
    set->n += slot->t == TRI_NONE;
    *slot = entry;
    return true;
}

bool tri_entry_set_holds(const struct tri_entry_set *set, struct tri_entry entry)
{
    if (set->n == 0)
        return false;
    const struct tri_entry *slot = find(set, entry.t);
    return slot->t == entry.t && slot->life == entry.life;
}

void tri_entry_set_free(struct tri_entry_set *set)
{
    free(set->slot);
    *set = (struct tri_entry_set){0};
}
