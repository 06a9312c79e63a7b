/* Starts and ends a stream of tiles, and hands out meshes that are completely in memory.
 *
 * If a mesh in memory has been numbered by tiles, the vertices, triangles and subsegments of each tile are contiguous
 * in the arrays. The tile of each item follows from its coordinates, so the end of a tile is found by bisection. */
#include "sched/tiles/tiles.h"

#include <stdlib.h>
#include <string.h>

#include "sched/tiles/tile_arrays.h"
#include "sched/tunables.h"

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the tiles of the mesh");
}

/* --- pieces of the mesh */

/* Copies the vertices, triangles and segments of a tile. vertex: the mesh's vertex for each number in the caller's
 * order; NULL: numbers are the mesh's own. */
static void copy_items(const struct par_tiles *tiles, const tri_vertex_id *vertex, const struct tri_tile *tile,
                       const struct par_tile_copy *copy)
{
    const struct tri_mesh *mesh = tiles->mesh;
    for (int32_t i = 0; i < tile->n_vertices; i++) {
        const int32_t number = (int32_t)tile->first_vertex + i;
        par_tile_copy_vertex(copy, mesh, vertex ? vertex[number] : number, i);
        if (tiles->figure && number < mesh->n_input)
            memcpy(copy->points[i], &tiles->figure->points[2 * (size_t)number], sizeof copy->points[i]);
    }
    for (int32_t i = 0; i < tile->n_triangles; i++) {
        const struct tri_triangle *t = &mesh->tri[tile->first_triangle + i];
        copy->regions[i] = t->region;
        for (int k = 0; k < 3; k++)
            copy->corners[i][k] = par_shown(mesh, t->v[k]);
    }
    for (int32_t i = 0; i < tile->n_segments; i++) {
        const struct tri_subsegment *s = &mesh->sub[tile->first_segment + i];
        copy->segment_markers[i] = s->marker;
        for (int k = 0; k < 2; k++)
            copy->ends[i][k ^ mesh->parents[s->parent].reversed] = par_shown(mesh, s->v[k]);
    }
}

/* Hands out the next vertices, triangles and segments of the mesh, as many as `tile` has. vertex: as in copy_items. */
static enum tri_status hand_out_items(struct par_tiles *tiles, const tri_vertex_id *vertex, struct tri_tile tile,
                                      struct tri_error *error)
{
    struct par_tile_copy copy = {0};
    enum tri_status status = TRI_OK;
    tile.first_vertex = tiles->n_vertices;
    tile.first_triangle = tiles->n_triangles;
    tile.first_segment = tiles->n_segments;
    if (par_tile_copy_reserve(&copy, tiles->mesh, &tile)) {
        copy_items(tiles, vertex, &tile, &copy);
        status = tiles->sink->take(tiles->sink->user, &tile, error);
    } else {
        status = no_memory(error);
    }
    par_tile_copy_free(&copy);
    tiles->n_vertices += tile.n_vertices;
    tiles->n_triangles += tile.n_triangles;
    tiles->n_segments += tile.n_segments;
    return status;
}

/* --- start of the stream */

/* Returns the kept vertices in the caller's order; free them with free. NULL: no memory. */
static tri_vertex_id *caller_order(const struct tri_mesh *mesh, int32_t n_kept)
{
    tri_vertex_id *vertex = malloc(((size_t)n_kept + 1) * sizeof *vertex);
    for (tri_vertex_id v = 0; vertex && v < n_kept; v++)
        vertex[par_shown(mesh, v)] = v;
    return vertex;
}

/* Hands out the vertices that existed before refinement, as tiles of kept_at_once vertices. */
static enum tri_status hand_out_kept(struct par_tiles *tiles, struct tri_error *error)
{
    const int32_t n = tiles->n_kept, most = tiles->kept_at_once > 0 ? tiles->kept_at_once : n;
    tri_vertex_id *vertex = tiles->mesh->origin ? caller_order(tiles->mesh, n) : NULL;
    enum tri_status status = tiles->mesh->origin && !vertex ? no_memory(error) : TRI_OK;
    tiles->n_vertices = 0;
    do {
        const int32_t left = n - (int32_t)tiles->n_vertices;
        const struct tri_tile tile = {.column = -1, .row = -1, .n_vertices = left < most ? left : most};
        status = status ? status : hand_out_items(tiles, vertex, tile, error);
    } while (!status && tiles->n_vertices < n);
    free(vertex);
    return status;
}

/* Copies the triangle attributes of each region. False: no memory. */
static bool copy_regions(const struct tri_mesh *mesh, int32_t n_columns, double **regions)
{
    size_t n = (size_t)n_columns;
    *regions = malloc((size_t)mesh->n_regions * n * sizeof **regions + 1);
    for (int32_t r = 0; *regions && n > 0 && r < mesh->n_regions; r++)
        memcpy(*regions + (size_t)r * n, tri_region_attributes(mesh, r), n * sizeof **regions);
    return *regions;
}

