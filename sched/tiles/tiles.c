/* Hands out one column of tiles at a time: finds and numbers its vertices, finds its triangles and subsegments, fills
 * the tiles, passes them to the sink, and removes them from the mesh. All steps except the call of the sink run in
 * parallel, by shares of the mesh or by tiles.
 *
 * The record of a final triangle is overwritten with the numbers of its corners. These numbers are scattered in memory,
 * and are then read only once. */
#include "sched/tiles/tiles.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/tiles/finds.h"
#include "sched/tiles/pipeline.h"
#include "sched/tiles/tile_arrays.h"
#include "sched/tunables.h"
#include "triangle/base/grow.h"
#include "triangle/geometry/hilbert.h"

/* Values in place of a row: the item belongs to an earlier or to a later column. */
enum { EARLIER = -1, LATER = -2 };

enum { NO_NUMBER = -1 };

struct par_column {
    struct par_tiles *tiles;        /* the tiles of the mesh */
    int32_t column;                 /* column of blocks, odd */
    int32_t first_tile;             /* index of the column's first tile: column * n_rows */
    int64_t first_vertex;           /* number of the first vertex in the column */
    double begin, end;              /* x range of the column; all triangles left of `end` are final */
    struct par_finds vertices, triangles, subs; /* the ids that belong to the column */
    struct par_ids later_triangles[PAR_FIND_SHARES]; /* triangles of later columns that have a numbered corner */
    bool no_memory[PAR_FIND_SHARES]; /* an allocation failed in this share */
    bool is_list_freed; /* the list of vertices has been freed; only the number of vertices in each row is known */
};

/* --- finding the items of the column */

/* Finds the vertices of the column, which have no numbers yet. */
static void find_vertices(void *context, size_t share)
{
    struct par_column *c = context;
    struct par_tiles *tiles = c->tiles;
    const struct tri_mesh *mesh = tiles->mesh;
    struct tri_range range = par_finds_share(share, mesh->n_vertices);
    struct par_locator place = PAR_LOST;
    struct par_finder finder = par_finder_of(&c->vertices, share);
    for (tri_vertex_id v = range.first < tiles->n_kept ? tiles->n_kept : range.first; v < range.last; v++) {
        if (mesh->on[v] == TRI_VERTEX_NONE)
            par_find_gap(&finder, v);
        else if (tiles->number[v] == NO_NUMBER && mesh->xy[v].x < c->end && mesh->xy[v].x >= c->begin)
            par_find(&finder, v, par_locate(&place, tiles->partition, 0, mesh->xy[v]) - c->first_tile);
    }
    c->no_memory[share] = !par_finder_end(&finder);
}

/* Finds the vertices of the column by their numbers, after the list of vertices was freed. Restores vertices.item in
 * the order of the numbers. */
static void find_numbered(void *context, size_t share)
{
    struct par_column *c = context;
    const struct par_tiles *tiles = c->tiles;
    struct tri_range range = par_finds_share(share, tiles->mesh->n_vertices);
    struct par_ids *found = &c->vertices.found[share];
    bool memory = true;
    for (tri_vertex_id v = range.first < tiles->n_kept ? tiles->n_kept : range.first; v < range.last; v++) {
        const int64_t place = tiles->number[v] - c->first_vertex;
        if (tiles->mesh->on[v] == TRI_VERTEX_NONE || place < 0 || place >= c->vertices.n)
            continue;
        c->vertices.item[place] = v;
        memory = par_ids_add(found, v) && memory;
    }
    c->no_memory[share] = !memory;
}

/* The vertices of the row that was looked up last. The next number mostly belongs to the same row. */
struct row_of_numbers {
    int64_t first; /* number of the first vertex */
    int32_t count; /* number of vertices; 0: no row has been looked up */
    int32_t row;   /* the row */
};

