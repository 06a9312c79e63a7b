/* Tiles of a mesh that lies on several ranks. Each counts what it will number, so that all know where they begin;
 * numbers the vertices of its tiles; tells later ranks the numbers of those that their triangles have, too, found again
 * by their places; and hands out its own tiles, as one process would. */
#include "sched/ranks/ranks.h"
#include "sched/tiles/park.h"
#include "sched/tunables.h"

#include <assert.h>
#include <stdlib.h>

struct numbered_place {
    struct tri_point at;
    int64_t number;
};

struct handing {
    struct par_ranks *ranks;
    struct par_tiles *tiles;
    struct tri_mesh *mesh;
    int32_t first_tile, end_tile;  /* the own tiles, as blocks */
    int32_t first, end;            /* the columns of tiles that have some of them */
    struct par_column **column;    /* [end - first] */
    struct par_map *told;          /* [n_ranks] vertices that a rank has been told of */
};

static int32_t tile_of(const struct handing *h, tri_vertex_id v)
{
    return par_block_at(h->tiles->partition, 0, h->mesh->xy[v]);
}

static bool is_own(const struct handing *h, int32_t tile) { return tile >= h->first_tile && tile < h->end_tile; }

static int32_t last_tile(const struct handing *h, const tri_vertex_id *v, int n)
{
    return par_last_tile(h->tiles->partition, h->mesh, v, n);
}

/* --- counting */

/* All triangles but the straddlers that belong to later tiles. */
static int64_t count_triangles(const struct handing *h)
{
    const struct par_ranks *r = h->ranks;
    int64_t n = h->mesh->n_triangles - par_ranges_unused(&r->run->spare.ranges[PAR_TRIANGLES]);
    for (int32_t i = 0; i < r->straddlers.n; i++)
        n -= !is_own(h, last_tile(h, h->mesh->tri[r->straddlers.item[i]].v, 3));
    assert(n >= 0);
    return n;
}

/* Whoever erased a vertex of the coarse mesh told only of triangles: where none has it, it is no more. */
static void find_erased(struct tri_mesh *mesh)
{
    for (tri_triangle_id t = 0; mesh->has_lengths && t < mesh->n_triangles; t++)
        for (int k = 0; tri_is_live(&mesh->tri[t]) && k < 3; k++)
            mesh->length[mesh->tri[t].v[k]] = fabs(mesh->length[mesh->tri[t].v[k]]);
    for (tri_vertex_id v = 0; mesh->has_lengths && v < mesh->n_vertices; v++)
        if (mesh->length[v] < 0)
            mesh->on[v] = TRI_VERTEX_NONE;
}

/* What belongs to tiles of others is not there, as far as the own ones are concerned; returns how many new vertices
 * there are. */
static int64_t count_vertices(struct handing *h)
{
    struct tri_mesh *mesh = h->mesh;
    struct par_tiles *tiles = h->tiles;
    int64_t n = 0;
    find_erased(mesh);
    for (tri_vertex_id v = 0; v < tiles->n_kept; v++)
        if (tiles->kept_tile[v] >= h->end_tile)
            tiles->kept_tile[v] = INT32_MAX;
    for (tri_vertex_id v = tiles->n_kept; v < mesh->n_vertices; v++) {
        if (mesh->on[v] != TRI_VERTEX_NONE && !par_is_own(&h->ranks->territory, mesh->xy[v]))
            mesh->on[v] = TRI_VERTEX_NONE;
        n += mesh->on[v] != TRI_VERTEX_NONE;
    }
    return n;
}

static int64_t count_subs(struct handing *h)
{
    int64_t n = 0;
    for (tri_sub_id s = 0; s < h->mesh->n_subs; s++) {
        const tri_vertex_id *v = h->mesh->sub[s].v;
        if (v[0] != TRI_NONE && !is_own(h, last_tile(h, v, 2)))
            par_room_mark_sub(h->mesh, s);
        n += v[0] != TRI_NONE;
    }
    return n;
}

/* --- numbers for others */

static bool tell_number(struct handing *h, tri_vertex_id v, int p)
{
    const struct numbered_place place = {h->mesh->xy[v], h->tiles->number[v]};
    assert(place.number >= h->tiles->n_kept && place.number < h->tiles->n_vertices);
    if (par_map_get(&h->told[p], v) != TRI_NONE)
        return true;
    return par_map_put(&h->told[p], v, 0) && par_bytes_add(&h->ranks->out[p], &place, sizeof place);
}