enum tri_status par_tiles_begin(struct par_tiles *tiles, double estimate, struct tri_error *error)
{
    const struct tri_mesh *mesh = tiles->mesh;
    double *regions;
    struct tri_stream stream = {.n_attributes = mesh->n_attributes, .n_regions = mesh->n_regions, .estimate = estimate,
                                .n_columns = mesh->columns ? mesh->n_columns : tiles->region_column,
                                .n_ranks = tiles->ranks.n > 0 ? tiles->ranks.n : 1, .rank = tiles->ranks.rank,
                                .first_vertex = tiles->ranks.first[0], .first_triangle = tiles->ranks.first[1],
                                .first_segment = tiles->ranks.first[2]};
    if (!copy_regions(mesh, stream.n_columns, &regions))
        return no_memory(error);
    stream.regions = regions;
    enum tri_status status = TRI_OK;
    if (tiles->sink->begin)
        status = tiles->sink->begin(tiles->sink->user, &stream, error);
    free(regions);
    return status || tiles->ranks.rank > 0 ? status : hand_out_kept(tiles, error);
}

enum tri_status par_tiles_end(struct par_tiles *tiles, struct tri_error *error)
{
    return tiles->sink->end ? tiles->sink->end(tiles->sink->user, error) : TRI_OK;
}

/* --- the whole mesh */

static int32_t tile_of_vertex(const struct par_tiles *tiles, tri_vertex_id v)
{
    return par_block_at(tiles->partition, 0, tiles->mesh->xy[v]);
}

static int32_t tile_of_triangle(const struct par_tiles *tiles, tri_triangle_id t)
{
    return par_last_tile(tiles->partition, tiles->mesh, tiles->mesh->tri[t].v, 3);
}

static int32_t tile_of_sub(const struct par_tiles *tiles, tri_sub_id s)
{
    return par_last_tile(tiles->partition, tiles->mesh, tiles->mesh->sub[s].v, 2);
}

/* Returns the first of the items low .. high - 1 that belongs to a later tile; high if there is none. The items are
 * sorted by tile. */
static int32_t end_of(const struct par_tiles *tiles, int32_t tile, int32_t low, int32_t high,
                      int32_t (*tile_of)(const struct par_tiles *tiles, int32_t item))
{
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (tile_of(tiles, middle) <= tile)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

/* Hands out the next vertices, triangles and segments before these ids as one tile, if there are any. */
static enum tri_status hand_out_up_to(struct par_tiles *tiles, int32_t tile_id, tri_vertex_id vertex,
                                      tri_triangle_id triangle, tri_sub_id sub, struct tri_error *error)
{
    const int32_t n_rows = tiles->partition ? tiles->partition->n_rows : 1;
    const struct tri_tile tile = {.column = tile_id / n_rows, .row = tile_id % n_rows,
                                  .n_vertices = vertex - (int32_t)tiles->n_vertices,
                                  .n_triangles = triangle - (int32_t)tiles->n_triangles,
                                  .n_segments = sub - (int32_t)tiles->n_segments};
    const bool is_empty = tile.n_vertices + tile.n_triangles + tile.n_segments == 0;
    return is_empty ? TRI_OK : hand_out_items(tiles, NULL, tile, error);
}

/* Returns the end of the next piece of n items. */
static int32_t next_end(int64_t first, int32_t n)
{
    return n - first > PAR_ITEMS_AT_ONCE ? (int32_t)first + PAR_ITEMS_AT_ONCE : n;
}

/* Hands out the remaining mesh in pieces that are not tiles. All vertices come before the triangles, because a triangle
 * can have any of them as corners. */
static enum tri_status hand_out_without_tiles(struct par_tiles *tiles, struct tri_error *error)
{
    const struct tri_mesh *m = tiles->mesh;
    enum tri_status status = TRI_OK;
    while (!status && tiles->n_vertices < m->n_vertices)
        status = hand_out_up_to(tiles, 0, next_end(tiles->n_vertices, m->n_vertices), (int32_t)tiles->n_triangles,
                                (int32_t)tiles->n_segments, error);
    while (!status && tiles->n_triangles < m->n_triangles)
        status = hand_out_up_to(tiles, 0, m->n_vertices, next_end(tiles->n_triangles, m->n_triangles),
                                (int32_t)tiles->n_segments, error);
    while (!status && tiles->n_segments < m->n_subs)
        status = hand_out_up_to(tiles, 0, m->n_vertices, m->n_triangles, next_end(tiles->n_segments, m->n_subs),
                                error);
    return status;
}

/* Returns the approximate number of triangles for the start of the stream. With a partition it is the partition's
 * estimate, as in a sweep. */
static double triangles_expected(const struct par_tiles *tiles)
{
    return tiles->partition ? tiles->partition->estimate : tiles->mesh->n_triangles;
}

enum tri_status par_tiles_whole(struct par_tiles *tiles, struct tri_error *error)
{
    const struct tri_mesh *mesh = tiles->mesh;
    int32_t n_tiles = tiles->partition ? par_blocks(tiles->partition) : 0;
    enum tri_status status = par_tiles_begin(tiles, triangles_expected(tiles), error);
    for (int32_t tile = 0; !status && tile < n_tiles; tile++) {
        if (tri_stop_is_asked(mesh->stop))
            return tri_fail_stopped(error);
        tri_vertex_id v = end_of(tiles, tile, (int32_t)tiles->n_vertices, mesh->n_vertices, tile_of_vertex);
        tri_triangle_id t = end_of(tiles, tile, (int32_t)tiles->n_triangles, mesh->n_triangles, tile_of_triangle);
        tri_sub_id s = end_of(tiles, tile, (int32_t)tiles->n_segments, mesh->n_subs, tile_of_sub);
        status = hand_out_up_to(tiles, tile, v, t, s, error);
    }
    if (!status)
        status = hand_out_without_tiles(tiles, error);
    return status ? status : par_tiles_end(tiles, error);
}
