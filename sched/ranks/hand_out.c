/* Hands out the tiles of a mesh that is distributed over ranks, in four steps:
 *
 * 1. Each rank counts the vertices, triangles and segments of its tiles. The sums over the lower ranks are the first
 *    numbers of each rank.
 * 2. Each rank numbers the vertices of its tiles.
 * 3. A triangle belongs to the last tile of its corners, so its other corners may belong to lower ranks. These ranks
 *    send the numbers of such vertices. The receiver finds the vertices by their coordinates.
 * 4. Each rank hands out its own tiles, with the same content as in a run with one process.
 *
 * Functions are not collective unless their comment says so. */
#include "sched/ranks/ranks.h"
#include "sched/tiles/park.h"
#include "sched/tunables.h"

#include <assert.h>
#include <stdlib.h>

struct numbered_place { /* a vertex in messages between ranks */
    struct tri_point at; /* its coordinates */
    int64_t number;      /* its number in the output */
};

struct handing {
    struct par_ranks *ranks;       /* this rank */
    struct par_tiles *tiles;       /* the stream of its tiles */
    struct tri_mesh *mesh;         /* its part of the mesh */
    int32_t first_tile, end_tile;  /* its tiles, as blocks of phase 0: from first_tile to before end_tile */
    int32_t first, end;            /* columns of tiles with at least one of its tiles: first .. end - 1 */
    struct par_column **column;    /* [end - first] numbered columns; NULL: not numbered yet, or handed out */
    struct par_map *told;          /* [n_ranks] ids of the vertices whose numbers were added to the message to a rank */
};

/* Returns the tile that contains v, as a block of phase 0. */
static int32_t tile_of(const struct handing *h, tri_vertex_id v)
{
    return par_block_at(h->tiles->partition, 0, h->mesh->xy[v]);
}

static bool is_own(const struct handing *h, int32_t tile) { return tile >= h->first_tile && tile < h->end_tile; }

/* Returns the last tile that contains one of n vertices, to which their triangle or subsegment belongs. */
static int32_t last_tile(const struct handing *h, const tri_vertex_id *v, int n)
{
    return par_last_tile(h->tiles->partition, h->mesh, v, n);
}

/* --- counting */

/* Returns the number of triangles that this rank hands out: all that it holds, except straddlers that belong to tiles
 * of other ranks. */
static int64_t count_triangles(const struct handing *h)
{
    const struct par_ranks *r = h->ranks;
    int64_t n = h->mesh->n_triangles - par_ranges_unused(&r->run->spare.ranges[PAR_TRIANGLES]);
    for (int32_t i = 0; i < r->straddlers.n; i++)
        n -= !is_own(h, last_tile(h, h->mesh->tri[r->straddlers.item[i]].v, 3));
    assert(n >= 0);
    return n;
}

/* Marks vertices of the coarse mesh as free if they are a corner of no triangle that this rank holds: they have been
 * erased, or lie in tiles of other ranks. A rank that erases a vertex sends only the changed triangles, so the other
 * ranks find out here. Coarse vertices are those with a negative length. */
static void find_erased(struct tri_mesh *mesh)
{
    for (tri_triangle_id t = 0; mesh->has_lengths && t < mesh->n_triangles; t++)
        for (int k = 0; tri_is_live(&mesh->tri[t]) && k < 3; k++)
            mesh->length[mesh->tri[t].v[k]] = fabs(mesh->length[mesh->tri[t].v[k]]);
    for (tri_vertex_id v = 0; mesh->has_lengths && v < mesh->n_vertices; v++)
        if (mesh->length[v] < 0)
            mesh->on[v] = TRI_VERTEX_NONE;
}

/* Marks vertices in tiles of other ranks as free, so that this rank does not number them. Returns the number of new
 * vertices in this rank's tiles. */
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

/* Marks subsegments that belong to tiles of other ranks as free. Returns the number of the remaining ones. */
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

/* --- exchange of vertex numbers */

/* Adds a vertex and its number to the message to rank p, unless the message contains it. False: no memory. */
static bool add_number(struct handing *h, tri_vertex_id v, int p)
{
    const struct numbered_place place = {h->mesh->xy[v], h->tiles->number[v]};
    assert(place.number >= h->tiles->n_kept && place.number < h->tiles->n_vertices);
    if (par_map_get(&h->told[p], v) != TRI_NONE)
        return true;
    return par_map_put(&h->told[p], v, 0) && par_bytes_add(&h->ranks->out[p], &place, sizeof place);
}

/* Adds those corners v of a straddler that are new vertices in this rank's tiles to the message to rank p, which is
 * higher and also holds the straddler. False: no memory. */
