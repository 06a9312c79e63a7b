/* Tiles into arrays.
 *
 * A tile's rows go into the arrays' buffers, converted to bytes of the file, in pieces as the buffers have room. All
 * calls of HDF5 stand between H5E_BEGIN_TRY and H5E_END_TRY, which keep it from printing what goes wrong.
 *
 * WHERE CHUNKS LIE depends on the numbers of points and triangles alone, not on what came first. A planar mesh has less
 * than two triangles a point (Euler), and so has the part of it that has come so far, since corners come before
 * triangles. A chunk of points has CHUNK_POINTS rows, one of triangles twice as many; chunk k of all these arrays is
 * allocated, array by array, when the first point comes that belongs to it. Then every triangle has a chunk in time.
 * As long as there are no more than CHUNK_POINTS points no array has chunks. Segments are written behind all else. */
#include "triangle/hdf5/h5_write.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/hdf5/items.h"
#include "triangle/hdf5/layout.h"
#include "triangle/hdf5/segment_spool.h"
#include "triangle/hdf5/views.h"
#include "triangle/hdf5/xdmf.h"

enum { CHUNK_POINTS = 1 << 18, CHUNK_TRIANGLES = 2 * CHUNK_POINTS, CHUNK_SEGMENTS = CHUNK_POINTS };

struct tri_h5_writer {
    struct tri_h5_options options;
    struct tri_h5_file file;
    struct tri_h5_arrays arrays;
    struct tri_h5_segments segments;
    int64_t n_chunks;     /* of points, and of triangles, allocated */
    int64_t most_narrow;
    int64_t n_input;      /* points that there were before refinement */
    double bounds[4];     /* least x, least y, largest x, largest y; none as long as there are no points */
    int32_t n_columns;
    double *columns;      /* [n_regions][n_columns] of the stream */
    bool is_laid_out;     /* all arrays have their places, and have been closed: others write the rows */
    struct tri_h5_layout layout;
    int64_t *place;       /* [layout.n] */
};

bool tri_h5_is_there(void) { return true; }

/* --- beginning */

/* Can all be kept as integers of 32 bits? */
static bool are_whole(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!(values[i] >= INT32_MIN && values[i] <= INT32_MAX) || values[i] != (double)(int32_t)values[i] ||
            (values[i] == 0 && signbit(values[i])))
            return false;
    return true;
}

static enum tri_status copy_columns(struct tri_h5_writer *w, const struct tri_stream *stream, struct tri_error *error)
{
    const size_t n = (size_t)stream->n_regions * (size_t)stream->n_columns;
    w->n_columns = stream->n_columns;
    w->columns = malloc((n + 1) * sizeof *w->columns);
    if (!w->columns)
        return tri_fail(error, TRI_NO_MEMORY, w->options.file->path, 0, "no memory for %d regions",
                        (int)stream->n_regions);
    if (n > 0)
        memcpy(w->columns, stream->regions, n * sizeof *w->columns);
    return TRI_OK;
}

/* An array, where it is wanted. */
static enum tri_status begin_array(struct tri_h5_writer *w, bool wanted, struct tri_h5_array *array, const char *name,
                                   enum tri_h5_type type, int32_t width, int32_t chunk, struct tri_error *error)
{
    return wanted ? tri_h5_array_begin(array, &w->file, name, type, width, chunk, error) : TRI_OK;
}

static enum tri_status begin_arrays(struct tri_h5_writer *w, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_h5_arrays *a = &w->arrays;
    const enum tri_h5_type columns =
        are_whole(w->columns, (int64_t)stream->n_regions * w->n_columns) ? TRI_H5_INT32 : TRI_H5_FLOAT64;
    enum tri_status s = begin_array(w, true, &a->points, TRI_H5_POINTS, TRI_H5_FLOAT64, 2, CHUNK_POINTS, error);
    s = s ? s : begin_array(w, w->options.markers, &a->point_markers, TRI_H5_POINT_MARKERS, TRI_H5_INT32, 0,
                            CHUNK_POINTS, error);
    s = s ? s : begin_array(w, stream->n_attributes > 0, &a->point_attributes, TRI_H5_POINT_ATTRIBUTES, TRI_H5_FLOAT64,
                            stream->n_attributes, CHUNK_POINTS, error);
    s = s ? s : begin_array(w, true, &a->triangles, TRI_H5_TRIANGLES, TRI_H5_INT32, 3, CHUNK_TRIANGLES, error);
    s = s ? s : begin_array(w, w->n_columns > 0, &a->triangle_attributes, TRI_H5_TRIANGLE_ATTRIBUTES, columns,
                            w->n_columns, CHUNK_TRIANGLES, error);
    return s ? s : tri_h5_segments_begin(&w->segments, w->options.xdmf, error);
}

