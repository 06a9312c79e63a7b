/* A counting sort by tile; then tiles are tasks. */
#include "sched/schedule/by_tile.h"

#include <assert.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tiles/deal.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/refine/census.h"

struct ordering {
    const struct tri_mesh *mesh;
    const struct par_partition *tiles;
    const struct par_ids *worklist;
    int32_t first, end; /* tiles */
    int32_t *tile_of;   /* [worklist.n] TRI_NONE: it leaves */
    struct par_deal deal;
    int32_t *item;      /* [worklist.n] tile by tile */
    uint64_t *key;      /* [worklist.n] */
    atomic_bool lost;   /* no memory */
};

static tri_vertex_id home_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    int obtuse = tri_obtuse_corner(mesh, t);
    return mesh->tri[t].v[obtuse < 0 ? 0 : tri_next[obtuse]];
}

static void find_tiles(void *context, size_t share)
{
    const struct ordering *o = context;
    const struct tri_range range = par_deal_share(&o->deal, share);
    int32_t *count = par_deal_at(&o->deal, share);
    struct par_locator locator = PAR_LOST;
    for (int32_t i = range.first; i < range.last; i++) {
        const tri_triangle_id t = o->worklist->item[i];
        assert(tri_is_live(&o->mesh->tri[t]));
        int32_t tile = par_locate(&locator, o->tiles, 0, o->mesh->xy[home_of(o->mesh, t)]);
        o->tile_of[i] = tile >= o->first && tile < o->end ? tile - o->first : TRI_NONE;
        if (o->tile_of[i] != TRI_NONE)
            count[o->tile_of[i]]++;
    }
}

static void deal_share(void *context, size_t share)
{
    const struct ordering *o = context;
    const struct tri_range range = par_deal_share(&o->deal, share);
    int32_t *at = par_deal_at(&o->deal, share);
    for (int32_t i = range.first; i < range.last; i++)
        if (o->tile_of[i] != TRI_NONE)
            o->item[at[o->tile_of[i]]++] = o->worklist->item[i];
}

static bool is_before(const struct tri_mesh *mesh, tri_triangle_id a, tri_triangle_id b)
{
    const tri_vertex_id *v = mesh->tri[a].v, *w = mesh->tri[b].v;
    int order = tri_compare_places(mesh->xy[v[0]], mesh->xy[w[0]]);
    return order != 0 ? order < 0 : tri_compare_places(mesh->xy[v[1]], mesh->xy[w[1]]) < 0;
}

static struct tri_point centre_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const struct tri_point *xy = mesh->xy;
    const tri_vertex_id *v = mesh->tri[t].v;
    return (struct tri_point){(xy[v[0]].x + xy[v[1]].x + xy[v[2]].x) / 3, (xy[v[0]].y + xy[v[1]].y + xy[v[2]].y) / 3};
}

/* Room to sort n triangles in. */
struct sorting {
    struct tri_point *centre;
    int32_t *order, *sorted;
    uint64_t *scratch;
};

static bool make_room(struct sorting *s, size_t n)
{
    s->centre = malloc(n * sizeof *s->centre);
    s->order = malloc(n * sizeof *s->order);
    s->sorted = malloc(n * sizeof *s->sorted);
    s->scratch = malloc(2 * n * sizeof *s->scratch);
    return s->centre && s->order && s->sorted && s->scratch;
}

static void free_room(struct sorting *s)
{
    free(s->centre);
    free(s->order);
    free(s->sorted);
    free(s->scratch);
}

/* Those of equal centres, which are neighbours, and seldom more than two, by insertion. */
static void put_in_order(const struct sorting *s, const struct tri_mesh *mesh, const int32_t *item, int32_t n)
{
    for (int32_t i = 0; i < n; i++) {
        const tri_triangle_id t = item[s->order[i]];
        const struct tri_point centre = s->centre[s->order[i]];
        int32_t at = i;
        for (; at > 0 && tri_compare_places(s->centre[s->order[at - 1]], centre) == 0 &&
               is_before(mesh, t, s->sorted[at - 1]); at--)
            s->sorted[at] = s->sorted[at - 1];
        s->sorted[at] = t;
    }
}

/* The triangles of a tile. False: no memory. */
static bool sort(const struct tri_mesh *mesh, int32_t *item, size_t n)
{
    struct sorting s;
    bool memory = make_room(&s, n);
    for (size_t i = 0; memory && i < n; i++) {
        s.order[i] = (int32_t)i;
        s.centre[i] = centre_of(mesh, item[i]);
    }
    if (memory) {
        tri_hilbert_order_coarse(s.centre, s.order, (int32_t)n, s.scratch);
        put_in_order(&s, mesh, item, (int32_t)n);
        memcpy(item, s.sorted, n * sizeof *item);
    }
    free_room(&s);
    return memory;
}

static void sort_tile(void *context, size_t index)
{
    struct ordering *o = context;
    const int32_t begin = o->deal.start[index], end = o->deal.start[index + 1];
    if (begin == end)
        return;
    if (!sort(o->mesh, o->item + begin, (size_t)(end - begin)))
        atomic_store(&o->lost, true);
    const uint64_t key = par_key_of(o->tiles, PAR_NO_ROUND, 0, o->first + (int32_t)index);
    for (int32_t i = begin; i < end; i++)
        o->key[i] = key | (uint32_t)(i - begin);
}

static bool make_lists(struct ordering *o)
{
    const size_t n = (size_t)o->worklist->n + 1;
    bool room = par_deal_reserve(&o->deal, o->worklist->n, o->end - o->first);
    o->tile_of = malloc(n * sizeof *o->tile_of);
    o->item = malloc(n * sizeof *o->item);
    o->key = malloc(n * sizeof *o->key);
    return room && o->tile_of && o->item && o->key;
}

/* Returns how many are in order now; TRI_NONE: no memory. */
static int32_t order(struct ordering *o, const struct tri_executor *executor)
{
    if (!make_lists(o))
        return TRI_NONE;
    tri_execute(executor, o->deal.shares, find_tiles, o);
    int32_t n = par_deal_add_up(&o->deal);
    tri_execute(executor, o->deal.shares, deal_share, o);
    tri_execute(executor, (size_t)(o->end - o->first), sort_tile, o);
    return atomic_load(&o->lost) ? TRI_NONE : n;
}

bool par_order_by_tile(struct par_run *state, const struct par_partition *tiles, int32_t first, int32_t end)
{
    struct ordering o = {.mesh = state->mesh, .tiles = tiles, .worklist = &state->worklist, .first = first, .end = end};
    assert(first >= 0 && first <= end);
    const int32_t n = order(&o, &state->executor), capacity = state->worklist.n + 1;
    free(o.tile_of);
    par_deal_free(&o.deal);
    if (n == TRI_NONE) {
        free(o.item);
        free(o.key);
        return false;
    }
    free(state->worklist.item);
    free(state->key.item);
    state->worklist = (struct par_ids){o.item, n, capacity};
    state->key = (struct par_keys){o.key, n, capacity};
    return true;
}
