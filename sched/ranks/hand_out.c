/* Tiles of a mesh that lies on several ranks. Each counts what it will number, so that all know where they begin; tells
 * the ranks on the right the numbers of those vertices of its own that their triangles have, found again by their
 * places; and hands out its own tiles, as one process would. */
#include "sched/ranks/ranks.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

struct numbered_place {
    struct tri_point at;
    int64_t number;
};

struct handing {
    struct par_ranks *ranks;
    struct par_tiles *tiles;
    const struct tri_mesh *mesh;
    int32_t first_tile, end_tile;  /* of the own columns */
    int32_t first, end;            /* odd columns by number */
    int64_t *in_column;            /* [end - first] new vertices in each */
    bool *needed;                  /* [end - first] somebody asks for numbers in it */
    int32_t *told;                 /* [n_vertices] last rank that is told of this vertex, + 1 */
    int32_t *tile;                 /* [n_vertices] of each */
    struct par_worklist shared;    /* triangles with an own corner, and another left or right of the own columns */
};

static bool is_own(const struct handing *h, int32_t tile) { return tile >= h->first_tile && tile < h->end_tile; }

static int32_t column_of(const struct handing *h, int32_t tile)
{
    return (tile / h->tiles->partition->n_rows - 1) / 2;
}

static int32_t last_tile(const struct handing *h, const int32_t *v, int n)
{
    int32_t last = h->tile[v[0]];
    for (int k = 1; k < n; k++)
        last = h->tile[v[k]] > last ? h->tile[v[k]] : last;
    return last;
}

/* Corners of a triangle in the own tiles. */
static int own_corners(const struct handing *h, const struct tri_triangle *t)
{
    return is_own(h, h->tile[t->v[0]]) + is_own(h, h->tile[t->v[1]]) + is_own(h, h->tile[t->v[2]]);
}

/* Every vertex learns its tile; count[] receives new vertices, triangles and subsegments of the own tiles. False: no
 * memory. */
static bool count_own(struct handing *h, int64_t count[3])
{
    const struct tri_mesh *mesh = h->mesh;
    bool memory = true;
    for (int32_t v = 0; v < mesh->n_vertices; v++) {
        if (mesh->on[v] == TRI_VERTEX_NONE)
            continue;
        int32_t tile = par_block_at(h->tiles->partition, 0, mesh->xy[v]);
        h->tile[v] = tile;
        if (v >= h->tiles->n_kept && is_own(h, tile)) {
            count[0]++;
            h->in_column[column_of(h, tile) - h->first]++;
        }
    }
    for (int32_t t = 0; memory && t < mesh->n_triangles; t++) {
        int own = tri_is_live(&mesh->tri[t]) ? own_corners(h, &mesh->tri[t]) : 0;
        count[1] += own == 3 || (own > 0 && is_own(h, last_tile(h, mesh->tri[t].v, 3)));
        if (own == 1 || own == 2)
            memory = par_worklist_add(&h->shared, t);
    }
    for (int32_t s = 0; s < mesh->n_subs; s++)
        count[2] += mesh->sub[s].v[0] != TRI_NONE && is_own(h, last_tile(h, mesh->sub[s].v, 2));
    return memory;
}

/* Calls for each own new vertex of a triangle that rank p has, too, for the ranks p on the right. */
static bool for_shared(struct handing *h, bool (*visit)(struct handing *h, int32_t v, int p))
{
    bool memory = true;
    for (int32_t s = 0; memory && s < h->shared.n; s++) {
        const struct tri_triangle *triangle = &h->mesh->tri[h->shared.item[s]];
        for (int k = 0; memory && k < 3; k++) {
            int32_t tile = h->tile[triangle->v[k]];
            if (tile < h->end_tile)
                continue;
            int p = par_owner_of_column(h->ranks, column_of(h, tile));
            for (int i = 0; memory && i < 3; i++)
                if (triangle->v[i] >= h->tiles->n_kept && is_own(h, h->tile[triangle->v[i]]))
                    memory = visit(h, triangle->v[i], p);
        }
    }
    return memory;
}

static bool note_need(struct handing *h, int32_t v, int p)
{
    (void)p;
    h->needed[column_of(h, h->tile[v]) - h->first] = true;
    return true;
}

static bool tell_number(struct handing *h, int32_t v, int p)
{
    const struct numbered_place place = {h->mesh->xy[v], h->tiles->number[v]};
    if (h->told[v] == p + 1)
        return true;
    h->told[v] = p + 1;
    return par_bytes_add(&h->ranks->out[p], &place, sizeof place);
}

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the numbers of a rank's vertices");
}

/* Own vertices get their numbers once more, when their column has its turn. */
static void forget_numbers(struct handing *h)
{
    for (int32_t v = h->tiles->n_kept; v < h->mesh->n_vertices; v++)
        if (is_own(h, h->tile[v]))
            par_tiles_forget(h->tiles, v);
}

/* Numbers what others ask for, ahead of its time. */
static enum tri_status number_needed(struct handing *h, int64_t base, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    h->tiles->n_vertices = base;
    for (int32_t i = 0; !status && i < h->end - h->first; i++) {
        int32_t column = 2 * (h->first + i) + 1;
        if (h->needed[i])
            status = par_tiles_number(h->tiles, column, error);
        h->tiles->n_vertices += h->in_column[i];
    }
    return status;
}

static int compare_places(const void *left, const void *right)
{
    const struct tri_point *a = left, *b = right; /* a struct numbered_place begins with its place */
    if (a->x != b->x)
        return a->x < b->x ? -1 : 1;
    return (a->y > b->y) - (a->y < b->y);
}

