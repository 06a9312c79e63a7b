#include "triangle/text/stream.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"

enum { MOST_COUNTS = 4 };

/* A table whose first line is written after its rows, because it holds their number. */
struct table {
    struct tri_output *output; /* NULL: not requested */
    tri_write_rows_call *write;
    uint64_t place;            /* offset of the first line */
    size_t room;               /* bytes reserved for the first line */
    int64_t counts[MOST_COUNTS]; /* numbers on the first line; the first is the number of rows so far */
    int n_counts;
};

enum { POINTS, TRIANGLES, SEGMENTS, TABLES };

struct tri_text_stream {
    struct tri_text_options options;
    struct tri_tile_grid rows; /* the current tile */
    bool known;                /* the counts are known from the beginning */
    struct table table[TABLES];
};

/* --- the tile as a grid */

/* Returns the tile for a request of item i, and evicts pages periodically. */
static const struct tri_tile_grid *at_item(const void *user, int64_t i)
{
    const struct tri_tile_grid *g = user;
    tri_grid_evict_periodically(&g->grid, i);
    return g;
}

static void point(const void *user, int64_t i, struct tri_grid_point *point)
{
    const struct tri_tile *tile = &at_item(user, i)->tile;
    const int64_t k = i - tile->first_vertex;
    *point = (struct tri_grid_point){{tile->points[k][0], tile->points[k][1]}, tile->point_markers[k]};
}

static double attribute(const void *user, int64_t i, int32_t k)
{
    const struct tri_tile_grid *g = at_item(user, i);
    return g->tile.attributes[(i - g->tile.first_vertex) * g->grid.n_attributes + k];
}

static void triangle(const void *user, int64_t i, int64_t nodes[6])
{
    const struct tri_tile *tile = &at_item(user, i)->tile;
    memcpy(nodes, tile->corners[i - tile->first_triangle], sizeof *tile->corners);
}

static double column(const void *user, int64_t i, int32_t k)
{
    const struct tri_tile_grid *g = at_item(user, i);
    return g->columns[(int64_t)g->tile.regions[i - g->tile.first_triangle] * g->grid.n_columns + k];
}

static void segment(const void *user, int64_t i, struct tri_grid_edge *segment)
{
    const struct tri_tile *tile = &at_item(user, i)->tile;
    const int64_t k = i - tile->first_segment;
    *segment = (struct tri_grid_edge){{tile->ends[k][0], tile->ends[k][1]}, tile->segment_markers[k], {0}};
}

double *tri_copy_columns(const struct tri_stream *stream)
{
    const size_t n = (size_t)stream->n_regions * (size_t)stream->n_columns;
    double *columns = malloc((n + 1) * sizeof *columns);
    if (columns && n > 0)
        memcpy(columns, stream->regions, n * sizeof *columns);
    return columns;
}

/* Initialises the parts that are common to all tiles. May be called again to restart. TRI_NO_MEMORY. */
static enum tri_status begin_tile_grid(struct tri_tile_grid *g, const struct tri_stream *stream, bool markers,
                                    struct tri_error *error)
{
    free(g->columns);
    *g = (struct tri_tile_grid){.columns = tri_copy_columns(stream)};
    g->grid = (struct tri_grid){.user = g, .has_markers = markers, .n_attributes = stream->n_attributes,
                                .n_columns = stream->n_columns, .n_nodes = 3, .point = point, .attribute = attribute,
                                .triangle = triangle, .column = column, .segment = segment};
    if (g->columns)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory for %d regions", (int)stream->n_regions);
}

/* --- tables */

/* Reserves room for the first line, assuming about `rows` rows. */
static void reserve_line(struct table *table, double rows)
{
    char line[TRI_COUNTS_ROOM];
    if (!table->output)
        return;
    table->counts[0] = rows >= 0 && rows < 9e18 ? (int64_t)rows : 0;
    table->room = (size_t)(tri_put_counts(line, table->counts, table->n_counts) - line);
    table->place = tri_output_reserve(table->output, table->room);
    table->counts[0] = 0;
}

static enum tri_status add_rows(const struct tri_text_stream *s, struct table *table, int64_t first, int64_t n,
                                struct tri_error *error)
{
    table->counts[0] += s->known ? 0 : n;
    return table->output ? table->write(table->output, &s->rows.grid, first, n, NULL, error) : TRI_OK;
}

/* Writes the first line; if its length differs from the reserved room, moves the rows. */
static enum tri_status conclude_table(struct table *table, struct tri_error *error)
{
    char line[TRI_COUNTS_ROOM];
    if (!table->output)
        return TRI_OK;
    const size_t n = (size_t)(tri_put_counts(line, table->counts, table->n_counts) - line);
    enum tri_status status = tri_output_shift(table->output, table->place + table->room,
                                              (int64_t)n - (int64_t)table->room, error);
    if (status)
        return status;
    return tri_output_conclude(table->output, tri_output_write_at(table->output, table->place, line, n), error);
}