/* --- tiles */

static struct tri_h5_array *array_of(struct tri_h5_writer *w, enum tri_h5_kind kind)
{
    struct tri_h5_arrays *a = &w->arrays;
    struct tri_h5_array *const all[TRI_H5_KINDS] = {&a->points, &a->point_markers, &a->point_attributes, &a->triangles,
                                                    &a->triangle_attributes, &a->segments, &a->segment_markers};
    return all[kind];
}

/* The tile's n rows of one array. */
static enum tri_status add_rows(struct tri_h5_writer *w, enum tri_h5_kind kind, const struct tri_tile *tile, int32_t n,
                                struct tri_error *error)
{
    struct tri_h5_array *array = array_of(w, kind);
    tri_h5_put_call *put = tri_h5_put_of(kind, array->type);
    const struct tri_h5_rows rows = {tile, w->columns, w->arrays.point_attributes.width, w->n_columns};
    for (int32_t i = 0; array->file && i < n;) {
        int32_t room;
        char *at;
        enum tri_status status = tri_h5_array_room(array, &at, &room, error);
        if (status)
            return status;
        const int32_t end = room < n - i ? i + room : n;
        put(&rows, i, end, at);
        tri_h5_array_advance(array, end - i);
        i = end;
    }
    return TRI_OK;
}

/* Corners among so many points have 64 bits from now on, if that is needed. */
static enum tri_status widen_in_time(struct tri_h5_writer *w, int64_t n_points, struct tri_error *error)
{
    struct tri_h5_array *triangles = &w->arrays.triangles;
    if (n_points <= w->most_narrow || triangles->type == TRI_H5_INT64)
        return TRI_OK;
    return tri_h5_array_widen(triangles, error);
}

/* Chunks for so many points and their triangles, in the order of the arrays; see above. */
static enum tri_status allocate(struct tri_h5_writer *w, int64_t n_points, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (n_points <= CHUNK_POINTS)
        return widen_in_time(w, n_points, error);
    while (w->n_chunks * CHUNK_POINTS < n_points && !status) {
        w->n_chunks++;
        status = widen_in_time(w, w->n_chunks * CHUNK_POINTS, error);
        for (enum tri_h5_kind kind = 0; kind < TRI_H5_OF_SEGMENTS && !status; kind++)
            if (array_of(w, kind)->file)
                status = tri_h5_array_allocate(array_of(w, kind), w->n_chunks, error);
    }
    return status;
}

static enum tri_status add_points(struct tri_h5_writer *w, const struct tri_tile *tile, struct tri_error *error)
{
    const int32_t n = tile->n_vertices;
    enum tri_status status = allocate(w, w->arrays.points.n + n, error);
    for (enum tri_h5_kind kind = TRI_H5_OF_POINTS; !status && kind <= TRI_H5_OF_POINT_ATTRIBUTES; kind++)
        status = add_rows(w, kind, tile, n, error);
    tri_h5_extend_bounds(w->bounds, tile);
    w->n_input += tile->column < 0 ? n : 0;
    return status;
}

static enum tri_status add_triangles(struct tri_h5_writer *w, const struct tri_tile *tile, struct tri_error *error)
{
    const int32_t n = tile->n_triangles;
    enum tri_status status = add_rows(w, TRI_H5_OF_TRIANGLES, tile, n, error);
    return status ? status : add_rows(w, TRI_H5_OF_TRIANGLE_ATTRIBUTES, tile, n, error);
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    enum tri_status status = TRI_OK;
    assert(!w->is_laid_out && tile->first_vertex == w->arrays.points.n &&
           tile->first_triangle == w->arrays.triangles.n && tile->first_segment == w->segments.n);
    H5E_BEGIN_TRY
    {
        status = add_points(w, tile, error);
        status = status ? status : add_triangles(w, tile, error);
        status = status ? status : tri_h5_segments_add(&w->segments, tile, error);
    }
    H5E_END_TRY
    return status;
}