/* The vertices of own triangles that lie on the left learn their numbers. */
static void take_numbers(struct handing *h, struct par_bytes *told)
{
    size_t n = told->n / sizeof(struct numbered_place);
    if (n == 0)
        return;
    qsort(told->at, n, sizeof(struct numbered_place), compare_places);
    for (int32_t s = 0; s < h->shared.n; s++)
        for (int k = 0; k < 3; k++) {
            int32_t v = h->mesh->tri[h->shared.item[s]].v[k];
            if (v < h->tiles->n_kept || h->tile[v] >= h->first_tile)
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
    status = par_swap(r->carrier, PAR_MOVE_NUMBERS, r->out, r->in, status, error);
    for (int p = 0; p < r->carrier->n_ranks; p++) {
        if (!status)
            take_numbers(h, &r->in[p]);
        free(r->in[p].at);
        r->in[p] = (struct par_bytes){0};
    }
    return status;
}

static enum tri_status number_borders(struct handing *h, int64_t base, struct tri_error *error)
{
    for_shared(h, note_need);
    enum tri_status status = number_needed(h, base, error);
    return status || for_shared(h, tell_number) ? status : no_memory(error);
}

static enum tri_status hand_out(struct handing *h, const int64_t base[3], struct tri_error *error)
{
    struct par_tiles *tiles = h->tiles;
    forget_numbers(h);
    enum tri_status status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    tiles->n_vertices = base[0];
    tiles->n_triangles = base[1];
    tiles->n_segments = base[2];
    for (int32_t i = h->first; !status && i < h->end; i++)
        status = par_tiles_column(tiles, 2 * i + 1, &h->ranks->state->spare, error);
    return status ? status : par_tiles_end(tiles, error);
}

static enum tri_status prepare(struct handing *h, struct tri_error *error)
{
    size_t n = (size_t)(h->end - h->first) + 1;
    int32_t n_rows = h->tiles->partition->n_rows;
    h->first_tile = (2 * h->first + 1) * n_rows;
    h->end_tile = h->first < h->end ? 2 * h->end * n_rows : h->first_tile;
    h->in_column = calloc(n, sizeof *h->in_column);
    h->needed = calloc(n, sizeof *h->needed);
    h->told = calloc((size_t)h->mesh->n_vertices + 1, sizeof *h->told);
    h->tile = malloc(((size_t)h->mesh->n_vertices + 1) * sizeof *h->tile);
    bool memory = h->in_column && h->needed && h->told && h->tile && par_tiles_reserve(h->tiles);
    par_room_mark(&h->ranks->state->spare, h->ranks->state->mesh);
    for (int32_t v = 0; memory && v < h->mesh->n_vertices; v++)
        h->tile[v] = INT32_MAX;
    return memory ? TRI_OK : no_memory(error);
}

/* Where each rank's numbers begin: *first receives three lists of n_ranks + 1. Collective. */
static enum tri_status share_numbers(struct par_carrier *carrier, int32_t n_kept, const int64_t count[3],
                                     int64_t **first, enum tri_status status, struct tri_error *error)
{
    size_t n = (size_t)carrier->n_ranks;
    int64_t *all = malloc(3 * n * sizeof *all);
    *first = calloc(3 * (n + 1), sizeof **first);
    if (!status && !(all && *first))
        status = no_memory(error);
    status = par_gather(carrier, count, 3, all, status, error);
    if (!status)
        all[0] += n_kept; /* vertices of rank 0 */
    for (size_t k = 0; !status && k < 3; k++)
        for (size_t p = 0; p < n; p++)
            (*first)[k * (n + 1) + p + 1] = (*first)[k * (n + 1) + p] + all[3 * p + k];
    free(all);
    return status;
}

static void tell_shares(struct par_tiles *tiles, const struct par_carrier *carrier, const int64_t *first)
{
    tiles->kept_elsewhere = carrier->rank > 0;
    tiles->n_ranks = carrier->n_ranks;
    tiles->rank = carrier->rank;
    for (size_t k = 0; k < 3; k++)
        tiles->first[k] = first + k * ((size_t)carrier->n_ranks + 1);
}

enum tri_status par_whole_on_ranks(const struct par_carrier *carrier, struct par_tiles *tiles, struct tri_error *error)
{
    const int64_t count[3] = {tiles->mesh->n_vertices, tiles->mesh->n_triangles, tiles->mesh->n_subs};
    size_t n = (size_t)carrier->n_ranks + 1;
    int64_t *first = calloc(3 * n, sizeof *first);
    if (!first)
        return no_memory(error);
    for (size_t k = 0; k < 3; k++)
        for (size_t p = 1; p < n; p++)
            first[k * n + p] = count[k];
    tell_shares(tiles, carrier, first);
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
    struct handing h = {.ranks = r, .tiles = tiles, .mesh = r->state->mesh, .first = r->start[rank],
                        .end = r->start[rank + 1]};
    int64_t count[3] = {0}, base[3] = {0}, *first;
    status = status ? status : prepare(&h, error);
    if (!status && !count_own(&h, count))
        status = no_memory(error);
    status = share_numbers(r->carrier, tiles->n_kept, count, &first, status, error);
    if (!status)
        tell_shares(tiles, r->carrier, first);
    for (int k = 0; !status && k < 3; k++)
        base[k] = tiles->first[k][rank] + (k == 0 && rank == 0 ? tiles->n_kept : 0);
    status = status ? status : number_borders(&h, base[0], error);
    status = exchange_numbers(&h, status, error);
    if (!status)
        status = hand_out(&h, base, error);
    free(first);
    free(h.in_column);
    free(h.needed);
    free(h.told);
    free(h.tile);
    free(h.shared.item);
    return par_agree(r->carrier, status, error);
}
