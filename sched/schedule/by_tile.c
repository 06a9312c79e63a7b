/* A counting sort by tile; then tiles are tasks. */
#include "sched/schedule/by_tile.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/schedule/deal.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/refine/census.h"

struct ordering {
    const struct tri_mesh *mesh;
    const struct par_partition *tiles;
    const struct par_ids *worklist;
    int32_t first, end; /* tiles */
    struct par_deal deal;
    union {
        int32_t *tile_of;     /* [worklist.n] TRI_NONE: it leaves */
        int32_t *item;        /* once all are dealt: places in their tiles, in order, then the triangles there */
    };
    int32_t *dealt;           /* [worklist.n] triangles, tile by tile */
    struct tri_point *centre; /* [worklist.n] of these */
    uint64_t *key;            /* [worklist.n] */
    uint64_t *room;           /* [2 * worklist.n] */
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

static struct tri_point centre_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const struct tri_point *xy = mesh->xy;
    const tri_vertex_id *v = mesh->tri[t].v;
    return (struct tri_point){(xy[v[0]].x + xy[v[1]].x + xy[v[2]].x) / 3, (xy[v[0]].y + xy[v[1]].y + xy[v[2]].y) / 3};
}

static void deal_share(void *context, size_t share)
{
    const struct ordering *o = context;
    const struct tri_range range = par_deal_share(&o->deal, share);
    int32_t *at = par_deal_at(&o->deal, share);
    for (int32_t i = range.first; i < range.last; i++) {
        if (o->tile_of[i] == TRI_NONE)
            continue;
        const int32_t to = at[o->tile_of[i]]++;
        o->dealt[to] = o->worklist->item[i];
        o->centre[to] = centre_of(o->mesh, o->dealt[to]);
    }
}

static bool is_before(const struct tri_mesh *mesh, tri_triangle_id a, tri_triangle_id b)
{
    const tri_vertex_id *v = mesh->tri[a].v, *w = mesh->tri[b].v;
    int order = tri_compare_places(mesh->xy[v[0]], mesh->xy[w[0]]);
    return order != 0 ? order < 0 : tri_compare_places(mesh->xy[v[1]], mesh->xy[w[1]]) < 0;
}

/* Those of equal centres, which are neighbours, and seldom more than two, by insertion. */
static void order_equals(const struct tri_mesh *mesh, const struct tri_point *centre, const int32_t *triangle,
                         int32_t *place, int32_t n)
{
    for (int32_t i = 1; i < n; i++) {
        const int32_t moving = place[i];
        int32_t at = i;
        for (; at > 0 && tri_compare_places(centre[place[at - 1]], centre[moving]) == 0 &&
               is_before(mesh, triangle[moving], triangle[place[at - 1]]); at--)
            place[at] = place[at - 1];
        place[at] = moving;
    }
}

static void sort_tile(const void *context, size_t index, uint64_t *room)
{
    const struct ordering *o = context;
    const int32_t begin = o->deal.start[index], n = o->deal.start[index + 1] - begin;
    const int32_t *dealt = o->dealt + begin;
    int32_t *item = o->item + begin;
    const uint64_t key = par_key_of(o->tiles, PAR_NO_ROUND, 0, o->first + (int32_t)index);
    for (int32_t i = 0; i < n; i++)
        item[i] = i;
    tri_hilbert_order_coarse(o->centre + begin, item, n, room);
    order_equals(o->mesh, o->centre + begin, dealt, item, n);
    for (int32_t i = 0; i < n; i++) {
        item[i] = dealt[item[i]];
        o->key[begin + i] = key | (uint32_t)i;
    }
}

static bool make_lists(struct ordering *o)
{
    const size_t n = (size_t)o->worklist->n + 1;
    bool deals = par_deal_reserve(&o->deal, o->worklist->n, o->end - o->first);
    o->tile_of = malloc(n * sizeof *o->tile_of);
    o->dealt = malloc(n * sizeof *o->dealt);
    o->centre = malloc(n * sizeof *o->centre);
    o->key = malloc(n * sizeof *o->key);
    o->room = malloc(2 * n * sizeof *o->room);
    return deals && o->tile_of && o->dealt && o->centre && o->key && o->room;
}

/* Returns how many are in order now; TRI_NONE: no memory. */
static int32_t order(struct ordering *o, const struct tri_executor *executor)
{
    if (!make_lists(o))
        return TRI_NONE;
    tri_execute(executor, o->deal.shares, find_tiles, o);
    int32_t n = par_deal_add_up(&o->deal);
    tri_execute(executor, o->deal.shares, deal_share, o);
    par_deal_work(&o->deal, executor, o->room, sort_tile, o);
    return n;
}

bool par_order_by_tile(struct par_run *state, const struct par_partition *tiles, int32_t first, int32_t end)
{
    struct ordering o = {.mesh = state->mesh, .tiles = tiles, .worklist = &state->worklist, .first = first, .end = end};
    assert(first >= 0 && first <= end);
    const int32_t n = order(&o, &state->executor), capacity = state->worklist.n + 1;
    free(o.dealt);
    free(o.centre);
    free(o.room);
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