/* Of a straddler's own new vertices to a rank that has it, too, and comes later. */
static bool tell_numbers(struct handing *h, const tri_vertex_id v[3], int p)
{
    bool memory = true;
    for (int k = 0; k < 3; k++)
        if (v[k] >= h->tiles->n_kept && is_own(h, tile_of(h, v[k])))
            memory = memory && tell_number(h, v[k], p);
    return memory;
}

static bool tell_all(struct handing *h)
{
    const struct par_ranks *r = h->ranks;
    bool memory = true;
    for (int32_t i = 0; memory && i < r->straddlers.n; i++) {
        const tri_vertex_id *v = h->mesh->tri[r->straddlers.item[i]].v;
        for (int k = 0; memory && k < 3; k++)
            if (tile_of(h, v[k]) >= h->end_tile)
                memory = tell_numbers(h, v, par_owner_at(&r->territory, h->mesh->xy[v[k]]));
    }
    return memory;
}

static int compare_places(const void *left, const void *right)
{
    const struct tri_point *a = left, *b = right; /* a struct numbered_place begins with its place */
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

static bool are_numbers(const struct handing *h, const struct par_bytes *told)
{
    const struct numbered_place *place = (const struct numbered_place *)(const void *)told->at;
    const struct par_tiles *tiles = h->tiles;
    bool good = told->n % sizeof *place == 0;
    for (size_t i = 0; good && i < told->n / sizeof *place; i++)
        good = place[i].number >= tiles->n_kept && place[i].number < tiles->ranks.first[0][tiles->ranks.n];
    return good;
}

/* The vertices of own triangles that lie in earlier tiles of others learn their numbers. */
static void take_numbers(struct handing *h, struct par_bytes *told)
{
    const struct par_ids *straddlers = &h->ranks->straddlers;
    size_t n = told->n / sizeof(struct numbered_place);
    if (n == 0)
        return;
    qsort(told->at, n, sizeof(struct numbered_place), compare_places);
    for (int32_t i = 0; i < straddlers->n; i++)
        for (int k = 0; k < 3; k++) {
            tri_vertex_id v = h->mesh->tri[straddlers->item[i]].v[k];
            if (v < h->tiles->n_kept || h->mesh->on[v] != TRI_VERTEX_NONE)
                continue;
            const struct numbered_place *found =
                bsearch(&h->mesh->xy[v], told->at, n, sizeof *found, compare_places);
            if (found)
                h->tiles->number[v] = found->number;
        }
}

static enum tri_status exchange_numbers(struct handing *h, enum tri_status status, struct tri_error *error)
{
    struct par_ranks *r = h->ranks;
    if (!status && !tell_all(h))
        status = par_ranks_no_memory(error);
    status = par_swap(r->carrier, PAR_MOVE_NUMBERS, r->out, r->in, status, error);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        if (!status && are_numbers(h, &r->in[p]))
            take_numbers(h, &r->in[p]);
        else if (!status)
            status = tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank tells of vertices that do not exist");
    }
    par_bytes_free(r->in, r->carrier->n_ranks);
    return status;
}

/* --- handing out */

static enum tri_status number_columns(struct handing *h, const int64_t base[3], struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    h->tiles->n_vertices = base[0];
    for (int32_t i = h->first; !status && i < h->end; i++)
        status = par_tiles_number(h->tiles, 2 * i + 1, &h->column[i - h->first], error);
    return status;
}

static enum tri_status hand_out_columns(struct handing *h, const int64_t base[3], struct tri_error *error)
{
    struct par_tiles *tiles = h->tiles;
    enum tri_status status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    tiles->n_triangles = base[1];
    tiles->n_segments = base[2];
    for (int32_t i = h->first; !status && i < h->end; i++) {
        status = par_tiles_hand_out(h->column[i - h->first], &h->ranks->run->spare, error);
        par_column_free(h->column[i - h->first]);
        h->column[i - h->first] = NULL;
    }
    return status ? status : par_tiles_end(tiles, error);
}

static enum tri_status prepare_tiles(struct handing *h, int64_t count[3], struct tri_error *error)
{
    const struct par_territory *territory = &h->ranks->territory;
    int rank = territory->rank;
    h->first = territory->start[rank] / territory->n_rows;
    h->end = territory->start[rank] < territory->start[rank + 1]
                 ? (territory->start[rank + 1] - 1) / territory->n_rows + 1 : h->first;
    h->first_tile = par_first_block(territory, rank);
    h->end_tile = par_first_block(territory, rank + 1);
    assert(h->first <= h->end && h->first_tile <= h->end_tile);
    h->column = calloc((size_t)(h->end - h->first) + 1, sizeof(struct par_column *));
    h->told = calloc((size_t)territory->n_ranks, sizeof *h->told);
    const size_t bytes = par_tiles_bytes(h->tiles) + par_tiles_whole_bytes(h->tiles) +
                         PAR_SINK_BYTES; /* a sink makes its buffers when it begins, which is only now */
    enum tri_status status = par_park_expect(h->ranks->run->park, h->mesh, bytes, error);
    if (status)
        return status;
    par_room_mark(&h->ranks->run->spare, h->mesh, &h->ranks->run->asked.executor);
    if (!h->column || !h->told || !par_tiles_reserve(h->tiles))
        return par_ranks_no_memory(error);
    count[0] = count_vertices(h);
    count[1] = count_triangles(h);
    count[2] = count_subs(h);
    return TRI_OK;
}

