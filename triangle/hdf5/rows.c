/* Large pieces are written asynchronously, and bypass the system's cache if the file system allows it. So a mesh of
 * many gigabytes does not displace other data from the cache, no processor copies bytes, and little is left to sync at
 * the end.
 *
 * INVARIANT between calls: the buffer of an array holds its rows next - n to next - 1, which are contiguous in the file
 * and not yet written. All earlier rows have been written, or are being written from the other buffer. */
#include "triangle/hdf5/rows.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/system.h"
#include "triangle/text/binary.h"
#include "triangle/text/stream.h"

/* --- rows as bytes */

enum { REALS = 1 << TRI_H5_FLOAT64, NARROW = 1 << TRI_H5_INT32, NUMBERS = NARROW | 1 << TRI_H5_INT64 };

const struct tri_h5_form tri_h5_forms[TRI_H5_KINDS] = {
    {TRI_H5_POINTS, 2, true, TRI_H5_OF_POINTS, REALS},
    {TRI_H5_POINT_MARKERS, 0, false, TRI_H5_OF_POINTS, NARROW},
    {TRI_H5_POINT_ATTRIBUTES, -1, false, TRI_H5_OF_POINTS, REALS},
    {TRI_H5_TRIANGLES, 3, true, TRI_H5_OF_TRIANGLES, NUMBERS},
    {TRI_H5_TRIANGLE_ATTRIBUTES, -1, false, TRI_H5_OF_TRIANGLES, REALS | NARROW},
    {TRI_H5_SEGMENTS, 2, false, TRI_H5_OF_SEGMENTS, NUMBERS},
    {TRI_H5_SEGMENT_MARKERS, 0, false, TRI_H5_OF_SEGMENTS, NARROW},
};

static void put_markers(const int32_t *markers, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++)
        at = tri_put_i32(at, markers[i]);
}

static void put_reals(const double *reals, int64_t width, int32_t i, int32_t end, char *at)
{
    for (int64_t k = i * width; k < end * width; k++)
        at = tri_put_f64(at, reals[k]);
}

static void put_numbers(const int64_t *numbers, int width, enum tri_h5_type type, int32_t i, int32_t end, char *at)
{
    for (int64_t k = (int64_t)i * width; k < (int64_t)end * width; k++)
        at = type == TRI_H5_INT32 ? tri_put_i32(at, (int32_t)numbers[k]) : tri_put_i64(at, numbers[k]);
}

static void put_columns(const struct tri_h5_rows *rows, enum tri_h5_type type, int32_t i, int32_t end, char *at)
{
    for (; i < end; i++) {
        const double *columns = rows->columns + (int64_t)rows->tile->regions[i] * rows->n_columns;
        for (int32_t k = 0; k < rows->n_columns; k++)
            at = type == TRI_H5_INT32 ? tri_put_i32(at, (int32_t)columns[k]) : tri_put_f64(at, columns[k]);
    }
}

void tri_h5_put(const struct tri_h5_rows *rows, enum tri_h5_kind kind, enum tri_h5_type type, int32_t i, int32_t end,
                char *at)
{
    const struct tri_tile *tile = rows->tile;
    switch (kind) {
    case TRI_H5_OF_POINTS: put_reals(tile->points[0], 2, i, end, at); break;
    case TRI_H5_OF_POINT_MARKERS: put_markers(tile->point_markers, i, end, at); break;
    case TRI_H5_OF_POINT_ATTRIBUTES: put_reals(tile->attributes, rows->n_attributes, i, end, at); break;
    case TRI_H5_OF_TRIANGLES: put_numbers(tile->corners[0], 3, type, i, end, at); break;
    case TRI_H5_OF_TRIANGLE_ATTRIBUTES: put_columns(rows, type, i, end, at); break;
    case TRI_H5_OF_SEGMENTS: put_numbers(tile->ends[0], 2, type, i, end, at); break;
    case TRI_H5_OF_SEGMENT_MARKERS: put_markers(tile->segment_markers, i, end, at); break;
    case TRI_H5_KINDS: break;
    }
}