/* Returns the row of a vertex of the column, given by its number. */
static int32_t find_row(const struct par_column *c, struct row_of_numbers *last, int64_t number)
{
    if ((uint64_t)(number - last->first) < (uint64_t)last->count)
        return last->row;
    const int32_t *start = c->vertices.start;
    const int32_t place = (int32_t)(number - c->first_vertex);
    assert(place >= 0 && place < c->vertices.n);
    const int32_t row = par_holder_of(start, c->vertices.n_rows, place);
    *last = (struct row_of_numbers){c->first_vertex + start[row], start[row + 1] - start[row], row};
    return row;
}

/* Returns whether a new vertex with this number, or without a number, belongs to a later column. */
static inline bool is_later(const struct par_column *c, int64_t number)
{
    return number < 0 || number >= c->first_vertex + c->vertices.n;
}

/* Returns the row of the last tile that contains one of n vertices; or EARLIER or LATER. The tiles of new vertices
 * follow from their numbers. */
static int32_t last_row(const struct par_column *c, struct row_of_numbers *hint, const tri_vertex_id *v,
                        const int64_t *number, int n)
{
    const struct par_tiles *tiles = c->tiles;
    int64_t last = NO_NUMBER;
    int32_t row = EARLIER;
    for (int k = 0; k < n; k++) {
        if (v[k] >= tiles->n_kept) {
            if (is_later(c, number[k]))
                return LATER;
            last = number[k] > last ? number[k] : last;
            continue;
        }
        int32_t of_kept = tiles->kept_tile[v[k]] - c->first_tile;
        if (of_kept >= c->vertices.n_rows)
            return LATER;
        row = of_kept > row ? of_kept : row;
    }
    int32_t of_new = last >= c->first_vertex ? find_row(c, hint, last) : EARLIER;
    return of_new > row ? of_new : row;
}

/* Returns whether a new vertex among the corners has been numbered. Its number must then be kept for later columns. */
static bool has_number(const struct par_column *c, const tri_vertex_id v[3], const int64_t number[3])
{
    for (int k = 0; k < 3; k++)
        if (v[k] >= c->tiles->n_kept && !is_later(c, number[k]))
            return true;
    return false;
}

/* Prefetches the numbers of a triangle's corners, so that memory accesses overlap. */
static inline void fetch_numbers(const int64_t *numbers, const tri_vertex_id v[3])
{
    for (int k = 0; k < 3 && v[0] != TRI_NONE; k++)
        __builtin_prefetch(&numbers[v[k]]);
}

/* Finds the triangles of the column and converts their records, and lists triangles of later columns that have a
 * numbered corner. */
static void find_triangles(void *context, size_t share)
{
    struct par_column *c = context;
    const struct tri_mesh *mesh = c->tiles->mesh;
    const int64_t *numbers = c->tiles->number;
    struct tri_range range = par_finds_share(share, mesh->n_triangles);
    struct row_of_numbers hint = {0};
    struct par_finder finder = par_finder_of(&c->triangles, share);
    bool memory = true;
    for (tri_triangle_id t = range.first; t < range.last; t++) {
        const tri_vertex_id *v = mesh->tri[t].v;
        __builtin_prefetch(&mesh->tri[t + 4 * PAR_FOUND_AHEAD < range.last ? t + 4 * PAR_FOUND_AHEAD : t]);
        if (t + PAR_FOUND_AHEAD < range.last)
            fetch_numbers(numbers, mesh->tri[t + PAR_FOUND_AHEAD].v);
        if (v[0] == TRI_NONE) {
            par_find_gap(&finder, t);
            continue;
        }
        const int64_t number[3] = {numbers[v[0]], numbers[v[1]], numbers[v[2]]};
        int32_t row = last_row(c, &hint, v, number, 3);
        if (row >= 0) {
            const int64_t first = c->first_vertex + c->vertices.start[row];
            par_find_noted(&finder, t, row, par_final_make(&mesh->tri[t], number, first, mesh->n_input));
        } else if (row == LATER && has_number(c, v, number)) {
            memory = par_ids_add(&c->later_triangles[share], t) && memory;
        }
    }
    c->no_memory[share] = !par_finder_end(&finder) || !memory || c->no_memory[share];
}

