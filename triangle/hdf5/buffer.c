/* INVARIANT between calls: the buffer of an array holds its rows next - n to next - 1, which lie at one place and have
 * not been written; all that have come before have been. */
#include "triangle/hdf5/buffer.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

enum { BUFFER_BYTES = 1 << 20 };

struct strip {
    struct tri_h5_laid laid;
    const int64_t *place; /* [laid.n] */
    size_t row_bytes;
    int64_t next;
    int32_t n, room;      /* rows in the buffer, at most */
    char *buffer;
};

struct tri_h5_part {
    struct tri_output *file;
    struct tri_h5_rows rows;
    double *columns;
    struct strip strip[TRI_H5_KINDS];
};

/* --- one array */

static bool begin_strip(struct strip *s, const struct tri_h5_laid *laid, const int64_t *place)
{
    if (laid->n == 0)
        return true;
    *s = (struct strip){.laid = *laid, .place = place + laid->first};
    s->row_bytes = (laid->type == TRI_H5_INT32 ? 4u : 8u) * (size_t)laid->width;
    s->room = s->row_bytes < BUFFER_BYTES ? (int32_t)(BUFFER_BYTES / s->row_bytes) : 1;
    s->buffer = malloc((size_t)s->room * s->row_bytes);
    return s->buffer;
}

static enum tri_status flush(struct tri_h5_part *part, struct strip *s, struct tri_error *error)
{
    const int64_t first = s->next - s->n;
    const size_t bytes = (size_t)s->n * s->row_bytes;
    if (s->n == 0)
        return TRI_OK;
    assert(first / s->laid.chunk_rows < s->laid.n);
    const uint64_t place = (uint64_t)s->place[first / s->laid.chunk_rows] +
                           (uint64_t)(first % s->laid.chunk_rows) * s->row_bytes;
    s->n = 0;
    return tri_output_conclude(part->file, tri_output_write_at(part->file, place, s->buffer, bytes), error);
}

/* How many rows may follow, as far as the buffer and the place reach. */
static int32_t room_of(const struct strip *s)
{
    const int64_t here = s->laid.chunk_rows - s->next % s->laid.chunk_rows;
    return here < s->room - s->n ? (int32_t)here : s->room - s->n;
}

static enum tri_status add_rows(struct tri_h5_part *part, enum tri_h5_kind kind, int64_t first, int32_t n,
                                struct tri_error *error)
{
    struct strip *s = &part->strip[kind];
    enum tri_status status = TRI_OK;
    if (!s->buffer || n == 0)
        return TRI_OK;
    if (first != s->next)
        status = flush(part, s, error);
    s->next = first;
    for (int32_t i = 0; !status && i < n;) {
        const int32_t room = room_of(s), end = room < n - i ? i + room : n;
        tri_h5_put_of(kind, s->laid.type)(&part->rows, i, end, s->buffer + (size_t)s->n * s->row_bytes);
        s->n += end - i;
        s->next += end - i;
        i = end;
        if (s->n == s->room || s->next % s->laid.chunk_rows == 0)
            status = flush(part, s, error);
    }
    return status;
}

/* --- all */

enum tri_status tri_h5_part_new(struct tri_h5_part **part, const struct tri_h5_layout *layout, const int64_t *place,
                                const struct tri_stream *stream, struct tri_output *file, struct tri_error *error)
{
    const size_t n = (size_t)stream->n_regions * (size_t)stream->n_columns;
    struct tri_h5_part *p = calloc(1, sizeof *p);
    *part = p;
    bool memory = p;
    if (p) {
        p->file = file;
        p->columns = malloc((n + 1) * sizeof *p->columns);
        p->rows = (struct tri_h5_rows){NULL, p->columns, stream->n_attributes, stream->n_columns};
        memory = p->columns;
    }
    for (int kind = 0; memory && kind < TRI_H5_KINDS; kind++)
        memory = begin_strip(&p->strip[kind], &layout->array[kind], place);
    if (!memory)
        return tri_fail(error, TRI_NO_MEMORY, file->path, 0, "no memory to write a part of the file");
    if (n > 0)
        memcpy(p->columns, stream->regions, n * sizeof *p->columns);
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
    for (int kind = 0; !status && kind < TRI_H5_KINDS; kind++)
        status = flush(part, &part->strip[kind], error);
    return status;
}

void tri_h5_part_free(struct tri_h5_part *part)
{
    if (!part)
        return;
    for (int kind = 0; kind < TRI_H5_KINDS; kind++)
        free(part->strip[kind].buffer);
    free(part->columns);
    free(part);
}