void tri_h5_extend_bounds(double bounds[4], const struct tri_tile *tile)
{
    for (int32_t i = 0; i < tile->n_vertices; i++) {
        const double *at = tile->points[i];
        bounds[0] = at[0] < bounds[0] ? at[0] : bounds[0];
        bounds[1] = at[1] < bounds[1] ? at[1] : bounds[1];
        bounds[2] = at[0] > bounds[2] ? at[0] : bounds[2];
        bounds[3] = at[1] > bounds[3] ? at[1] : bounds[3];
    }
}

/* --- buffers */

enum { BUFFER_BYTES = 1 << 20 };

/* An asynchronous write; at most one piece at a time. */
struct async {
    struct tri_async *handle; /* NULL: no write in progress */
    const char *data;             /* borrowed until the write is complete */
    size_t size;
    uint64_t place;
};

struct row_buffer {
    const struct tri_h5_plan *plan;
    int64_t next;
    int32_t n, room; /* rows in the buffer, and its capacity */
    char *buffer;    /* NULL: no rows so far */
    char *other;     /* second buffer, which is being written; NULL: not needed so far */
    struct async async;
};

struct tri_h5_part {
    struct tri_output *file;
    bool alone;
    struct tri_h5_rows rows;
    double *columns;
    struct row_buffer row_buffer[TRI_H5_KINDS];
};

static enum tri_status no_memory(const struct tri_h5_part *part, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, part->file->path, 0, "no memory to write rows of the file");
}

/* --- asynchronous writes */

static bool is_aligned(uint64_t place, const char *data, size_t size)
{
    return (place | (uint64_t)(uintptr_t)data | size) % TRI_PAGE_BYTES == 0;
}

/* Starts writing at an offset; no other write may be in progress. The data are borrowed until wait_async. Returns 0,
 * or a result for tri_output_conclude. */
static int start_async(struct async *async, struct tri_output *output, uint64_t place, const char *data, size_t size)
{
    assert(!async->handle && tri_output_has_offsets(output));
    if (tri_stop_is_asked(output->stop))
        return TRI_OUTPUT_STOPPED;
    const tri_file file = is_aligned(place, data, size) ? tri_output_direct(output) : output->file;
    *async = (struct async){tri_async_start(file, data, size, place), data, size, place};
    return async->handle ? 0 : tri_output_write_at(output, place, data, size);
}

/* Waits until the write in progress, if any, is complete. Returns the same. Bytes that could not be written
 * asynchronously are written directly. */
static int wait_async(struct async *async, const struct tri_output *output)
{
    if (!async->handle)
        return 0;
    const size_t done = tri_async_wait(async->handle);
    async->handle = NULL;
    return tri_output_write_at(output, async->place + done, async->data + done, async->size - done);
}

/* --- one array */

/* Allocates a page-aligned buffer, as required to bypass the system's cache. */
static char *new_buffer(const struct row_buffer *s)
{
    return tri_page_alloc((size_t)s->room * tri_h5_row_bytes(s->plan));
}

static bool allocate_buffer(const struct tri_h5_part *part, struct row_buffer *s)
{
    const size_t bytes = tri_h5_row_bytes(s->plan);
    s->room = part->alone ? s->plan->chunk_rows : bytes < BUFFER_BYTES ? (int32_t)(BUFFER_BYTES / bytes) : 1;
    s->buffer = new_buffer(s);
    return s->buffer;
}

/* Waits for the write in progress, then starts writing the buffer. Returns the same as tri_output_write_at. */
static int send_buffer(const struct tri_h5_part *part, struct row_buffer *s, uint64_t place, size_t bytes)
{
    int result = wait_async(&s->async, part->file);
    s->other = part->alone && !s->other ? new_buffer(s) : s->other;
    if (result || !s->other)
        return result ? result : tri_output_write_at(part->file, place, s->buffer, bytes);
    char *buffer = s->buffer;
    result = start_async(&s->async, part->file, place, buffer, bytes);
    s->buffer = s->other;
    s->other = buffer;
    return result;
}

static enum tri_status flush_buffer(const struct tri_h5_part *part, struct row_buffer *s, struct tri_error *error)
{
    const int64_t first = s->next - s->n, chunk_rows = s->plan->chunk_rows;
    const size_t row_bytes = tri_h5_row_bytes(s->plan), bytes = (size_t)s->n * row_bytes;
    if (s->n == 0)
        return TRI_OK;
    assert(first / chunk_rows < s->plan->n);
    const uint64_t place = (uint64_t)s->plan->place[first / chunk_rows] + (uint64_t)(first % chunk_rows) * row_bytes;
    s->n = 0;
    return tri_output_conclude(part->file, send_buffer(part, s, place, bytes), error);
}

