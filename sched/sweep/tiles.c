/* One column of tiles at a time: find what is in it, number, hand out, let go; in shares or tile by tile, in parallel.
 * Only `take` is called by one thread. */
#include "sched/sweep/tiles.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/sweep/tile_copy.h"
#include "triangle/hilbert.h"
#include "triangle/radix.h"

/* Free ids in runs shorter than this are forgotten; so many tiles are made at once. */
enum { SHORTEST_RUN = 8, BATCH = 4, SHARES = TRI_MOST_SHARES };

/* What one share of the mesh has found, in the order of ids. */
struct finds {
    int32_t *item, *tile;
    int32_t n, capacity;
};

struct column {
    struct par_tiles *tiles;
    int32_t column;
    int32_t first_tile;
    double end;                     /* all triangles left of it are final */
    struct finds vertices[SHARES], triangles[SHARES]; /* of this column */
    struct finds subs[SHARES];
    struct finds straddling[SHARES]; /* triangles that reach beyond it */
    bool no_memory[SHARES];
    int32_t *vertex, *triangle, *sub;     /* ids by tile */
    int32_t *vertex_start, *triangle_start, *sub_start; /* [n_rows + 1] */
    int32_t n_vertices, n_triangles, n_subs;
};

static bool add(struct finds *f, int32_t item, int32_t tile)
{
    if (f->n == f->capacity) {
        int32_t capacity = f->capacity ? 2 * f->capacity : 1024;
        int32_t *fresh = realloc(f->item, (size_t)capacity * sizeof *fresh);
        f->item = fresh ? fresh : f->item;
        int32_t *tiles = fresh ? realloc(f->tile, (size_t)capacity * sizeof *tiles) : NULL;
        f->tile = tiles ? tiles : f->tile;
        if (!tiles)
            return false;
        f->capacity = capacity;
    }
    f->item[f->n] = item;
    f->tile[f->n++] = tile;
    return true;
}

/* Vertices from `first` on learn their tiles, if that is in this column or before. */
static void find_vertices(void *context, size_t share)
{
    struct column *c = context;
    struct par_tiles *tiles = c->tiles;
    const struct tri_mesh *mesh = tiles->mesh;
    struct tri_range range = tri_share_of(share, SHARES, mesh->n_vertices);
    for (int32_t v = range.first; v < range.last; v++) {
        if (tiles->tile[v] != INT32_MAX || mesh->on[v] == TRI_VERTEX_NONE || !(mesh->xy[v].x < c->end))
            continue;
        tiles->tile[v] = par_block_at(tiles->partition, 0, mesh->xy[v]);
        if (v >= tiles->n_kept && !add(&c->vertices[share], v, tiles->tile[v] - c->first_tile))
            c->no_memory[share] = true;
    }
}

static void find_triangles(void *context, size_t share)
{
    struct column *c = context;
    const struct tri_mesh *mesh = c->tiles->mesh;
    const int32_t *tile = c->tiles->tile;
    struct tri_range range = tri_share_of(share, SHARES, mesh->n_triangles);
    for (int32_t t = range.first; t < range.last; t++) {
        const int32_t *v = mesh->tri[t].v;
        if (v[0] == TRI_NONE)
            continue;
        int32_t a = tile[v[0]], b = tile[v[1]], d = tile[v[2]];
        int32_t low = a < b ? a : b, high = a < b ? b : a;
        low = d < low ? d : low;
        high = d > high ? d : high;
        if (low == INT32_MAX || high < c->first_tile)
            continue;
        bool final = high != INT32_MAX;
        if (!add(final ? &c->triangles[share] : &c->straddling[share], t, final ? high - c->first_tile : 0))
            c->no_memory[share] = true;
    }
}

/* What is right of the column is met again later. */
static void find_subs(void *context, size_t share)
{
    struct column *c = context;
    const struct tri_mesh *mesh = c->tiles->mesh;
    struct tri_range range = tri_share_of(share, SHARES, mesh->n_subs);
    for (int32_t s = range.first; s < range.last; s++) {
        const int32_t *v = mesh->sub[s].v;
        if (v[0] == TRI_NONE)
            continue;
        int32_t a = c->tiles->tile[v[0]], b = c->tiles->tile[v[1]], high = a > b ? a : b;
        if (high >= c->first_tile && high != INT32_MAX && !add(&c->subs[share], s, high - c->first_tile))
            c->no_memory[share] = true;
    }
}

