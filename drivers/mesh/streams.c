#include "drivers/mesh/streams.h"

#include <stdlib.h>

#include "drivers/interrupt.h"
#include "sched/tiles/tiles.h"
#include "sched/tunables.h"
#include "triangle/base/system.h"

static const char program[] = PTRIANGLE_NAME " " PTRIANGLE_VERSION;

/* --- names */

static const char *without_folder(const char *name)
{
    return name + tri_path_folder_length(name);
}

/* --- opening and closing */

static enum tri_status open_stream(struct stream *s, const char *name, const struct run *run, struct tri_sink *sink)
{
    struct tri_output_set *set = run->outputs;
    struct tri_error *error = run->error;
    s->options = (struct tri_h5_options){.program = program, .name = without_folder(name),
                                         .markers = !run->arguments->switches.no_markers,
                                         .n_orphans = run->unused.n};
    enum tri_status status = interrupt_open(set, name, &s->options.file, error);
    status = status ? status : mesh_files_open(set, stream_xdmf(name), &s->options.xdmf, error);
    return status ? status : tri_h5_writer_new(&s->writer, &s->options, sink, error);
}

/* Opens one of Triangle's files, if requested. */
static enum tri_status open_text(struct tri_output **output, const struct run *run, const char *suffix)
{
    if (!mesh_files_has(run, suffix))
        return TRI_OK;
    return mesh_files_open(run->outputs, tri_joined(run->arguments->output, suffix), output, run->error);
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

static enum tri_status begin_all(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct streams *streams = user;
    enum tri_status status = TRI_OK;
    for (int i = 0; !status && i < streams->n_sinks; i++)
        status = streams->sink[i].begin(streams->sink[i].user, stream, error);
    memset(streams->taken, 0, sizeof streams->taken);
    streams->n_attributes = stream->n_attributes;
    return status;
}

static enum tri_status take_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct streams *streams = user;
    struct tri_tile used;
    void *room;
    enum tri_status status = TRI_OK;
    if (!orphans_leave_out(&streams->run->unused, tile, streams->n_attributes, &used, &room))
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

/* Hands out, as the last tile, input segments whose ends are points but which are no edges of the mesh. */
static enum tri_status hand_out_loose_segments(struct streams *streams, struct tri_error *error)
{
    const struct run *run = streams->run;
    const struct tri_pslg *pslg = &run->input.pslg;
    const size_t most = (size_t)run->report.loose;
    struct tri_tile tile = {.first_vertex = streams->taken[0], .first_triangle = streams->taken[1],
                            .first_segment = streams->taken[2]};
    int64_t(*ends)[2] = malloc(most * sizeof *ends);
    int32_t *markers = malloc(most * sizeof *markers);
    for (int32_t k = 0; ends && markers && k < pslg->n_segments; k++) {
        const int32_t *end = &pslg->segments[2 * (size_t)k];
        if (run->is_edge[k] || orphans_have(&run->unused, end[0]) || orphans_have(&run->unused, end[1]))
            continue;
        ends[tile.n_segments][0] = end[0];
        ends[tile.n_segments][1] = end[1];
        markers[tile.n_segments++] = pslg->segment_markers ? pslg->segment_markers[k] : 0;
    }
    tile.ends = (const int64_t(*)[2])ends;
    tile.segment_markers = markers;
    enum tri_status status = ends && markers ? take_tile(streams, &tile, error)
                                             : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a tile");
    free(ends);
    free(markers);
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

static enum tri_status end_all(void *user, struct tri_error *error)
{
    struct streams *streams = user;
    enum tri_status status = streams->run->report.loose > 0 ? hand_out_loose_segments(streams, error) : TRI_OK;
    for (int i = 0; !status && i < streams->n_sinks; i++)
        status = streams->sink[i].end ? streams->sink[i].end(streams->sink[i].user, error) : TRI_OK;
    return status || !streams->store ? status : write_exports(streams, error);
}

struct tri_sink streams_sink(struct streams *streams)
{
    return (struct tri_sink){streams, begin_all, take_tile, end_all};
}

/* --- a mesh that is in memory */

enum tri_status streams_hand_out(struct streams *streams, struct tri_mesh *mesh, int32_t n_before)
{
    const struct run *run = streams->run;
    const struct tri_sink sink = streams_sink(streams);
    const struct tri_grid_options shown = mesh_files_grid(run, true);
    struct par_tiles tiles = {.mesh = mesh, .sink = &sink, .figure = shown.pslg, .n_kept = n_before,
                              .kept_at_once = PAR_ITEMS_AT_ONCE, .region_column = shown.regions && !shown.elements};
    return par_tiles_whole(&tiles, run->error);
}