/* Returns the row of a subsegment, or EARLIER or LATER. */
static int32_t row_of_sub(const struct par_column *c, tri_sub_id s)
{
    struct row_of_numbers hint = {0};
    const tri_vertex_id *v = c->tiles->mesh->sub[s].v;
    const int64_t number[2] = {c->tiles->number[v[0]], c->tiles->number[v[1]]};
    return last_row(c, &hint, v, number, 2);
}

/* Finds the subsegments of the column. */
static void find_subs(void *context, size_t share)
{
    struct par_column *c = context;
    const struct tri_mesh *mesh = c->tiles->mesh;
    struct tri_range range = par_finds_share(share, mesh->n_subs);
    struct par_finder finder = par_finder_of(&c->subs, share);
    for (tri_sub_id s = range.first; s < range.last; s++) {
        const bool is_free = mesh->sub[s].v[0] == TRI_NONE;
        const int32_t row = is_free ? EARLIER : row_of_sub(c, s);
        if (is_free)
            par_find_gap(&finder, s);
        else if (row >= 0)
            par_find(&finder, s, row);
    }
    c->no_memory[share] = !par_finder_end(&finder) || c->no_memory[share];
}

/* Returns whether all shares had enough memory. */
static bool memory_has_lasted(const struct par_column *c)
{
    bool memory = true;
    for (int s = 0; s < PAR_FIND_SHARES; s++)
        memory = memory && !c->no_memory[s];
    return memory;
}

/* --- arrays with an entry for each vertex */

/* A task: finds the tiles of the kept vertices of one share. */
static void place_kept(void *context, size_t share)
{
    struct par_tiles *tiles = context;
    struct tri_range range = tri_share(share, tiles->n_kept);
    struct par_locator place = PAR_LOST;
    for (tri_vertex_id v = range.first; v < range.last; v++)
        tiles->kept_tile[v] = par_locate(&place, tiles->partition, 0, tiles->mesh->xy[v]);
}

/* Locates the kept vertices, once. False: no memory. */
static bool locate_kept(struct par_tiles *tiles)
{
    if (tiles->kept_tile)
        return true;
    tiles->kept_tile = malloc(((size_t)tiles->n_kept + 1) * sizeof *tiles->kept_tile);
    if (tiles->kept_tile)
        tri_execute(tiles->executor, tri_shares(tiles->n_kept), place_kept, tiles);
    return tiles->kept_tile;
}

/* Frees the numbers, which are stored like the mesh: in memory or in files. */
static void free_numbers(struct par_tiles *tiles)
{
    if (tiles->is_in_files)
        tri_mesh_extra_free(tiles->mesh, tiles->number);
    else
        free(tiles->number);
    tiles->number = NULL;
}

/* Extends `number` to n entries. False: no memory. */
static bool grow_numbers(struct par_tiles *tiles, size_t n)
{
    if (!tiles->mesh->storage)
        return tri_resize(&tiles->number, n, sizeof *tiles->number);
    int64_t *number = tri_mesh_extra(tiles->mesh, n * sizeof *number);
    if (!number)
        return false;
    if (tiles->capacity > 0)
        memcpy(number, tiles->number, (size_t)tiles->capacity * sizeof *number);
    free_numbers(tiles);
    tiles->number = number;
    tiles->is_in_files = true;
    return true;
}

bool par_tiles_reserve(struct par_tiles *tiles)
{
    int32_t before = tiles->capacity, now = tiles->mesh->vertex_capacity;
    assert(tiles->n_kept <= tiles->mesh->n_vertices && tiles->mesh->n_vertices <= now);
    if (!locate_kept(tiles))
        return false;
    if (now <= before)
        return true;
    if (!grow_numbers(tiles, (size_t)now))
        return false;
    for (tri_vertex_id v = before; v < now; v++)
        tiles->number[v] = v < tiles->n_kept ? v : NO_NUMBER;
    tiles->capacity = now;
    return true;
}

/* --- tile by tile */

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a column of tiles");
}