/* Finds of all shares by tile: a stable counting sort. */
static bool by_tile(const struct finds found[SHARES], int32_t n_rows, int32_t **item, int32_t **start, int32_t *n)
{
    int32_t sum = 0;
    for (int s = 0; s < SHARES; s++)
        sum += found[s].n;
    *n = sum;
    *item = malloc(((size_t)sum + 1) * sizeof **item);
    *start = calloc((size_t)n_rows + 2, sizeof **start);
    if (!*item || !*start)
        return false;
    for (int s = 0; s < SHARES; s++)
        for (int32_t i = 0; i < found[s].n; i++)
            (*start)[found[s].tile[i] + 2]++;
    for (int32_t r = 0; r < n_rows; r++)
        (*start)[r + 2] += (*start)[r + 1];
    for (int s = 0; s < SHARES; s++)
        for (int32_t i = 0; i < found[s].n; i++)
            (*item)[(*start)[found[s].tile[i] + 1]++] = found[s].item[i];
    return true;
}

bool par_tiles_reserve(struct par_tiles *tiles)
{
    int32_t before = tiles->capacity, now = tiles->mesh->vertex_capacity;
    if (now <= before)
        return true;
    int64_t *number = realloc(tiles->number, (size_t)now * sizeof *number);
    tiles->number = number ? number : tiles->number;
    int32_t *tile = realloc(tiles->tile, (size_t)now * sizeof *tile);
    tiles->tile = tile ? tile : tiles->tile;
    if (!number || !tile)
        return false;
    for (int32_t v = before; v < now; v++) {
        number[v] = v < tiles->n_kept ? v : -1;
        tile[v] = INT32_MAX;
    }
    tiles->capacity = now;
    return true;
}

static bool find_all(struct column *c)
{
    const struct tri_executor *executor = c->tiles->executor;
    int32_t n_rows = c->tiles->partition->n_rows;
    bool memory = par_tiles_reserve(c->tiles);
    if (memory) {
        tri_execute(executor, SHARES, find_vertices, c);
        tri_execute(executor, SHARES, find_triangles, c);
        tri_execute(executor, SHARES, find_subs, c);
    }
    for (int s = 0; s < SHARES; s++)
        memory = memory && !c->no_memory[s];
    return memory && by_tile(c->vertices, n_rows, &c->vertex, &c->vertex_start, &c->n_vertices) &&
           by_tile(c->triangles, n_rows, &c->triangle, &c->triangle_start, &c->n_triangles) &&
           by_tile(c->subs, n_rows, &c->sub, &c->sub_start, &c->n_subs);
}

/* A tile being numbered, and what is handed out of it. */
struct job {
    struct column *column;
    int32_t row;
    struct tri_tile tile;
    struct par_tile_copy copy;
    bool no_memory;
};

static struct tri_tile tile_of(const struct column *c, int32_t r)
{
    const struct par_tiles *tiles = c->tiles;
    int32_t v = c->vertex_start[r], t = c->triangle_start[r], s = c->sub_start[r];
    return (struct tri_tile){.column = c->column, .row = r, .first_vertex = tiles->n_vertices + v,
                             .first_triangle = tiles->n_triangles + t, .first_segment = tiles->n_segments + s,
                             .n_vertices = c->vertex_start[r + 1] - v, .n_triangles = c->triangle_start[r + 1] - t,
                             .n_segments = c->sub_start[r + 1] - s};
}

static void *array(int32_t n, size_t item) { return malloc(((size_t)n + 1) * item); }

/* Vertices get their numbers and are copied out. */
static void number_tile(void *context, size_t index)
{
    struct job *job = (struct job *)context + index;
    struct column *c = job->column;
    const struct tri_mesh *mesh = c->tiles->mesh;
    struct tri_tile *tile = &job->tile;
    *tile = tile_of(c, job->row);
    int32_t n = tile->n_vertices, *order = c->vertex + c->vertex_start[job->row];
    uint64_t *scratch = array(2 * n, sizeof *scratch);
    bool memory = par_tile_copy_reserve(&job->copy, mesh, n, tile->n_triangles, tile->n_segments) && scratch;
    par_tile_copy_show(&job->copy, tile);
    if (memory) {
        tri_hilbert_order_coarse(mesh->xy, order, n, scratch);
        for (int32_t i = 0; i < n; i++) {
            c->tiles->number[order[i]] = tile->first_vertex + i;
            par_tile_copy_vertex(&job->copy, mesh, order[i], i);
        }
    }
    job->no_memory = !memory;
    free(scratch);
}

