/* Lists of ids; filling the worklist, and ordering it by tile. Triangles are judged in shares, which run as tasks. Bad
 * triangles are gathered in the order of the shares, so the result does not depend on the number of threads. */
#include "sched/schedule/worklist.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/prerefine.h"
#include "sched/schedule/deal.h"
#include "triangle/base/grow.h"
#include "triangle/geometry/hilbert.h"
#include "triangle/refine/census.h"

bool par_ids_grow(struct par_ids *ids)
{
    assert(ids->n >= 0 && ids->n <= ids->capacity);
    return tri_grow(&ids->item, &ids->capacity, ids->n + 1, sizeof *ids->item);
}

bool par_ids_add_all(struct par_ids *ids, const int32_t *more, int32_t n)
{
    if (!tri_grow(&ids->item, &ids->capacity, ids->n + n, sizeof *ids->item))
        return false;
    if (n > 0)
        memcpy(ids->item + ids->n, more, (size_t)n * sizeof *more);
    ids->n += n;
    return true;
}

/* Orders ids in ascending order, for qsort. */
static int ascending(const void *left, const void *right)
{
    const int32_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

int32_t par_sort_unique(int32_t *item, int32_t n)
{
    int32_t kept = 0;
    if (n > 0)
        qsort(item, (size_t)n, sizeof *item, ascending);
    for (int32_t i = 0; i < n; i++)
        if (i == 0 || item[i] != item[kept - 1])
            item[kept++] = item[i];
    return kept;
}

int32_t par_ids_find(const struct par_ids *ids, int32_t id)
{
    int32_t low = 0, high = ids->n;
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (ids->item[middle] < id)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool par_triangle_set_of(struct par_triangle_set *set, const struct par_ids *triangles, int32_t n_triangles)
{
    set->word = calloc((size_t)n_triangles / 64 + 1, sizeof *set->word);
    for (int32_t i = 0; set->word && i < triangles->n; i++) {
        assert(triangles->item[i] >= 0 && triangles->item[i] < n_triangles);
        set->word[triangles->item[i] / 64] |= (uint64_t)1 << triangles->item[i] % 64;
    }
    return set->word;
}

/* Filling the worklist: the common data of its tasks. */
struct finding {
    struct tri_mesh *mesh;      /* the mesh */
    const struct tri_quality *bounds; /* which triangles are bad */
    const struct par_ids *worklist; /* the old worklist, if it is known to be complete for old triangles; NULL: judge
                                       all triangles */
    tri_triangle_id *found;     /* [n_triangles] bad triangles; each share writes from the index of its first triangle
                                   on, which leaves gaps */
    int32_t n[TRI_MOST_SHARES]; /* number of bad triangles of each share */
    double radius2[TRI_MOST_SHARES]; /* square of the largest circumradius of each share */
};

/* Closes the gaps between the bad triangles of the shares. n: number of triangles of the mesh. Returns the number of
 * bad triangles. */
static int32_t close_gaps(const struct finding *f, int32_t n)
{
    int32_t filled = 0;
    for (size_t share = 0; share < tri_shares(n); share++) {
        int32_t first = tri_share(share, n).first;
        assert(f->n[share] <= tri_share(share, n).last - first && filled <= first);
        for (int32_t i = 0; i < f->n[share]; i++)
            f->found[filled++] = f->found[first + i];
    }
    return filled;
}

/* Merges the old worklist entries of the range into found, which holds n new bad triangles. An entry is dropped if its
 * triangle has been replaced since, which its generation number shows. Both lists are ascending, and so is the result.
 * Merging runs from the end, so that it works in place. Returns the new number. */
static int32_t merge_old(const struct finding *f, struct tri_range range, tri_triangle_id *found, int32_t n)
{
    const struct tri_triangle *tri = f->mesh->tri;
    int32_t begin = par_ids_find(f->worklist, range.first), end = par_ids_find(f->worklist, range.last), all = n;
    for (int32_t i = begin; i < end; i++)
        all += tri[f->worklist->item[i]].generation == 0;
    /* Merge from the end, so that no entry is overwritten before it has been moved. */
    for (int32_t i = end - 1, at = all; i >= begin; i--) {
        tri_triangle_id old = f->worklist->item[i];
        assert(i == begin || f->worklist->item[i - 1] < old); /* ascending, without duplicates */
        if (tri[old].generation != 0)
            continue;
        while (n > 0 && found[n - 1] > old)
            found[--at] = found[--n];
        found[--at] = old;
    }
    return all;
}

/* Finds the bad triangles of a range if the old worklist is known. The previous call set the generation number of every
 * triangle to 0, so only triangles with another number are new and must be judged. */
static int32_t find_new_bad(const struct finding *f, struct tri_range range, tri_triangle_id *found)
{
    int32_t n = 0;
    for (tri_triangle_id t = range.first; t < range.last; t++)
        if (f->mesh->tri[t].generation != 0)
            found[n++] = t;
    n = tri_find_work_among(f->mesh, f->bounds, found, n, found);
    return merge_old(f, range, found, n);
}

/* Returns the square of the largest circumradius of n triangles. */
static double largest_radius2(const struct tri_mesh *mesh, const tri_triangle_id *triangle, int32_t n)
{
    double largest = 0;
    for (int32_t i = 0; i < n; i++) {
        const tri_vertex_id *v = mesh->tri[triangle[i]].v;
        double r2 = par_radius2(mesh->xy[v[0]], mesh->xy[v[1]], mesh->xy[v[2]]);
        largest = r2 > largest ? r2 : largest;
    }
    return largest;
}

/* A task: finds the bad triangles of one share of the mesh, and resets its generation numbers. */
static void fill_share(void *context, size_t share)
{
    struct finding *f = context;
    struct tri_range range = tri_share(share, f->mesh->n_triangles);
    tri_triangle_id *found = f->found + range.first;
    f->n[share] = f->worklist ? find_new_bad(f, range, found)
                          : tri_find_work(f->mesh, f->bounds, range.first, range.last, found);
    f->radius2[share] = largest_radius2(f->mesh, found, f->n[share]);
    for (tri_triangle_id t = range.first; t < range.last; t++)
        f->mesh->tri[t].generation = 0;
}

enum tri_status par_worklist_fill(struct par_ids *worklist, struct tri_mesh *mesh,
                                  const struct tri_quality *quality, bool known,
                                  const struct tri_executor *executor, double *radius, struct tri_error *error)
{
    int32_t n = mesh->n_triangles;
    struct finding f = {mesh, quality, known ? worklist : NULL, malloc(((size_t)n + 1) * sizeof *f.found), {0}, {0}};
    double largest2 = 0;
    if (!f.found)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)n);
    /* Each share writes to its own part of f.found; then the gaps between the parts are closed. */
    tri_execute(executor, tri_shares(n), fill_share, &f);
    for (size_t share = 0; share < tri_shares(n); share++)
        largest2 = f.radius2[share] > largest2 ? f.radius2[share] : largest2;
    free(worklist->item);
    *worklist = (struct par_ids){f.found, close_gaps(&f, n), n + 1};
    assert(worklist->n <= n && largest2 >= 0);
    *radius = sqrt(largest2);
    return TRI_OK;
}