/* Returns the tile of a row with its counts and first numbers, without arrays. */
static struct tri_tile tile_of(const struct par_column *c, int32_t r)
{
    const struct par_tiles *tiles = c->tiles;
    int32_t v = c->vertices.start[r], t = c->triangles.start[r], s = c->subs.start[r];
    return (struct tri_tile){.column = c->column, .row = r, .first_vertex = c->first_vertex + v,
                             .first_triangle = tiles->n_triangles + t, .first_segment = tiles->n_segments + s,
                             .n_vertices = c->vertices.start[r + 1] - v, .n_triangles = c->triangles.start[r + 1] - t,
                             .n_segments = c->subs.start[r + 1] - s};
}

/* A pipeline's `make`: numbers the vertices of a tile along a Hilbert curve. */
static enum tri_status number_tile(void *context, int32_t row, int32_t slot, struct tri_error *error)
{
    const struct par_column *c = context;
    struct par_tile_job *job = &c->tiles->job[slot];
    int32_t first = c->vertices.start[row], n = c->vertices.start[row + 1] - first, *order = c->vertices.item + first;
    if (!par_tile_job_reserve(job, 2 * (int64_t)n))
        return no_memory(error);
    tri_hilbert_order_coarse(c->tiles->mesh->xy, order, n, job->scratch);
    for (int32_t i = 0; i < n; i++)
        c->tiles->number[order[i]] = c->first_vertex + first + i;
    return TRI_OK;
}

/* A pipeline's `make`: fills the arrays of a tile. */
static enum tri_status fill_tile(void *context, int32_t row, int32_t slot, struct tri_error *error)
{
    const struct par_column *c = context;
    struct par_tile_job *job = &c->tiles->job[slot];
    job->tile = tile_of(c, row);
    const int32_t first = c->triangles.start[row];
    const struct par_tile_ids ids = {c->vertices.item + c->vertices.start[row], c->triangles.item + first,
                                     c->triangles.note + first, c->subs.item + c->subs.start[row]};
    return par_tile_fill(job, c->tiles->mesh, c->tiles->number, &ids) ? TRI_OK : no_memory(error);
}

/* A pipeline's `take`: passes a tile to the sink, unless it is empty. */
static enum tri_status take_tile(void *context, int32_t row, int32_t slot, struct tri_error *error)
{
    const struct par_column *c = context;
    const struct tri_sink *sink = c->tiles->sink;
    const struct tri_tile *tile = &c->tiles->job[slot].tile;
    (void)row;
    bool is_empty = tile->n_vertices + tile->n_triangles + tile->n_segments == 0;
    return is_empty ? TRI_OK : sink->take(sink->user, tile, error);
}

/* Returns a pipeline over the tiles of the column, without callbacks. */
static struct par_pipeline pipeline_of(struct par_column *c)
{
    int32_t threads = c->tiles->n_threads > 0 ? c->tiles->n_threads : 1;
    return (struct par_pipeline){.n = c->vertices.n_rows, .n_slots = par_tiles_jobs(c->tiles), .n_threads = threads,
                                 .context = c};
}

static bool reserve_jobs(struct par_tiles *tiles)
{
    if (!tiles->job)
        tiles->job = calloc((size_t)par_tiles_jobs(tiles), sizeof *tiles->job);
    return tiles->job;
}

/* --- removing from the mesh */

/* Lists the numbered vertices that are corners of triangles of later columns. False: no memory. */
static bool corners_that_stay(const struct par_column *c, struct par_ids *stay)
{
    const struct par_tiles *tiles = c->tiles;
    bool memory = true;
    *stay = (struct par_ids){0};
    for (int s = 0; s < PAR_FIND_SHARES; s++)
        for (int32_t i = 0; i < c->later_triangles[s].n; i++)
            for (int k = 0; k < 3; k++) {
                tri_vertex_id v = tiles->mesh->tri[c->later_triangles[s].item[i]].v[k];
                if (v >= tiles->n_kept && tiles->number[v] >= 0)
                    memory = memory && par_ids_add(stay, v);
            }
    stay->n = par_sort_unique(stay->item, stay->n);
    return memory;
}

