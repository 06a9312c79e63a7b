/* Writes tiles to arrays.
 *
 * Rows of a tile are converted to bytes of the file and copied to the arrays' buffers, as far as these have room. All
 * calls of HDF5 are between H5E_BEGIN_TRY and H5E_END_TRY, which suppress its messages.
 *
 * OFFSETS OF CHUNKS depend only on the numbers of points and triangles, not on the order in which they arrive. A planar
 * mesh has less than two triangles per point (Euler). The same holds for the part received so far, since corners come
 * before triangles. A chunk of points has CHUNK_POINTS rows, a chunk of triangles twice as many. Chunk k of all these
 * arrays is allocated, array by array, when the first point of chunk k arrives. So every triangle has a chunk in time.
 * Up to CHUNK_POINTS points no array has chunks. Segments are written after everything else. */
#include "triangle/hdf5/h5_write.h"

#include <assert.h>
#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"
#include "triangle/hdf5/views.h"

enum { CHUNK_POINTS = 1 << 18, CHUNK_TRIANGLES = 2 * CHUNK_POINTS, CHUNK_SEGMENTS = CHUNK_POINTS };

/* --- segments
 *
 * They are written at the end of the file, because their number is not known before, and they may arrive earlier or
 * later than points do. Few segments are kept in memory; more are spooled to a file that is needed only later. */

enum { KEPT_SEGMENTS = 1 << 16 };

struct segments {
    struct tri_output *spool; /* borrowed; empty before and afterwards */
    int64_t n, n_read;        /* number of segments; number of those read again */
    int64_t (*ends)[2];       /* [KEPT_SEGMENTS] */
    int32_t *markers;         /* [KEPT_SEGMENTS] both: the segments after those in the spool, or the last batch read */
};

/* The spool holds batches of KEPT_SEGMENTS: their ends, then their markers, as in memory. */
enum { END_BYTES = KEPT_SEGMENTS * 16, BATCH_BYTES = KEPT_SEGMENTS * 20 };

static enum tri_status open_segments(struct segments *segments, struct tri_output *spool, struct tri_error *error)
{
    *segments = (struct segments){.spool = spool, .ends = malloc(END_BYTES),
                                  .markers = malloc(BATCH_BYTES - END_BYTES)};
    if (segments->ends && segments->markers)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, spool->path, 0, "no memory to write segments");
}

static void free_segments(struct segments *segments)
{
    free(segments->ends);
    free(segments->markers);
    *segments = (struct segments){0};
}

/* Returns the offset of the batch of segment i. */
static uint64_t place_of(int64_t i) { return (uint64_t)(i / KEPT_SEGMENTS) * BATCH_BYTES; }

static enum tri_status write_batch(struct segments *s, struct tri_error *error)
{
    const uint64_t place = place_of(s->n - 1);
    int result = tri_output_write_at(s->spool, place, (const char *)s->ends, END_BYTES);
    if (result == 0)
        result = tri_output_write_at(s->spool, place + END_BYTES, (const char *)s->markers, BATCH_BYTES - END_BYTES);
    return tri_output_conclude(s->spool, result, error);
}

/* Stores the segments of a tile. */
static enum tri_status add_segments(struct segments *s, const struct tri_tile *tile, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < tile->n_segments && !status; i++) {
        const int64_t k = s->n % KEPT_SEGMENTS;
        if (s->n > 0 && k == 0)
            status = write_batch(s, error);
        memcpy(s->ends[k], tile->ends[i], sizeof s->ends[k]);
        s->markers[k] = tile->segment_markers[i];
        s->n++;
    }
    return status;
}

static bool read_batch(struct segments *s)
{
    const uint64_t place = place_of(s->n_read);
    return tri_read_back(s->spool->file, (char *)s->ends, END_BYTES, place) &&
           tri_read_back(s->spool->file, (char *)s->markers, BATCH_BYTES - END_BYTES, place + END_BYTES);
}

/* After all segments have been added: returns the next ones, in order, as a tile without other items. When none are
 * left, n_segments is 0 and the spool is empty. */