/* --- ordering by tile: first a counting sort by tile, then each tile is sorted as a task */

uint64_t par_key_of(const struct par_partition *partition, int round, int phase, int32_t block)
{
    int32_t column = block / partition->n_rows, row = block % partition->n_rows;
    int32_t place = (2 * column + phase % 2) * partition->n_rows + row;
    return (uint64_t)(round + 1) << 56 | (uint64_t)(place + 1) << 32;
}

/* Ordering the worklist by tile: the common data of its tasks. */
struct ordering {
    const struct tri_mesh *mesh; /* the mesh */
    const struct par_partition *tiles; /* the cells, whose blocks of phase 0 are the tiles */
    const struct par_ids *worklist;      /* the list to be ordered */
    int32_t first, end;          /* tiles (blocks of phase 0) whose triangles stay in the list */
    struct par_deal deal;        /* counts and places, for shares and tiles */
    union {
        int32_t *tile_of;        /* [worklist.n] tile - first of each entry; TRI_NONE: it leaves the list */
        int32_t *item;           /* after the deal: sorted indices inside each tile, then the triangles at them */
    };
    int32_t *dealt;              /* [worklist.n] triangles, tile by tile, unsorted */
    struct tri_point *centre;    /* [worklist.n] centres of these triangles */
    uint64_t *key;               /* [worklist.n] the keys of the result */
    uint64_t *room;              /* [2 * worklist.n] scratch memory for sorting */
};