/* Removes the vertices of an ascending list from the mesh, except those in `stay`. Afterwards the list has only the
 * removed ones. */
static void remove_listed_vertices(struct par_tiles *tiles, const struct par_ids *stay, struct par_ids *list)
{
    int32_t left = 0, k = list->n > 0 ? par_ids_find(stay, list->item[0]) : 0;
    for (int32_t i = 0; i < list->n; i++) {
        tri_vertex_id v = list->item[i];
        while (k < stay->n && stay->item[k] < v)
            k++;
        if (k < stay->n && stay->item[k] == v)
            continue;
        tiles->mesh->on[v] = TRI_VERTEX_NONE;
        tiles->number[v] = NO_NUMBER;
        list->item[left++] = v;
    }
    list->n = left;
}

/* The removal of a column. */
struct column_removal {
    struct par_column *column;  /* the column to remove */
    const struct par_ids *stay; /* vertices that stay in the mesh, ascending */
};

/* Removes the vertices and subsegments of one share from the mesh, and adds the ids of all its lists to the gaps.
 * Triangles were removed when their tiles were filled. */
static void remove_share(void *context, size_t share)
{
    const struct column_removal *l = context;
    struct par_column *c = l->column;
    struct par_ids *subs = &c->subs.found[share];
    remove_listed_vertices(c->tiles, l->stay, &c->vertices.found[share]);
    for (int32_t i = 0; i < subs->n; i++)
        par_room_mark_sub(c->tiles->mesh, subs->item[i]);
    c->no_memory[share] = !par_finds_add_gaps(&c->vertices, share, &c->vertices.found[share]) ||
                          !par_finds_add_gaps(&c->triangles, share, &c->triangles.found[share]) ||
                          !par_finds_add_gaps(&c->subs, share, subs);
}

/* Removes the column from the mesh and replaces *spare by the free ids that the searches met and those of the column.
 * False: no memory. */
static bool remove_column(struct par_column *c, struct par_room *spare)
{
    struct par_ids stay, *held = &c->tiles->held;
    if (!corners_that_stay(c, &stay)) {
        free(stay.item);
        return false;
    }
    struct column_removal column_removal = {c, &stay};
    tri_execute(c->tiles->executor, PAR_FIND_SHARES, remove_share, &column_removal);
    remove_listed_vertices(c->tiles, &stay, held);
    bool memory = memory_has_lasted(c) && par_finds_add_gaps(&c->vertices, 0, held) &&
                  par_finds_give(&c->vertices, &spare->ranges[PAR_VERTICES]) &&
                  par_finds_give(&c->triangles, &spare->ranges[PAR_TRIANGLES]) &&
                  par_finds_give(&c->subs, &spare->ranges[PAR_SUBS]);
    free(held->item);
    *held = stay;
    return memory;
}

/* --- processing a column */

/* Initialises *c and reserves memory. False: no memory. */
static bool begin_column(struct par_column *c, struct par_tiles *tiles, int32_t column)
{
    const struct tri_fence fence = par_fence(tiles->partition, column, 0);
    assert(column % 2 == 1 && column < tiles->partition->n_columns);
    *c = (struct par_column){.tiles = tiles, .column = column, .first_tile = column * tiles->partition->n_rows,
                             .first_vertex = tiles->n_vertices,
                         .begin = fence.x_min, .end = fence.x_max};
    int32_t n_rows = tiles->partition->n_rows;
    return par_finds_begin(&c->vertices, n_rows) && par_finds_begin(&c->triangles, n_rows) &&
           par_finds_begin(&c->subs, n_rows) && par_tiles_reserve(tiles) && reserve_jobs(tiles);
}

/* Finds and numbers the vertices of the column. */
static enum tri_status number_column(struct par_column *c, struct tri_error *error)
{
    const struct tri_executor *executor = c->tiles->executor;
    tri_execute(executor, PAR_FIND_SHARES, find_vertices, c);
    if (!memory_has_lasted(c) || !par_finds_deal(&c->vertices, executor))
        return no_memory(error);
    struct par_pipeline pipeline = pipeline_of(c);
    pipeline.make = number_tile;
    return par_pipeline_run(&pipeline, executor, error);
}

