#include "drivers/mesh/streams.h"

#include <stdlib.h>

#include "drivers/interrupt.h"

static const char program[] = PTRIANGLE_NAME " " PTRIANGLE_VERSION;

/* --- names */

static const char *without_folder(const char *name)
{
    const char *slash = strrchr(name, '/');
    return slash ? slash + 1 : name;
}

/* --- opening and closing */

static enum tri_status open_stream(struct stream *s, const char *name, const struct run *run, struct tri_sink *sink)
{
    struct tri_output_set *set = run->outputs;
    struct tri_error *error = run->error;
    s->options = (struct tri_h5_options){.program = program, .name = without_folder(name),
                                         .markers = !run->arguments->switches.no_markers,
                                         .n_orphans = run->unused.n};
    char *xdmf = stream_xdmf(name);
    if (!xdmf)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    enum tri_status status = interrupt_open(set, name, &s->options.file, error);
    status = status ? status : interrupt_open(set, xdmf, &s->options.xdmf, error);
    free(xdmf);
    return status ? status : tri_h5_writer_new(&s->writer, &s->options, sink, error);
}

/* One of Triangle's files, if it is wanted. */
static enum tri_status open_text(struct tri_output **output, const struct run *run, const char *suffix)
{
    if (!mesh_files_has(run, suffix))
        return TRI_OK;
    char *path = tri_joined(run->arguments->output, suffix);
    if (!path)
        return tri_fail(run->error, TRI_NO_MEMORY, NULL, 0, "out of memory for file names");
    enum tri_status status = interrupt_open(run->outputs, path, output, run->error);
    free(path);
    return status;
}

static enum tri_status open_texts(struct streams *streams, const struct run *run)
{
    const struct arguments *a = run->arguments;
    struct tri_text_options *o = &streams->text_options;
    *o = (struct tri_text_options){.base = run->input.base, .markers = !a->switches.no_markers,
                                   .figure = &run->input.pslg, .argc = a->argc, .argv = a->argv};
    enum tri_status status = open_text(&o->node, run, ".node");
    status = status ? status : open_text(&o->ele, run, ".ele");
    status = status ? status : open_text(&o->poly, run, ".poly");
    if (status || !(o->node || o->ele || o->poly))
        return status;
    return tri_text_stream_new(&streams->text, o, &streams->sink[streams->n_sinks++], run->error);
}

static enum tri_status open_exports(struct streams *streams, const struct run *run)
{
    const struct long_options *o = run->settings.options;
    enum tri_status status = TRI_OK;
    for (int i = 0; !status && i < o->n_exports; i++) {
        streams->export[i] = export_of(o->exports[i], o->n_parts);
        status = export_open(&streams->export[i], o->exports[i], run->outputs, run->error);
    }
    streams->n_exports = o->n_exports;
    if (status || o->n_exports == 0)
        return status;
    return tri_tile_store_new(&streams->store, o->scratch, &streams->sink[streams->n_sinks++], run->error);
}

enum tri_status streams_open(struct streams *streams, const struct run *run)
{
    const struct long_options *o = run->settings.options;
    enum tri_status status = TRI_OK;
    *streams = (struct streams){.run = run};
    for (int i = 0; !status && i < o->n_streams; i++)
        status = open_stream(&streams->stream[streams->n++], o->streams[i], run, &streams->sink[streams->n_sinks++]);
    if (status || !run->plan.swept)
        return status;
    status = open_texts(streams, run);
    return status ? status : open_exports(streams, run);
}

void streams_close(struct streams *streams)
{
    for (int i = 0; i < streams->n; i++)
        tri_h5_writer_free(streams->stream[i].writer);
    tri_text_stream_free(streams->text);
    tri_tile_store_free(streams->store);
    streams->text = NULL;
    streams->store = NULL;
    streams->n = 0;
}