static bool add_own_corners(struct handing *h, const tri_vertex_id v[3], int p)
{
    bool memory = true;
    for (int k = 0; k < 3; k++)
        if (v[k] >= h->tiles->n_kept && is_own(h, tile_of(h, v[k])))
            memory = memory && add_number(h, v[k], p);
    return memory;
}

/* Fills out[p] for all higher ranks p. False: no memory. */
static bool tell_all(struct handing *h)
{
    const struct par_ranks *r = h->ranks;
    bool memory = true;
    for (int32_t i = 0; memory && i < r->straddlers.n; i++) {
        const tri_vertex_id *v = h->mesh->tri[r->straddlers.item[i]].v;
        for (int k = 0; memory && k < 3; k++)
            if (tile_of(h, v[k]) >= h->end_tile)
                memory = add_own_corners(h, v, par_owner_at(&r->territory, h->mesh->xy[v[k]]));
    }
    return memory;
}

static int compare_places(const void *left, const void *right)
{
    const struct tri_point *a = left, *b = right; /* the first member of a struct numbered_place is a point */
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

/* Is a received message a list of valid vertex numbers? */
static bool are_numbers(const struct handing *h, const struct par_bytes *told)
{
    const struct numbered_place *place = (const struct numbered_place *)(const void *)told->at;
    const struct par_tiles *tiles = h->tiles;
    bool good = told->n % sizeof *place == 0;
    for (size_t i = 0; good && i < told->n / sizeof *place; i++)
        good = place[i].number >= tiles->n_kept && place[i].number < tiles->ranks.first[0][tiles->ranks.n];
    return good;
}

/* Stores received numbers for those corners of straddlers that lie in tiles of other ranks. Sorts the message. */
static void store_numbers(struct handing *h, struct par_bytes *told)
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

/* Collective: sends the numbers of this rank's vertices to higher ranks and stores the numbers that lower ranks send.
 * */
static enum tri_status exchange_numbers(struct handing *h, enum tri_status status, struct tri_error *error)
{
    struct par_ranks *r = h->ranks;
    if (!status && !tell_all(h))
        status = par_ranks_no_memory(error);
    status = par_swap(r->carrier, PAR_MOVE_NUMBERS, r->out, r->in, status, error);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        if (!status && are_numbers(h, &r->in[p]))
            store_numbers(h, &r->in[p]);
        else if (!status)
            status = tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank has sent invalid vertex numbers");
    }
    par_bytes_free(r->in, r->carrier->n_ranks);
    return status;
}

/* --- handing out */

/* Numbers the vertices of this rank's tiles, starting with base[0]. */
static enum tri_status number_columns(struct handing *h, const int64_t base[3], struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    h->tiles->n_vertices = base[0];
    for (int32_t i = h->first; !status && i < h->end; i++)
        status = par_tiles_number(h->tiles, 2 * i + 1, &h->column[i - h->first], error);
    return status;
}

/* Passes this rank's tiles to its sink. base[1], base[2]: the first numbers of its triangles and segments. */
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

/* Initialises the struct, marks unused ids and counts: count[] receives the numbers of vertices, triangles and segments
 * in this rank's tiles. */
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
                         PAR_SINK_BYTES; /* the sink allocates its buffers when it begins, which is later than this */
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

/* Collective: computes the first numbers of each rank from the counts of all ranks. *first receives three arrays of
 * n_ranks + 1 numbers, for vertices, triangles and segments; the caller frees it, also after an error. */
static enum tri_status compute_first_numbers(struct par_carrier *carrier, int32_t n_kept, const int64_t count[3],
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

/* Passes the arrays that compute_first_numbers has made to the stream. They are borrowed. */
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
    status = compute_first_numbers(r->carrier, tiles->n_kept, count, &first, status, error);
    if (!status)
        tell_first(tiles, r->carrier, first);
    for (int k = 0; !status && k < 3; k++)
        base[k] = tiles->ranks.first[k][rank] + (k == 0 && rank == 0 ? tiles->n_kept : 0);
    status = status ? status : number_columns(&h, base, error);
    assert(status || tiles->n_vertices == tiles->ranks.first[0][rank + 1]); /* equals the count */
    status = exchange_numbers(&h, status, error);
    if (!status)
        status = hand_out_columns(&h, base, error);
    assert(status || tiles->n_triangles == tiles->ranks.first[1][rank + 1]);
    assert(status || tiles->n_segments == tiles->ranks.first[2][rank + 1]);
    clean_up(&h);
    free(first);
    return par_agree(r->carrier, status, error);
}