static enum tri_status next_segments(struct segments *s, struct tri_tile *tile, struct tri_error *error)
{
    const int64_t left = s->n - s->n_read;
    const bool spooled = s->n > KEPT_SEGMENTS;
    enum tri_status status = TRI_OK;
    if (spooled && s->n_read == 0) /* write the last batch to make room for the first */
        status = write_batch(s, error);
    if (!status && spooled && !(left > 0 ? read_batch(s) : tri_file_set_size(s->spool->file, 0)))
        status = tri_fail_system(error, TRI_CANNOT_WRITE, s->spool->path, "cannot read segments again", errno);
    *tile = (struct tri_tile){.ends = (const int64_t(*)[2])s->ends, .segment_markers = s->markers,
                              .first_segment = s->n_read};
    tile->n_segments = (int32_t)(left < KEPT_SEGMENTS ? left : KEPT_SEGMENTS);
    s->n_read += tile->n_segments;
    return status;
}

/* --- the writer */

struct tri_h5_writer {
    struct tri_h5_options options;
    struct tri_h5_file file;
    struct tri_h5_array arrays[TRI_H5_KINDS];
    struct tri_h5_layout layout; /* offsets of the arrays */
    struct tri_h5_part *part;    /* writes rows; NULL: other processes do */
    struct segments segments;
    int64_t n_points, n_triangles, n_chunks; /* number so far; the last: allocated chunks of points, and of triangles */
    int64_t max_narrow;
    int64_t n_input;      /* number of points that existed before refinement */
    double bounds[4];     /* least x, least y, largest x, largest y; infinite if there are no points */
};

bool tri_h5_is_available(void) { return true; }

/* --- beginning */

/* Can all values be stored as 32-bit integers? */
static bool are_whole(const double *values, int64_t n)
{
    for (int64_t i = 0; i < n; i++)
        if (!(values[i] >= INT32_MIN && values[i] <= INT32_MAX) || values[i] != (double)(int32_t)values[i] ||
            (values[i] == 0 && signbit(values[i])))
            return false;
    return true;
}

/* Begins the array of a kind if it is wanted. width: for tables of any width. */
static void begin_array(struct tri_h5_writer *w, enum tri_h5_kind kind, bool wanted, enum tri_h5_type type,
                        int32_t width)
{
    const struct tri_h5_form *form = &tri_h5_forms[kind];
    const int32_t chunk = form->rows_of == TRI_H5_OF_TRIANGLES ? CHUNK_TRIANGLES : CHUNK_POINTS;
    if (wanted)
        tri_h5_array_begin(&w->arrays[kind], &w->file, form->name, &w->layout.array[kind], type,
                           form->width < 0 ? width : form->width, chunk);
}

static void begin_arrays(struct tri_h5_writer *w, const struct tri_stream *stream)
{
    const int32_t attributes = stream->n_attributes, columns = stream->n_columns;
    const bool whole = are_whole(stream->regions, (int64_t)stream->n_regions * columns);
    begin_array(w, TRI_H5_OF_POINTS, true, TRI_H5_FLOAT64, 0);
    begin_array(w, TRI_H5_OF_POINT_MARKERS, w->options.markers, TRI_H5_INT32, 0);
    begin_array(w, TRI_H5_OF_POINT_ATTRIBUTES, attributes > 0, TRI_H5_FLOAT64, attributes);
    begin_array(w, TRI_H5_OF_TRIANGLES, true, TRI_H5_INT32, 0);
    begin_array(w, TRI_H5_OF_TRIANGLE_ATTRIBUTES, columns > 0, whole ? TRI_H5_INT32 : TRI_H5_FLOAT64, columns);
}

/* --- tiles */

/* Changes corners to 64 bits if the point numbers require it. */
static enum tri_status widen_if_needed(struct tri_h5_writer *w, int64_t n_points, struct tri_error *error)
{
    const enum tri_h5_kind kind = TRI_H5_OF_TRIANGLES;
    if (n_points <= w->max_narrow || w->layout.array[kind].type == TRI_H5_INT64)
        return TRI_OK;
    const enum tri_status status = w->part ? tri_h5_part_pause(w->part, kind, error) : TRI_OK;
    return status ? status : tri_h5_array_widen(&w->arrays[kind], error);
}