/* Returns how many more rows fit in the buffer and in the current chunk. */
static int32_t room_of(const struct row_buffer *s)
{
    const int64_t here = s->plan->chunk_rows - s->next % s->plan->chunk_rows;
    return here < s->room - s->n ? (int32_t)here : s->room - s->n;
}

static bool is_full(const struct row_buffer *s)
{
    return s->n == s->room || (s->n > 0 && s->next % s->plan->chunk_rows == 0);
}

/* Adds rows. A full buffer is written only when more rows arrive, because the offset may be unknown before. */
static enum tri_status add_rows(struct tri_h5_part *part, enum tri_h5_kind kind, int64_t first, int32_t n,
                                struct tri_error *error)
{
    struct row_buffer *s = &part->row_buffer[kind];
    enum tri_status status = TRI_OK;
    if (s->plan->width == 0 || n == 0)
        return TRI_OK;
    if (!s->buffer && !allocate_buffer(part, s))
        return no_memory(part, error);
    if (first != s->next)
        status = flush_buffer(part, s, error);
    s->next = first;
    for (int32_t i = 0; !status && i < n;) {
        status = is_full(s) ? flush_buffer(part, s, error) : TRI_OK;
        const int32_t room = room_of(s), end = room < n - i ? i + room : n;
        tri_h5_put(&part->rows, kind, s->plan->type, i, end, s->buffer + (size_t)s->n * tri_h5_row_bytes(s->plan));
        s->n += end - i;
        s->next += end - i;
        i = end;
    }
    return status;
}

enum tri_status tri_h5_part_pause(struct tri_h5_part *part, enum tri_h5_kind kind, struct tri_error *error)
{
    struct row_buffer *s = &part->row_buffer[kind];
    enum tri_status status = flush_buffer(part, s, error);
    status = status ? status : tri_output_conclude(part->file, wait_async(&s->async, part->file), error);
    if (status)
        return status;
    free(s->buffer);
    free(s->other);
    s->buffer = s->other = NULL;
    return TRI_OK;
}

/* --- the part */

enum tri_status tri_h5_part_new(struct tri_h5_part **part, const struct tri_h5_layout *layout, bool alone,
                                const struct tri_stream *stream, struct tri_output *file, struct tri_error *error)
{
    struct tri_h5_part *p = calloc(1, sizeof *p);
    double *columns = tri_copy_columns(stream);
    *part = p;
    if (!p || !columns) {
        free(columns);
        return tri_fail(error, TRI_NO_MEMORY, file->path, 0, "no memory to write the file");
    }
    *p = (struct tri_h5_part){.file = file, .alone = alone, .columns = columns,
                              .rows = {NULL, columns, stream->n_attributes, stream->n_columns}};
    for (int kind = 0; kind < TRI_H5_KINDS; kind++)
        p->row_buffer[kind].plan = &layout->array[kind];
    return TRI_OK;
}

enum tri_status tri_h5_part_take(struct tri_h5_part *part, const struct tri_tile *tile, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    part->rows.tile = tile;
    for (enum tri_h5_kind kind = 0; !status && kind < TRI_H5_KINDS; kind++) {
        if (kind < TRI_H5_OF_TRIANGLES)
            status = add_rows(part, kind, tile->first_vertex, tile->n_vertices, error);
        else if (kind < TRI_H5_OF_SEGMENTS)
            status = add_rows(part, kind, tile->first_triangle, tile->n_triangles, error);
        else
            status = add_rows(part, kind, tile->first_segment, tile->n_segments, error);
    }
    return status;
}

enum tri_status tri_h5_part_end(struct tri_h5_part *part, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum tri_h5_kind kind = 0; !status && kind < TRI_H5_KINDS; kind++)
        status = tri_h5_part_pause(part, kind, error);
    return status;
}

void tri_h5_part_free(struct tri_h5_part *part)
{
    for (int kind = 0; part && kind < TRI_H5_KINDS; kind++) {
        struct row_buffer *s = &part->row_buffer[kind];
        (void)wait_async(&s->async, part->file);
        free(s->buffer);
        free(s->other);
    }
    if (part)
        free(part->columns);
    free(part);
}