static void clean_up(struct handing *h)
{
    for (int32_t i = h->first; h->column && i < h->end; i++)
        par_column_free(h->column[i - h->first]);
    for (int p = 0; h->told && p < h->ranks->carrier->n_ranks; p++)
        par_map_free(&h->told[p]);
    free(h->column);
    free(h->told);
}

/* Where each rank's numbers begin: *first receives three lists of n_ranks + 1. Collective. */
static enum tri_status sum_up(struct par_carrier *carrier, int32_t n_kept, const int64_t count[3],
                              int64_t **first, enum tri_status status, struct tri_error *error)
{
    size_t n = (size_t)carrier->n_ranks;
    int64_t *all = malloc(3 * n * sizeof *all);
    *first = calloc(3 * (n + 1), sizeof **first);
    if (!status && !(all && *first))
        status = par_ranks_no_memory(error);
    status = par_gather(carrier, count, 3, all, status, error);
    if (!status)
        all[0] += n_kept; /* vertices of rank 0 */
    for (size_t k = 0; !status && k < 3; k++)
        for (size_t p = 0; p < n; p++)
            (*first)[k * (n + 1) + p + 1] = (*first)[k * (n + 1) + p] + all[3 * p + k];
    free(all);
    return status;
}

static void tell_first(struct par_tiles *tiles, const struct par_carrier *carrier, const int64_t *first)
{
    tiles->ranks.n = carrier->n_ranks;
    tiles->ranks.rank = carrier->rank;
    for (size_t k = 0; k < 3; k++)
        tiles->ranks.first[k] = first + k * ((size_t)carrier->n_ranks + 1);
}

enum tri_status par_whole_on_ranks(const struct par_carrier *carrier, struct par_tiles *tiles, struct tri_error *error)
{
    const int64_t count[3] = {tiles->mesh->n_vertices, tiles->mesh->n_triangles, tiles->mesh->n_subs};
    size_t n = (size_t)carrier->n_ranks + 1;
    int64_t *first = calloc(3 * n, sizeof *first);
    if (!first)
        return par_ranks_no_memory(error);
    for (size_t k = 0; k < 3; k++)
        for (size_t p = 1; p < n; p++)
            first[k * n + p] = count[k];
    tell_first(tiles, carrier, first);
    enum tri_status status = TRI_OK;
    if (carrier->rank == 0)
        status = par_tiles_whole(tiles, error);
    else
        status = par_tiles_begin(tiles, tiles->mesh->n_triangles, error);
    if (!status && carrier->rank > 0)
        status = par_tiles_end(tiles, error);
    free(first);
    return status;
}

enum tri_status par_hand_out_on_ranks(struct par_ranks *r, struct par_tiles *tiles, enum tri_status status,
                                      struct tri_error *error)
{
    int rank = r->carrier->rank;
    struct handing h = {.ranks = r, .tiles = tiles, .mesh = r->run->mesh};
    int64_t count[3] = {0}, base[3] = {0}, *first;
    status = status ? status : prepare_tiles(&h, count, error);
    status = sum_up(r->carrier, tiles->n_kept, count, &first, status, error);
    if (!status)
        tell_first(tiles, r->carrier, first);
    for (int k = 0; !status && k < 3; k++)
        base[k] = tiles->ranks.first[k][rank] + (k == 0 && rank == 0 ? tiles->n_kept : 0);
    status = status ? status : number_columns(&h, base, error);
    assert(status || tiles->n_vertices == tiles->ranks.first[0][rank + 1]); /* as many as have been counted */
    status = exchange_numbers(&h, status, error);
    if (!status)
        status = hand_out_columns(&h, base, error);
    assert(status || tiles->n_triangles == tiles->ranks.first[1][rank + 1]);
    assert(status || tiles->n_segments == tiles->ranks.first[2][rank + 1]);
    clean_up(&h);
    free(first);
    return par_agree(r->carrier, status, error);
}