static void reserve_lines(struct tri_text_stream *s, const struct tri_stream *stream)
{
    const double expected[TABLES] = {stream->estimate / 2, stream->estimate, sqrt(stream->estimate)};
    const int64_t *first[TABLES] = {stream->first_vertex, stream->first_triangle, stream->first_segment};
    for (int i = 0; i < TABLES; i++) {
        const int64_t n = s->known ? first[i][stream->n_ranks] : 0;
        reserve_line(&s->table[i], s->known ? (double)n : expected[i]);
        s->table[i].counts[0] = n;
    }
}

/* --- the sink */

/* Discards everything written so far. */
static enum tri_status restart_files(struct tri_text_stream *s, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; i < TABLES && !status; i++)
        status = s->table[i].output ? tri_output_restart(s->table[i].output, error) : TRI_OK;
    return status;
}

static enum tri_status begin_files(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_text_stream *s = user;
    const struct tri_text_options *o = &s->options;
    const int64_t markers = o->markers, attributes = stream->n_attributes;
    enum tri_status status = s->rows.columns ? restart_files(s, error) : TRI_OK;
    status = status ? status : begin_tile_grid(&s->rows, stream, o->markers, error);
    s->rows.grid.base = o->base;
    s->rows.grid.figure = o->figure;
    s->table[POINTS] = (struct table){o->node, tri_write_node_rows, 0, 0, {0, 2, attributes, markers}, 4};
    s->table[TRIANGLES] = (struct table){o->ele, tri_write_ele_rows, 0, 0, {0, 3, stream->n_columns}, 3};
    s->table[SEGMENTS] = (struct table){o->poly, tri_write_segment_rows, 0, 0, {0, markers}, 2};
    s->known = stream->n_ranks > 1;
    if (status || stream->rank > 0)
        return status;
    if (o->poly)
        status = tri_write_counts(o->poly, s->table[POINTS].counts, 4, error); /* the .poly file has no points */
    reserve_lines(s, stream);
    return status;
}

static enum tri_status write_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct tri_text_stream *s = user;
    const int64_t first[TABLES] = {tile->first_vertex, tile->first_triangle, tile->first_segment};
    const int32_t n[TABLES] = {tile->n_vertices, tile->n_triangles, tile->n_segments};
    enum tri_status status = TRI_OK;
    s->rows.tile = *tile;
    for (int i = 0; i < TABLES && !status; i++)
        status = add_rows(s, &s->table[i], first[i], n[i], error);
    return status;
}

static enum tri_status end_files(void *user, struct tri_error *error)
{
    struct tri_text_stream *s = user;
    const struct tri_text_options *o = &s->options;
    enum tri_status status = TRI_OK;
    for (int i = 0; i < TABLES && !status; i++)
        status = conclude_table(&s->table[i], error);
    if (!status && o->poly)
        status = tri_write_sites(o->poly, &s->rows.grid, NULL, error);
    for (int i = 0; i < TABLES && o->argc > 0 && !status; i++)
        status = s->table[i].output ? tri_write_comment(s->table[i].output, o->argc, o->argv, error) : TRI_OK;
    return status;
}

/* --- the stream */

enum tri_status tri_text_stream_new(struct tri_text_stream **stream, const struct tri_text_options *options,
                                    struct tri_sink *sink, struct tri_error *error)
{
    struct tri_output *files[] = {options->node, options->ele, options->poly};
    *stream = NULL;
    for (int i = 0; i < 3; i++)
        if (files[i] && !tri_output_has_offsets(files[i]))
            return tri_fail(error, TRI_CANNOT_WRITE, files[i]->path, 0,
                            "a mesh that is not in memory cannot be written to a device or pipe");
    *stream = malloc(sizeof **stream);
    if (!*stream)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory to write files");
    **stream = (struct tri_text_stream){.options = *options};
    *sink = (struct tri_sink){*stream, begin_files, write_tile, end_files};
    return TRI_OK;
}

void tri_text_stream_free(struct tri_text_stream *stream)
{
    if (stream)
        free(stream->rows.columns);
    free(stream);
}

/* --- tiles stored in temporary files
 *
 * There is one file for each kind of array. Tiles are appended, and the files are mapped at the end.
 *
 * INVARIANT: only rows read since the last eviction are in memory. Pages are evicted when a row whose number is a
 * multiple of TRI_GRID_PERIOD is requested, because writers read all rows of a kind once, about in order. Writers that
 * read in a different order, or only work arrays, trigger the eviction themselves. */

enum sheet { POINT_PLACES, POINT_MARKERS, ATTRIBUTES, CORNERS, REGIONS, ENDS, SEGMENT_MARKERS, KINDS };
enum { EXTRAS = 8, SHEETS = KINDS + EXTRAS };