/* --- the sink */

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct streams *streams = user;
    enum tri_status status = TRI_OK;
    for (int i = 0; !status && i < streams->n_sinks; i++)
        status = streams->sink[i].begin(streams->sink[i].user, stream, error);
    memset(streams->taken, 0, sizeof streams->taken);
    streams->n_attributes = stream->n_attributes;
    return status;
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct streams *streams = user;
    const struct run *run = streams->run;
    struct tri_tile used = *tile; /* what a mesh that is in memory hands out is used */
    void *room = NULL;
    enum tri_status status = TRI_OK;
    if (run->plan.swept && !orphans_leave_out(&run->unused, tile, streams->n_attributes, &used, &room))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a tile");
    for (int i = 0; !status && i < streams->n_sinks; i++) {
        const bool is_text = streams->text && i == streams->n;
        status = streams->sink[i].take(streams->sink[i].user, is_text ? tile : &used, error);
    }
    free(room);
    streams->taken[0] += tile->n_vertices;
    streams->taken[1] += tile->n_triangles;
    streams->taken[2] += tile->n_segments;
    return status;
}

static enum tri_status write_exports(struct streams *streams, struct tri_error *error)
{
    struct tri_grid grid;
    const struct run *run = streams->run;
    enum tri_status status = tri_tile_store_grid(streams->store, !run->arguments->switches.no_markers, &grid, error);
    for (int i = 0; !status && i < streams->n_exports; i++)
        status = export_write(&streams->export[i], &grid, run->settings.executor, error);
    return status;
}

static enum tri_status end(void *user, struct tri_error *error)
{
    struct streams *streams = user;
    enum tri_status status = TRI_OK;
    for (int i = 0; !status && i < streams->n_sinks; i++)
        status = streams->sink[i].end ? streams->sink[i].end(streams->sink[i].user, error) : TRI_OK;
    return status || !streams->store ? status : write_exports(streams, error);
}

struct tri_sink streams_sink(struct streams *streams) { return (struct tri_sink){streams, begin, take, end}; }

/* --- a mesh that is in memory */

enum { PIECE = 1 << 16 }; /* items handed out at a time */

/* Items of a grid, on their way to a sink. */
struct piece {
    const struct tri_grid *grid;
    const struct tri_mesh *mesh; /* of the grid */
    const struct tri_sink *sink;
    int64_t n_before;            /* points that there were before refinement */
    double points[PIECE][2];
    int32_t point_markers[PIECE], regions[PIECE], segment_markers[PIECE];
    int64_t corners[PIECE][3], ends[PIECE][2];
    double attributes[];         /* [PIECE][grid->n_attributes] */
};

static int32_t least(int64_t a, int64_t b) { return (int32_t)(a < b ? a : b); }

static enum tri_status hand_out_points(struct piece *p, int64_t first, int64_t end, struct tri_error *error)
{
    const struct tri_grid *g = p->grid;
    int32_t place = first < p->n_before ? -1 : 0;
    double *attribute = p->attributes;
    struct tri_tile tile = {.column = place, .row = place, .first_vertex = first,
                            .n_vertices = least(end - first, PIECE), .points = (const double(*)[2])p->points,
                            .point_markers = p->point_markers, .attributes = p->attributes};
    for (int32_t i = 0; i < tile.n_vertices; i++) {
        struct tri_grid_point point;
        g->point(g->user, first + i, &point);
        memcpy(p->points[i], point.at, sizeof point.at);
        p->point_markers[i] = point.marker;
        for (int32_t k = 0; k < g->n_attributes; k++)
            *attribute++ = g->attribute(g->user, first + i, k);
    }
    return p->sink->take(p->sink->user, &tile, error);
}

static enum tri_status hand_out_triangles(struct piece *p, int64_t first, struct tri_error *error)
{
    const struct tri_grid *g = p->grid;
    struct tri_tile tile = {.first_vertex = g->n_points, .first_triangle = first,
                            .n_triangles = least(g->n_triangles - first, PIECE),
                            .corners = (const int64_t(*)[3])p->corners, .regions = p->regions};
    for (int32_t i = 0; i < tile.n_triangles; i++) {
        int64_t nodes[6];
        g->triangle(g->user, first + i, nodes);
        memcpy(p->corners[i], nodes, sizeof p->corners[i]);
        p->regions[i] = p->mesh->tri[first + i].region;
    }
    return p->sink->take(p->sink->user, &tile, error);
}