/* A triangle's corners by number, the largest first. */
static void corners_of(const struct column *c, int32_t t, int64_t corner[3])
{
    const int32_t *v = c->tiles->mesh->tri[t].v;
    const int64_t number[3] = {c->tiles->number[v[0]], c->tiles->number[v[1]], c->tiles->number[v[2]]};
    int first = number[1] > number[0] ? 1 : 0;
    first = number[2] > number[first] ? 2 : first;
    for (int k = 0; k < 3; k++, first = tri_next[first])
        corner[k] = number[first];
    assert(corner[0] >= 0 && corner[1] >= 0 && corner[2] >= 0);
}

struct numbered {
    int64_t corner[3];
    int32_t triangle;
};

static int compare_corners(const void *left, const void *right)
{
    const struct numbered *a = left, *b = right;
    int k = a->corner[0] == b->corner[0];
    return (a->corner[k] > b->corner[k]) - (a->corner[k] < b->corner[k]);
}

enum { INDEX_BITS = 32 };

/* Triangles of a tile with their largest corners as keys, sorted: those numbered in this column, after all others,
 * which are few and have key 0. */
static void sort_keys(const struct column *c, const int32_t *triangle, int32_t n, uint64_t *item)
{
    int bits = 2;
    for (int32_t i = 0; i < n; i++) {
        int64_t corner[3];
        corners_of(c, triangle[i], corner);
        int64_t key = corner[0] - c->tiles->n_vertices + 1;
        item[i] = (uint64_t)(key > 0 ? key : 0) << INDEX_BITS | (uint32_t)i;
    }
    while (c->n_vertices >> (bits - 1))
        bits++;
    if (n > 0)
        tri_radix_sort(item, item + n, n, INDEX_BITS, INDEX_BITS + bits, NULL);
}

/* The triangles of one key in their order. Two mostly. */
static void sort_fan(const struct column *c, const int32_t *triangle, const uint64_t *item, int32_t n,
                     struct numbered *fan)
{
    for (int32_t i = 0; i < n; i++) {
        fan[i].triangle = triangle[(uint32_t)item[i]];
        corners_of(c, fan[i].triangle, fan[i].corner);
    }
    if (n == 2 && compare_corners(&fan[1], &fan[0]) < 0) {
        struct numbered swap = fan[0];
        fan[0] = fan[1];
        fan[1] = swap;
    }
    if (n > 2)
        qsort(fan, (size_t)n, sizeof *fan, compare_corners);
}

static bool sort_tile(struct job *job, const int32_t *triangle, int32_t n)
{
    const struct column *c = job->column;
    uint64_t *item = malloc((2 * (size_t)n + 1) * sizeof *item);
    struct numbered *fan = malloc(((size_t)n + 1) * sizeof *fan);
    bool memory = item && fan;
    if (memory)
        sort_keys(c, triangle, n, item);
    for (int32_t first = 0, end; memory && first < n; first = end) {
        for (end = first + 1; end < n && item[end] >> INDEX_BITS == item[first] >> INDEX_BITS;)
            end++;
        sort_fan(c, triangle, item + first, end - first, fan);
        for (int32_t i = first; i < end; i++) {
            for (int k = 0; k < 3; k++)
                job->copy.corners[i][k] = par_shown(c->tiles->mesh, fan[i - first].corner[k]);
            job->copy.regions[i] = c->tiles->mesh->tri[fan[i - first].triangle].region;
        }
    }
    free(item);
    free(fan);
    return memory;
}

struct numbered_sub {
    int64_t end[2];
    int32_t sub, parent;
};

static int compare_subs(const void *left, const void *right)
{
    const struct numbered_sub *a = left, *b = right;
    if (a->parent != b->parent)
        return a->parent < b->parent ? -1 : 1;
    return (a->end[0] > b->end[0]) - (a->end[0] < b->end[0]);
}

static bool sort_subs(struct job *job, const int32_t *sub, int32_t n)
{
    const struct column *c = job->column;
    const struct tri_mesh *mesh = c->tiles->mesh;
    struct numbered_sub *item = array(n, sizeof *item);
    for (int32_t i = 0; item && i < n; i++) {
        const struct tri_subsegment *s = &mesh->sub[sub[i]];
        item[i] = (struct numbered_sub){{c->tiles->number[s->v[0]], c->tiles->number[s->v[1]]}, sub[i], s->parent};
    }
    if (item && n > 1)
        qsort(item, (size_t)n, sizeof *item, compare_subs);
    for (int32_t i = 0; item && i < n; i++) {
        for (int k = 0; k < 2; k++)
            job->copy.ends[i][k] = par_shown(mesh, item[i].end[k]);
        job->copy.segment_markers[i] = mesh->sub[item[i].sub].marker;
    }
    bool memory = item;
    free(item);
    return memory;
}