/* Returns the home vertex of a triangle, which decides on its tile (see par_order_by_tile). */
static tri_vertex_id home_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    int obtuse = tri_obtuse_corner(mesh, t);
    return mesh->tri[t].v[obtuse < 0 ? 0 : tri_next[obtuse]];
}

/* A task: finds the tile of each entry of one share, and counts the entries by tile. */
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

/* Returns the centroid. Corners are added in the triangle's order, so rounding is the same on each rank. */
static struct tri_point centre_of(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const struct tri_point *xy = mesh->xy;
    const tri_vertex_id *v = mesh->tri[t].v;
    return (struct tri_point){(xy[v[0]].x + xy[v[1]].x + xy[v[2]].x) / 3, (xy[v[0]].y + xy[v[1]].y + xy[v[2]].y) / 3};
}

/* A task: writes the triangles of one share to their tiles, with their centres. */
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

/* Compares two triangles by the coordinates of their first and second corners, independently of ids. */
static bool is_before(const struct tri_mesh *mesh, tri_triangle_id a, tri_triangle_id b)
{
    const tri_vertex_id *v = mesh->tri[a].v, *w = mesh->tri[b].v;
    int order = tri_compare_places(mesh->xy[v[0]], mesh->xy[w[0]]);
    return order != 0 ? order < 0 : tri_compare_places(mesh->xy[v[1]], mesh->xy[w[1]]) < 0;
}

/* Orders triangles with equal centres, which are neighbours in the list, by their corners. There are seldom more than
 * two, so insertion sort is used. */
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

/* Called for each tile, on any thread: sorts its triangles along a Hilbert curve, and gives them their keys. */
static void sort_tile(const void *context, size_t index, uint64_t *room)
{
    const struct ordering *o = context;
    const int32_t begin = o->deal.start[index], n = o->deal.start[index + 1] - begin;
    const int32_t *dealt = o->dealt + begin;
    int32_t *item = o->item + begin;
    const uint64_t key = par_key_of(o->tiles, PAR_NO_ROUND, 0, o->first + (int32_t)index);
    for (int32_t i = 0; i < n; i++)
        item[i] = i;
    /* Sort indices into the tile along the curve, then replace them by triangles. */
    tri_hilbert_order_coarse(o->centre + begin, item, n, room);
    order_equals(o->mesh, o->centre + begin, dealt, item, n);
    for (int32_t i = 0; i < n; i++) {
        item[i] = dealt[item[i]];
        o->key[begin + i] = key | (uint32_t)i;
    }
}

/* Allocates all lists. False: no memory; the caller frees those that were allocated. */
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

/* Orders the entries. Returns how many stay in the list; TRI_NONE: no memory. */
static int32_t order(struct ordering *o, const struct tri_executor *executor)
{
    if (!make_lists(o))
        return TRI_NONE;
    tri_execute(executor, o->deal.shares, find_tiles, o);
    /* Counts become places; n: entries that stay. */
    int32_t n = par_deal_add_up(&o->deal);
    tri_execute(executor, o->deal.shares, deal_share, o);
    par_deal_work(&o->deal, executor, o->room, sort_tile, o);
    return n;
}

bool par_order_by_tile(struct par_ids *worklist, struct par_keys *key, const struct tri_mesh *mesh,
                       const struct par_partition *tiles, int32_t first, int32_t end,
                       const struct tri_executor *executor)
{
    struct ordering o = {.mesh = mesh, .tiles = tiles, .worklist = worklist, .first = first, .end = end};
    assert(first >= 0 && first <= end);
    const int32_t n = order(&o, executor), capacity = worklist->n + 1;
    free(o.dealt);
    free(o.centre);
    free(o.room);
    par_deal_free(&o.deal);
    /* Out of memory: the worklist stays as it was. */
    if (n == TRI_NONE) {
        free(o.item);
        free(o.key);
        return false;
    }
    free(worklist->item);
    free(key->item);
    *worklist = (struct par_ids){o.item, n, capacity};
    *key = (struct par_keys){o.key, n, capacity};
    return true;
}