static enum tri_status hand_out_segments(struct piece *p, int64_t first, struct tri_error *error)
{
    const struct tri_grid *g = p->grid;
    struct tri_tile tile = {.first_vertex = g->n_points, .first_triangle = g->n_triangles, .first_segment = first,
                            .n_segments = least(g->n_segments - first, PIECE),
                            .ends = (const int64_t(*)[2])p->ends, .segment_markers = p->segment_markers};
    for (int32_t i = 0; i < tile.n_segments; i++) {
        struct tri_grid_edge segment;
        g->segment(g->user, first + i, &segment);
        memcpy(p->ends[i], segment.ends, sizeof segment.ends);
        p->segment_markers[i] = segment.marker;
    }
    return p->sink->take(p->sink->user, &tile, error);
}

static enum tri_status hand_out_all(struct piece *p, struct tri_error *error)
{
    const struct tri_grid *g = p->grid;
    enum tri_status status = TRI_OK;
    for (int64_t i = 0; !status && i < p->n_before; i += PIECE)
        status = hand_out_points(p, i, p->n_before, error);
    for (int64_t i = p->n_before; !status && i < g->n_points; i += PIECE)
        status = hand_out_points(p, i, g->n_points, error);
    for (int64_t i = 0; !status && i < g->n_triangles; i += PIECE)
        status = hand_out_triangles(p, i, error);
    for (int64_t i = 0; !status && i < g->n_segments; i += PIECE)
        status = hand_out_segments(p, i, error);
    return status ? status : p->sink->end(p->sink->user, error);
}

/* Attributes of the triangles in each region; NULL: no memory. */
static double *columns_of(const struct tri_mesh *mesh, int32_t n_columns)
{
    double *columns = malloc(((size_t)mesh->n_regions * (size_t)n_columns + 1) * sizeof *columns);
    for (int32_t r = 0; columns && r < mesh->n_regions; r++)
        for (int32_t k = 0; k < n_columns; k++)
            columns[(size_t)r * (size_t)n_columns + (size_t)k] = tri_region_attributes(mesh, r)[k];
    return columns;
}

static enum tri_status hand_out(struct piece *p, const double *columns, struct tri_error *error)
{
    struct tri_stream stream = {.n_attributes = p->grid->n_attributes, .n_columns = p->grid->n_columns,
                                .n_regions = p->mesh->n_regions, .regions = columns,
                                .estimate = (double)p->grid->n_triangles, .n_ranks = 1};
    enum tri_status status = p->sink->begin(p->sink->user, &stream, error);
    return status ? status : hand_out_all(p, error);
}

enum tri_status streams_hand_out(const struct run *run, int32_t n_before, const struct tri_sink *sink)
{
    const struct tri_grid_options options = mesh_files_grid(run, true);
    struct tri_grid grid;
    enum tri_status status = tri_grid_make(&grid, &options, run->error);
    if (status)
        return status;
    struct piece *piece = malloc(sizeof *piece + PIECE * (size_t)grid.n_attributes * sizeof *piece->attributes);
    double *columns = columns_of(&run->mesh, grid.n_columns);
    if (piece && columns) {
        piece->grid = &grid;
        piece->mesh = &run->mesh;
        piece->sink = sink;
        piece->n_before = n_before - (run->mesh.n_vertices - grid.n_points); /* with -j: none of these is new */
        status = hand_out(piece, columns, run->error);
    } else {
        status = tri_fail(run->error, TRI_NO_MEMORY, NULL, 0, "out of memory to hand out a mesh");
    }
    free(piece);
    free(columns);
    tri_grid_free(&grid);
    return status;
}
