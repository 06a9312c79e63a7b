#include "triangle/text/stream.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_COUNTS = 4 };

/* A table whose first line waits for the number of its rows. */
struct table {
    struct tri_output *output; /* NULL: not wanted */
    tri_write_rows_call *write;
    uint64_t place;            /* of the first line */
    size_t room;               /* kept for it */
    int64_t counts[MOST_COUNTS]; /* of that line; the first is that of rows so far */
    int n_counts;
};

enum { POINTS, TRIANGLES, SEGMENTS, TABLES };

struct tri_text_stream {
    struct tri_text_options options;
    struct tri_tile_grid rows; /* of the tile that is written */
    bool known;                /* the counts are, from the beginning */
    struct table table[TABLES];
};

/* --- the tile as a grid */

/* Item i is asked for. */
static const struct tri_tile_grid *at_item(const void *user, int64_t i)
{
    const struct tri_tile_grid *g = user;
    tri_grid_pass(&g->grid, i);
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

enum tri_status tri_tile_grid_begin(struct tri_tile_grid *g, const struct tri_stream *stream, bool markers,
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

/* Room for the first line, if there are about so many rows. */
static void keep_room(struct table *table, double rows)
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

/* Puts the first line where it belongs. */
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

static void keep_room_for_all(struct tri_text_stream *s, const struct tri_stream *stream)
{
    const double expected[TABLES] = {stream->estimate / 2, stream->estimate, sqrt(stream->estimate)};
    const int64_t *first[TABLES] = {stream->first_vertex, stream->first_triangle, stream->first_segment};
    for (int i = 0; i < TABLES; i++) {
        const int64_t n = s->known ? first[i][stream->n_ranks] : 0;
        keep_room(&s->table[i], s->known ? (double)n : expected[i]);
        s->table[i].counts[0] = n;
    }
}

/* --- the sink */

/* What was written is void. */
static enum tri_status begin_again(struct tri_text_stream *s, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int i = 0; i < TABLES && !status; i++)
        status = s->table[i].output ? tri_output_restart(s->table[i].output, error) : TRI_OK;
    return status;
}

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_text_stream *s = user;
    const struct tri_text_options *o = &s->options;
    const int64_t markers = o->markers, attributes = stream->n_attributes;
    enum tri_status status = s->rows.columns ? begin_again(s, error) : TRI_OK;
    status = status ? status : tri_tile_grid_begin(&s->rows, stream, o->markers, error);
    s->rows.grid.base = o->base;
    s->rows.grid.figure = o->figure;
    s->table[POINTS] = (struct table){o->node, tri_write_node_rows, 0, 0, {0, 2, attributes, markers}, 4};
    s->table[TRIANGLES] = (struct table){o->ele, tri_write_ele_rows, 0, 0, {0, 3, stream->n_columns}, 3};
    s->table[SEGMENTS] = (struct table){o->poly, tri_write_segment_rows, 0, 0, {0, markers}, 2};
    s->known = stream->n_ranks > 1;
    if (status || stream->rank > 0)
        return status;
    if (o->poly)
        status = tri_write_counts(o->poly, s->table[POINTS].counts, 4, error); /* no points */
    keep_room_for_all(s, stream);
    return status;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
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

static enum tri_status end(void *user, struct tri_error *error)
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
        if (files[i] && !tri_output_has_places(files[i]))
            return tri_fail(error, TRI_CANNOT_WRITE, files[i]->path, 0,
                            "a mesh that is not in memory cannot be written to a device or pipe");
    *stream = malloc(sizeof **stream);
    if (!*stream)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory to write files");
    **stream = (struct tri_text_stream){.options = *options};
    *sink = (struct tri_sink){*stream, begin, take, end};
    return TRI_OK;
}

void tri_text_stream_free(struct tri_text_stream *stream)
{
    if (stream)
        free(stream->rows.columns);
    free(stream);
}