/* --- ending */

static enum tri_status begin_segments(struct tri_h5_writer *w, struct tri_error *error)
{
    struct tri_h5_arrays *a = &w->arrays;
    const int64_t n_chunks = w->segments.n > CHUNK_SEGMENTS ? (w->segments.n - 1) / CHUNK_SEGMENTS + 1 : 0;
    enum tri_status status = begin_array(w, true, &a->segments, TRI_H5_SEGMENTS,
                                         a->triangles.type, 2, CHUNK_SEGMENTS, error);
    status = status ? status : tri_h5_array_allocate(&a->segments, n_chunks, error);
    status = status ? status : begin_array(w, w->options.markers, &a->segment_markers, TRI_H5_SEGMENT_MARKERS,
                                           TRI_H5_INT32, 0, CHUNK_SEGMENTS, error);
    if (!status && w->options.markers)
        status = tri_h5_array_allocate(&a->segment_markers, n_chunks, error);
    return status;
}

static enum tri_status write_segments(struct tri_h5_writer *w, struct tri_error *error)
{
    struct tri_tile tile;
    enum tri_status status = begin_segments(w, error);
    do {
        status = status ? status : tri_h5_segments_next(&w->segments, &tile, error);
        status = status ? status : add_rows(w, TRI_H5_OF_SEGMENTS, &tile, tile.n_segments, error);
        status = status ? status : add_rows(w, TRI_H5_OF_SEGMENT_MARKERS, &tile, tile.n_segments, error);
    } while (!status && tile.n_segments > 0);
    return status;
}

static enum tri_status end_arrays(struct tri_h5_writer *w, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum tri_h5_kind kind = 0; kind < TRI_H5_KINDS && !status; kind++) {
        if (kind == TRI_H5_OF_SEGMENTS)
            status = write_segments(w, error);
        if (!status && array_of(w, kind)->file)
            status = tri_h5_array_end(array_of(w, kind), error);
    }
    return status;
}

/* --- laying out: all sizes are known, and others put the rows where they belong */

static enum tri_status lay_out_array(struct tri_h5_writer *w, enum tri_h5_kind kind, int64_t n, struct tri_error *error)
{
    struct tri_h5_array *array = array_of(w, kind);
    struct tri_h5_layout *layout = &w->layout;
    if (!array->file)
        return TRI_OK;
    const int64_t n_places = array->n_chunks > 0 ? (n + array->chunk_rows - 1) / array->chunk_rows : 1;
    layout->array[kind] = (struct tri_h5_laid){array->type, array->width, array->chunk_rows, layout->n, n_places};
    if (!tri_resize(&w->place, (size_t)(layout->n + n_places), sizeof *w->place))
        return tri_fail(error, TRI_NO_MEMORY, w->options.file->path, 0, "no memory to write the file");
    layout->n += n_places;
    return tri_h5_array_lay_out(array, n, w->place + layout->n - n_places, error);
}

/* The calls of HDF5 that a file of unknown sizes would have taken, in their order, but for those that write rows. */
static enum tri_status lay_out(struct tri_h5_writer *w, const struct tri_stream *stream, struct tri_error *error)
{
    const int64_t n_points = stream->first_vertex[stream->n_ranks],
                  n_triangles = stream->first_triangle[stream->n_ranks],
                  n_segments = stream->first_segment[stream->n_ranks];
    const int64_t n[TRI_H5_KINDS] = {n_points, n_points, n_points, n_triangles, n_triangles, n_segments, n_segments};
    enum tri_status status = allocate(w, n_points, error);
    w->is_laid_out = true;
    w->segments.n = n_segments;
    for (enum tri_h5_kind kind = 0; kind < TRI_H5_KINDS && !status; kind++) {
        if (kind == TRI_H5_OF_SEGMENTS)
            status = begin_segments(w, error);
        status = status ? status : lay_out_array(w, kind, n[kind], error);
    }
    return status;
}