static void fill_tile(void *context, size_t index)
{
    struct job *job = (struct job *)context + index;
    const struct column *c = job->column;
    job->no_memory = !sort_tile(job, c->triangle + c->triangle_start[job->row], job->tile.n_triangles) ||
                     !sort_subs(job, c->sub + c->sub_start[job->row], job->tile.n_segments);
}

static bool is_empty(const struct tri_tile *t) { return t->n_vertices + t->n_triangles + t->n_segments == 0; }

/* Some rows at once: all are numbered, before any of their triangles is looked at, since a triangle may have corners in
 * the row below. */
static enum tri_status hand_out(struct column *c, int32_t first, int32_t end, struct tri_error *error)
{
    struct job job[BATCH];
    size_t n = (size_t)(end - first);
    enum tri_status status = TRI_OK;
    bool memory = true;
    for (size_t i = 0; i < n; i++)
        job[i] = (struct job){.column = c, .row = first + (int32_t)i};
    tri_execute(c->tiles->executor, n, number_tile, job);
    for (size_t i = 0; i < n; i++)
        memory = memory && !job[i].no_memory;
    if (memory)
        tri_execute(c->tiles->executor, n, fill_tile, job);
    for (size_t i = 0; i < n; i++)
        memory = memory && !job[i].no_memory;
    if (!memory)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the tiles of a column");
    for (size_t i = 0; i < n; i++) {
        if (!status && !is_empty(&job[i].tile))
            status = c->tiles->sink->take(c->tiles->sink->user, &job[i].tile, error);
        par_tile_copy_free(&job[i].copy);
    }
    return status;
}

/* --- what has been handed out goes */

static bool add_run(struct par_ranges *to, int32_t first, int32_t end)
{
    if (end - first < SHORTEST_RUN)
        return true;
    if (!par_ranges_reserve(to, to->n + to->dealt + 1))
        return false;
    to->item[to->n++] = (struct par_range){first, end};
    return true;
}

/* A list of ids, ascending, as ranges. */
static bool add_runs(struct par_ranges *to, const int32_t *item, int32_t n)
{
    bool memory = true;
    for (int32_t first = 0, end; memory && first < n; first = end) {
        for (end = first + 1; end < n && item[end] == item[end - 1] + 1;)
            end++;
        memory = add_run(to, item[first], item[end - 1] + 1);
    }
    return memory;
}

static bool let_triangles_go(struct column *c, struct par_room *spare)
{
    bool memory = true;
    for (int s = 0; s < SHARES; s++) {
        for (int32_t i = 0; i < c->triangles[s].n; i++)
            c->tiles->mesh->tri[c->triangles[s].item[i]].v[0] = TRI_NONE;
        memory = memory && add_runs(&spare->ranges[PAR_TRIANGLES], c->triangles[s].item, c->triangles[s].n);
    }
    return memory;
}

static bool let_subs_go(struct column *c, struct par_room *spare)
{
    bool memory = true;
    for (int s = 0; s < SHARES; s++) {
        for (int32_t i = 0; i < c->subs[s].n; i++)
            par_room_mark_sub(c->tiles->mesh, c->subs[s].item[i]);
        memory = memory && add_runs(&spare->ranges[PAR_SUBS], c->subs[s].item, c->subs[s].n);
    }
    return memory;
}