/* Frees the column's lists of vertices. They are restored when the column is handed out. If all columns are numbered
 * first, their lists would otherwise contain all vertices of the mesh. */
static void free_vertex_lists(struct par_column *c)
{
    par_finds_forget(&c->vertices);
    c->is_list_freed = true;
}

/* Restores the lists that `free_vertex_lists` freed. False: no memory. */
static bool restore_vertex_lists(struct par_column *c)
{
    c->vertices.item = malloc(((size_t)c->vertices.n + 1) * sizeof *c->vertices.item);
    if (c->vertices.item)
        tri_execute(c->tiles->executor, PAR_FIND_SHARES, find_numbered, c);
    c->is_list_freed = false;
    return c->vertices.item && memory_has_lasted(c);
}

/* Finds the triangles and subsegments of the column, fills its tiles and passes them to the sink. */
static enum tri_status hand_out_column(struct par_column *c, struct tri_error *error)
{
    const struct tri_executor *executor = c->tiles->executor;
    if (c->is_list_freed && !restore_vertex_lists(c))
        return no_memory(error);
    tri_execute(executor, PAR_FIND_SHARES, find_triangles, c);
    tri_execute(executor, PAR_FIND_SHARES, find_subs, c);
    if (!memory_has_lasted(c) || !par_finds_deal(&c->triangles, executor) || !par_finds_deal(&c->subs, executor))
        return no_memory(error);
    struct par_pipeline pipeline = pipeline_of(c);
    pipeline.make = fill_tile;
    pipeline.take = take_tile;
    return par_pipeline_run(&pipeline, executor, error);
}

void par_column_free(struct par_column *c)
{
    if (!c)
        return;
    par_finds_free(&c->vertices);
    par_finds_free(&c->triangles);
    par_finds_free(&c->subs);
    for (int s = 0; s < PAR_FIND_SHARES; s++)
        free(c->later_triangles[s].item);
    free(c);
}

/* Creates *numbered for a column and numbers its vertices. */
static enum tri_status number_next(struct par_tiles *tiles, int32_t column, struct par_column **numbered,
                                   struct tri_error *error)
{
    struct par_column *c = *numbered = calloc(1, sizeof *c);
    if (!c)
        return no_memory(error);
    enum tri_status status = begin_column(c, tiles, column) ? number_column(c, error) : no_memory(error);
    tiles->n_vertices += c->vertices.n;
    return status;
}

enum tri_status par_tiles_number(struct par_tiles *tiles, int32_t column, struct par_column **numbered,
                                 struct tri_error *error)
{
    enum tri_status status = number_next(tiles, column, numbered, error);
    if (!status)
        free_vertex_lists(*numbered);
    return status;
}

enum tri_status par_tiles_hand_out(struct par_column *c, struct par_room *spare, struct tri_error *error)
{
    struct par_tiles *tiles = c->tiles;
    enum tri_status status = hand_out_column(c, error);
    if (!status && !remove_column(c, spare))
        status = no_memory(error);
    tiles->n_triangles += c->triangles.n;
    tiles->n_segments += c->subs.n;
    return status;
}

enum tri_status par_tiles_column(struct par_tiles *tiles, int32_t column, struct par_room *spare,
                                 struct tri_error *error)
{
    struct par_column *c;
    par_room_mark(spare, tiles->mesh, tiles->executor);
    enum tri_status status = number_next(tiles, column, &c, error);
    status = status ? status : par_tiles_hand_out(c, spare, error);
    par_column_free(c);
    return status;
}

void par_tiles_free(struct par_tiles *tiles)
{
    for (int32_t i = 0; tiles->job && i < par_tiles_jobs(tiles); i++)
        par_tile_job_free(&tiles->job[i]);
    free(tiles->job);
    free_numbers(tiles);
    free(tiles->kept_tile);
    free(tiles->held.item);
    tiles->job = NULL;
    tiles->kept_tile = NULL;
    tiles->held = (struct par_ids){0};
}