struct tri_tile_store {
    const char *folder;
    struct tri_mapped_file sheet[SHEETS]; /* array kinds, then work arrays */
    struct tri_storage storage; /* allocates the work arrays */
    struct tri_tile_grid all;   /* all stored tiles as one tile */
};

/* --- files */

static enum tri_status fail_to_store(const struct tri_tile_store *s, struct tri_error *error)
{
    return tri_fail(error, TRI_CANNOT_WRITE, s->folder, 0, "cannot keep the mesh there until it can be written: %s",
                    strerror(errno));
}

static bool append_sheet(struct tri_tile_store *s, enum sheet kind, const void *bytes, size_t n)
{
    return tri_mapped_file_append(&s->sheet[kind], s->folder, bytes, n);
}

/* --- work arrays */

static void *new_extra(void *user, size_t bytes)
{
    struct tri_tile_store *s = user;
    for (int k = KINDS; k < SHEETS; k++)
        if (s->sheet[k].file == TRI_NO_FILE) {
            const int fault = tri_mapped_file_extend(&s->sheet[k], s->folder, bytes + 1);
            void *at = s->sheet[k].at;
            if (fault)
                tri_mapped_file_close(&s->sheet[k]);
            errno = fault;
            return at;
        }
    errno = EMFILE;
    return NULL;
}

static void free_extra(void *user, void *extra)
{
    struct tri_tile_store *s = user;
    for (int k = KINDS; extra && k < SHEETS; k++)
        if (s->sheet[k].at == extra)
            tri_mapped_file_close(&s->sheet[k]);
}

static void evict_pages(const void *user)
{
    const struct tri_tile_store *s = user;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_release_pages(&s->sheet[k]);
}

/* --- the sink */

static enum tri_status begin_store(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_tile_store *s = user;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_close(&s->sheet[k]);
    return begin_tile_grid(&s->all, stream, false, error);
}

static enum tri_status store_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct tri_tile_store *s = user;
    struct tri_grid *all = &s->all.grid;
    const size_t v = (size_t)tile->n_vertices, t = (size_t)tile->n_triangles, g = (size_t)tile->n_segments,
                 attributes = (size_t)all->n_attributes;
    bool done = append_sheet(s, POINT_PLACES, tile->points, v * sizeof *tile->points);
    done = done && append_sheet(s, POINT_MARKERS, tile->point_markers, v * sizeof *tile->point_markers);
    done = done && append_sheet(s, ATTRIBUTES, tile->attributes, v * attributes * sizeof *tile->attributes);
    done = done && append_sheet(s, CORNERS, tile->corners, t * sizeof *tile->corners);
    done = done && append_sheet(s, REGIONS, tile->regions, t * sizeof *tile->regions);
    done = done && append_sheet(s, ENDS, tile->ends, g * sizeof *tile->ends);
    done = done && append_sheet(s, SEGMENT_MARKERS, tile->segment_markers, g * sizeof *tile->segment_markers);
    all->n_points += tile->n_vertices;
    all->n_triangles += tile->n_triangles;
    all->n_segments += tile->n_segments;
    return done ? TRI_OK : fail_to_store(s, error);
}

enum tri_status tri_tile_store_grid(struct tri_tile_store *s, bool markers, struct tri_grid *grid,
                                    struct tri_error *error)
{
    for (int k = 0; k < KINDS; k++)
        if (!tri_mapped_file_map(&s->sheet[k]))
            return fail_to_store(s, error);
    s->all.tile = (struct tri_tile){.points = s->sheet[POINT_PLACES].at, .point_markers = s->sheet[POINT_MARKERS].at,
                                    .attributes = s->sheet[ATTRIBUTES].at, .corners = s->sheet[CORNERS].at,
                                    .regions = s->sheet[REGIONS].at, .ends = s->sheet[ENDS].at,
                                    .segment_markers = s->sheet[SEGMENT_MARKERS].at};
    s->all.grid.has_markers = markers;
    s->all.grid.storage = &s->storage;
    *grid = s->all.grid;
    return TRI_OK;
}

/* --- the store */

enum tri_status tri_tile_store_new(struct tri_tile_store **store, const char *folder, struct tri_sink *sink,
                                   struct tri_error *error)
{
    struct tri_tile_store *s = calloc(1, sizeof *s);
    *store = s;
    if (!s)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory to write files");
    s->folder = folder;
    s->storage = (struct tri_storage){.extra = new_extra, .extra_free = free_extra, .user = s,
                                      .evict_pages = evict_pages};
    for (int k = 0; k < SHEETS; k++)
        s->sheet[k].file = TRI_NO_FILE;
    *sink = (struct tri_sink){s, begin_store, store_tile, NULL};
    return TRI_OK;
}

void tri_tile_store_free(struct tri_tile_store *s)
{
    if (!s)
        return;
    for (int k = 0; k < SHEETS; k++)
        tri_mapped_file_close(&s->sheet[k]);
    free(s->all.columns);
    free(s);
}