static int ascending(const void *left, const void *right)
{
    const int32_t *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

/* Corners of triangles that stay. */
static bool corners_that_stay(const struct column *c, struct par_worklist *stay)
{
    int32_t n = 0;
    for (int s = 0; s < SHARES; s++)
        n += 3 * c->straddling[s].n;
    stay->item = malloc(((size_t)n + 1) * sizeof *stay->item);
    stay->n = 0;
    if (!stay->item)
        return false;
    for (int s = 0; s < SHARES; s++)
        for (int32_t i = 0; i < c->straddling[s].n; i++)
            for (int k = 0; k < 3; k++) {
                int32_t v = c->tiles->mesh->tri[c->straddling[s].item[i]].v[k];
                if (v >= c->tiles->n_kept && c->tiles->number[v] >= 0)
                    stay->item[stay->n++] = v;
            }
    qsort(stay->item, (size_t)stay->n, sizeof *stay->item, ascending);
    int32_t kept = 0;
    for (int32_t i = 0; i < stay->n; i++)
        if (i == 0 || stay->item[i] != stay->item[kept - 1])
            stay->item[kept++] = stay->item[i];
    stay->n = kept;
    return true;
}

static void let_vertex_go(struct column *c, int32_t v)
{
    c->tiles->mesh->on[v] = TRI_VERTEX_NONE;
    c->tiles->number[v] = -1;
    c->tiles->tile[v] = INT32_MAX;
}

/* Of a list, ascending, those that do not stay; in place. */
static int32_t leaving(int32_t *item, int32_t n, const struct par_worklist *stay)
{
    int32_t left = 0;
    for (int32_t i = 0, k = 0; i < n; i++) {
        while (k < stay->n && stay->item[k] < item[i])
            k++;
        if (k == stay->n || stay->item[k] != item[i])
            item[left++] = item[i];
    }
    return left;
}

static bool let_vertices_go(struct column *c, struct par_room *spare)
{
    struct par_worklist stay;
    bool memory = corners_that_stay(c, &stay);
    for (int s = 0; s <= SHARES && memory; s++) {
        int32_t *item = s < SHARES ? c->vertices[s].item : c->tiles->held.item;
        int32_t n = leaving(item, s < SHARES ? c->vertices[s].n : c->tiles->held.n, &stay);
        for (int32_t i = 0; i < n; i++)
            let_vertex_go(c, item[i]);
        memory = add_runs(&spare->ranges[PAR_VERTICES], item, n);
    }
    free(c->tiles->held.item);
    c->tiles->held = stay;
    return memory;
}

static void free_column(struct column *c)
{
    for (int s = 0; s < SHARES; s++) {
        struct finds *all[4] = {&c->vertices[s], &c->triangles[s], &c->subs[s], &c->straddling[s]};
        for (int k = 0; k < 4; k++) {
            free(all[k]->item);
            free(all[k]->tile);
        }
    }
    free(c->vertex);
    free(c->triangle);
    free(c->sub);
    free(c->vertex_start);
    free(c->triangle_start);
    free(c->sub_start);
}

/* --- a column */

enum tri_status par_tiles_number(struct par_tiles *tiles, int32_t column, struct tri_error *error)
{
    struct column *c = calloc(1, sizeof *c);
    bool memory = c && par_tiles_reserve(tiles);
    if (memory) {
        *c = (struct column){.tiles = tiles, .column = column, .first_tile = column * tiles->partition->n_rows,
                             .end = par_fence(tiles->partition, column, 0).x_max};
        memory = find_all(c);
    }
    for (int32_t row = 0; memory && row < tiles->partition->n_rows; row++) {
        struct job job = {.column = c, .row = row};
        number_tile(&job, 0);
        memory = !job.no_memory;
        par_tile_copy_free(&job.copy);
    }
    for (int32_t v = 0; memory && v < tiles->mesh->n_vertices; v++)
        tiles->tile[v] = tiles->tile[v] >= c->first_tile ? INT32_MAX : tiles->tile[v];
    if (c)
        free_column(c);
    free(c);
    return memory ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the numbers of a column");
}

enum tri_status par_tiles_column(struct par_tiles *tiles, int32_t column, bool let_go, struct par_room *spare,
                                 struct tri_error *error)
{
    struct column *c = calloc(1, sizeof *c);
    enum tri_status status = TRI_OK;
    if (!c)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a column of tiles");
    assert(column % 2 == 1 && column < tiles->partition->n_columns);
    c->tiles = tiles;
    c->column = column;
    c->first_tile = column * tiles->partition->n_rows;
    c->end = par_fence(tiles->partition, column, 0).x_max;
    par_room_mark(spare, tiles->mesh);
    if (!find_all(c))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a column of tiles");
    for (int32_t row = 0; !status && row < tiles->partition->n_rows; row += BATCH) {
        int32_t end = row + BATCH < tiles->partition->n_rows ? row + BATCH : tiles->partition->n_rows;
        status = hand_out(c, row, end, error);
    }
    if (!status && let_go && !(let_triangles_go(c, spare) && let_vertices_go(c, spare) && let_subs_go(c, spare)))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the ranges of a column");
    tiles->n_vertices += c->n_vertices;
    tiles->n_triangles += c->n_triangles;
    tiles->n_segments += c->n_subs;
    free_column(c);
    free(c);
    return status;
}

void par_tiles_free(struct par_tiles *tiles)
{
    free(tiles->number);
    free(tiles->tile);
    free(tiles->held.item);
    tiles->number = NULL;
    tiles->tile = NULL;
    tiles->held = (struct par_worklist){0};
}