/* Allocates chunks for n_points points and their triangles, in the order of the arrays; see the head of the file. */
static enum tri_status allocate(struct tri_h5_writer *w, int64_t n_points, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (n_points <= CHUNK_POINTS && n_points <= w->max_narrow)
        return TRI_OK;
    while (w->n_chunks * CHUNK_POINTS < n_points && !status) {
        w->n_chunks++;
        for (enum tri_h5_kind kind = 0; kind < TRI_H5_OF_SEGMENTS && !status; kind++)
            if (w->arrays[kind].file)
                status = tri_h5_array_allocate(&w->arrays[kind], w->n_chunks, error);
        status = status ? status : widen_if_needed(w, w->n_chunks * CHUNK_POINTS, error);
    }
    return status;
}

static enum tri_status write_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    enum tri_status status = TRI_OK;
    assert(w->part && tile->first_vertex == w->n_points && tile->first_triangle == w->n_triangles &&
           tile->first_segment == w->segments.n);
    w->n_points += tile->n_vertices;
    w->n_triangles += tile->n_triangles;
    w->n_input += tile->column < 0 ? tile->n_vertices : 0;
    tri_h5_extend_bounds(w->bounds, tile);
    H5E_BEGIN_TRY
    {
        status = allocate(w, w->n_points, error);
    }
    H5E_END_TRY
    status = status ? status : tri_h5_part_take(w->part, tile, error); /* arrays of segments do not exist yet */
    return status ? status : add_segments(&w->segments, tile, error);
}

/* --- ending */

static enum tri_status begin_segments(struct tri_h5_writer *w, struct tri_error *error)
{
    const int64_t n_chunks = w->segments.n > CHUNK_SEGMENTS ? (w->segments.n - 1) / CHUNK_SEGMENTS + 1 : 0;
    enum tri_status status = TRI_OK;
    begin_array(w, TRI_H5_OF_SEGMENTS, true, w->layout.array[TRI_H5_OF_TRIANGLES].type, 0);
    begin_array(w, TRI_H5_OF_SEGMENT_MARKERS, w->options.markers, TRI_H5_INT32, 0);
    for (enum tri_h5_kind kind = TRI_H5_OF_SEGMENTS; kind < TRI_H5_KINDS && !status; kind++)
        if (w->arrays[kind].file)
            status = tri_h5_array_allocate(&w->arrays[kind], n_chunks, error);
    return status;
}

/* Allocates all remaining space and closes the datasets. */
static enum tri_status end_arrays(struct tri_h5_writer *w, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum tri_h5_kind kind = 0; kind < TRI_H5_KINDS && !status; kind++) {
        if (kind == TRI_H5_OF_SEGMENTS)
            status = begin_segments(w, error);
        if (status || !w->arrays[kind].file)
            continue;
        const enum tri_h5_kind of = tri_h5_forms[kind].rows_of;
        status = tri_h5_array_end(&w->arrays[kind], of == TRI_H5_OF_POINTS      ? w->n_points
                                                    : of == TRI_H5_OF_TRIANGLES ? w->n_triangles
                                                                                : w->segments.n, error);
    }
    return status;
}

static enum tri_status write_rest(struct tri_h5_writer *w, struct tri_error *error)
{
    struct tri_tile tile;
    enum tri_status status = TRI_OK;
    do {
        status = next_segments(&w->segments, &tile, error);
        status = status ? status : tri_h5_part_take(w->part, &tile, error);
    } while (!status && tile.n_segments > 0);
    return status ? status : tri_h5_part_end(w->part, error);
}

/* --- several ranks: all sizes are known, and all ranks write their rows */

static enum tri_status allocate_all(struct tri_h5_writer *w, const struct tri_stream *stream, struct tri_error *error)
{
    w->n_points = stream->first_vertex[stream->n_ranks] - w->options.n_orphans;
    w->n_triangles = stream->first_triangle[stream->n_ranks];
    w->segments.n = stream->first_segment[stream->n_ranks];
    const enum tri_status status = allocate(w, w->n_points, error);
    return status ? status : end_arrays(w, error);
}

const struct tri_h5_layout *tri_h5_writer_layout(const struct tri_h5_writer *writer) { return &writer->layout; }

void tri_h5_writer_set_totals(struct tri_h5_writer *writer, int64_t n_input, const double bounds[4])
{
    writer->n_input = n_input;
    memcpy(writer->bounds, bounds, sizeof writer->bounds);
}

/* --- beginning and end */