const struct tri_h5_layout *tri_h5_writer_layout(const struct tri_h5_writer *writer, int64_t **place)
{
    *place = writer->place;
    return &writer->layout;
}

void tri_h5_writer_tell(struct tri_h5_writer *writer, int64_t n_input, const double bounds[4])
{
    writer->n_input = n_input;
    memcpy(writer->bounds, bounds, sizeof writer->bounds);
}

/* --- all together */

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    enum tri_status status = copy_columns(w, stream, error);
    H5E_BEGIN_TRY
    {
        status = status ? status : tri_h5_create(&w->file, w->options.file, error);
        status = status ? status : begin_arrays(w, stream, error);
        if (!status && stream->n_ranks > 1)
            status = lay_out(w, stream, error);
    }
    H5E_END_TRY
    return status;
}

static enum tri_status write_about(struct tri_h5_writer *w, struct tri_error *error)
{
    const char *about = "/" TRI_H5_ABOUT;
    const double none[4] = {0};
    struct tri_h5_file *f = &w->file;
    bool done = tri_h5_add_group(f, about) && tri_h5_add_text(f, about, TRI_H5_ABOUT_FORMAT, TRI_H5_FORMAT) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_VERSION, 0, &(int64_t){TRI_H5_VERSION}) &&
                tri_h5_add_text(f, about, TRI_H5_ABOUT_PROGRAM, w->options.program) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_POINTS, 0, &w->arrays.points.n) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_TRIANGLES, 0, &w->arrays.triangles.n) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_SEGMENTS, 0, &w->arrays.segments.n) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_INPUT_POINTS, 0, &w->n_input) &&
                tri_h5_add_reals(f, about, TRI_H5_ABOUT_BOUNDS, 4, w->arrays.points.n > 0 ? w->bounds : none);
    return done ? TRI_OK : tri_h5_fail(f, about, error);
}

static enum tri_status end(void *user, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    const struct tri_h5_options *o = &w->options;
    enum tri_status status = TRI_OK;
    H5E_BEGIN_TRY
    {
        status = w->is_laid_out ? TRI_OK : end_arrays(w, error);
        status = status ? status : write_about(w, error);
        status = status ? status : tri_h5_write_views(&w->file, &w->arrays, error);
        status = status ? status : tri_h5_close(&w->file, error);
    }
    H5E_END_TRY
    if (!status && w->n_chunks > 0) /* worth hours: not lost with the machine a moment after it has its name */
        status = tri_output_sync(o->file, error);
    return status ? status : tri_h5_write_xdmf(o->xdmf, o->name, &w->arrays, error);
}

/* --- the writer */

enum tri_status tri_h5_writer_new(struct tri_h5_writer **writer, const struct tri_h5_options *options,
                                  struct tri_sink *sink, struct tri_error *error)
{
    struct tri_h5_writer *w = malloc(sizeof *w);
    *writer = w;
    if (!w)
        return tri_fail(error, TRI_NO_MEMORY, options->file->path, 0, "no memory to write the file");
    *w = (struct tri_h5_writer){.options = *options, .file = {.id = -1, .driver = -1},
                                .bounds = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
    (void)H5dont_atexit(); /* at the end of the process HDF5 would print about files that could not be written */
    w->most_narrow = options->most_narrow > 0 ? options->most_narrow : (int64_t)INT32_MAX + 1;
    *sink = (struct tri_sink){w, begin, take, end};
    return TRI_OK;
}

/* What an unfinished file holds is of no use: it is let go of without a write. */
static void let_go(struct tri_h5_writer *w)
{
    if (w->file.id >= 0 && w->file.failure == 0)
        w->file.failure = -1;
    for (enum tri_h5_kind kind = 0; kind < TRI_H5_KINDS; kind++)
        tri_h5_array_free(array_of(w, kind));
    tri_h5_segments_free(&w->segments);
    (void)tri_h5_close(&w->file, NULL);
}

void tri_h5_writer_free(struct tri_h5_writer *writer)
{
    if (!writer)
        return;
    H5E_BEGIN_TRY
    {
        let_go(writer);
    }
    H5E_END_TRY
    free(writer->columns);
    free(writer->place);
    free(writer);
}