static void empty(struct tri_h5_writer *w)
{
    const struct tri_h5_options options = w->options;
    *w = (struct tri_h5_writer){.options = options, .file = {.id = -1, .driver = -1},
                                .max_narrow = options.max_narrow > 0 ? options.max_narrow : (int64_t)INT32_MAX + 1,
                                .bounds = {HUGE_VAL, HUGE_VAL, -HUGE_VAL, -HUGE_VAL}};
}

/* Closes an unfinished file without writing the rest, since its contents are of no use. */
static void close_unfinished(struct tri_h5_writer *w)
{
    if (w->file.id >= 0 && w->file.failure == 0)
        w->file.failure = -1;
    for (enum tri_h5_kind kind = 0; kind < TRI_H5_KINDS; kind++)
        tri_h5_array_free(&w->arrays[kind]);
    tri_h5_part_free(w->part);
    free_segments(&w->segments);
    (void)tri_h5_close(&w->file, NULL);
}

static enum tri_status restart_file(struct tri_h5_writer *w, struct tri_error *error)
{
    close_unfinished(w);
    empty(w);
    return tri_output_restart(w->options.file, error);
}

static enum tri_status begin_file(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    const bool alone = stream->n_ranks <= 1;
    enum tri_status status = TRI_OK;
    H5E_BEGIN_TRY
    {
        status = w->segments.ends ? restart_file(w, error) : TRI_OK;
        begin_arrays(w, stream);
        status = status ? status : open_segments(&w->segments, w->options.xdmf, error);
        if (!status && alone)
            status = tri_h5_part_new(&w->part, &w->layout, true, stream, w->options.file, error);
        status = status ? status : tri_h5_create(&w->file, w->options.file, error);
        if (!status && !alone)
            status = allocate_all(w, stream, error);
    }
    H5E_END_TRY
    return status;
}

static enum tri_status write_about(struct tri_h5_writer *w, struct tri_error *error)
{
    const char *about = "/" TRI_H5_ABOUT;
    const double none[4] = {0};
    struct tri_h5_file *f = &w->file;
    bool done = tri_h5_add_group(f, about) && tri_h5_add_text(f, about, "format", "ptriangle mesh") &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_VERSION, 0, &(int64_t){TRI_H5_VERSION}) &&
                tri_h5_add_text(f, about, "program", w->options.program) &&
                tri_h5_add_integers(f, about, "points", 0, &w->n_points) &&
                tri_h5_add_integers(f, about, "triangles", 0, &w->n_triangles) &&
                tri_h5_add_integers(f, about, "segments", 0, &w->segments.n) &&
                tri_h5_add_integers(f, about, TRI_H5_ABOUT_INPUT_POINTS, 0, &w->n_input) &&
                tri_h5_add_reals(f, about, "bounds", 4, w->n_points > 0 ? w->bounds : none);
    return done ? TRI_OK : tri_h5_fail(f, about, error);
}

static enum tri_status end_file(void *user, struct tri_error *error)
{
    struct tri_h5_writer *w = user;
    const struct tri_h5_options *o = &w->options;
    enum tri_status status = TRI_OK;
    H5E_BEGIN_TRY
    {
        if (w->part) {
            status = end_arrays(w, error);
            status = status ? status : write_rest(w, error);
        }
        status = status ? status : write_about(w, error);
        status = status ? status : tri_h5_write_views(&w->file, w->arrays, error);
        status = status ? status : tri_h5_close(&w->file, error);
    }
    H5E_END_TRY
    return status ? status : tri_h5_write_xdmf(o->xdmf, o->name, w->arrays, error);
}

/* --- the writer */

enum tri_status tri_h5_writer_new(struct tri_h5_writer **writer, const struct tri_h5_options *options,
                                  struct tri_sink *sink, struct tri_error *error)
{
    struct tri_h5_writer *w = malloc(sizeof *w);
    *writer = w;
    if (!w)
        return tri_fail(error, TRI_NO_MEMORY, options->file->path, 0, "no memory to write the file");
    w->options = *options;
    empty(w);
    (void)H5dont_atexit(); /* otherwise HDF5 prints messages about unwritable files when the process ends */
    *sink = (struct tri_sink){w, begin_file, write_tile, end_file};
    return TRI_OK;
}

void tri_h5_writer_free(struct tri_h5_writer *writer)
{
    if (!writer)
        return;
    H5E_BEGIN_TRY
    {
        close_unfinished(writer);
    }
    H5E_END_TRY
    free(writer);
}
