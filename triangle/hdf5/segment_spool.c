/* The spool holds batches of TRI_H5_KEPT_SEGMENTS: their ends, then their markers, as they lie in memory. */
#include "triangle/hdf5/segment_spool.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"

enum { END_BYTES = TRI_H5_KEPT_SEGMENTS * 16, BATCH_BYTES = TRI_H5_KEPT_SEGMENTS * 20 };

enum tri_status tri_h5_segments_begin(struct tri_h5_segments *segments, struct tri_output *spool,
                                      struct tri_error *error)
{
    *segments = (struct tri_h5_segments){.spool = spool, .ends = malloc(END_BYTES),
                                         .markers = malloc(BATCH_BYTES - END_BYTES)};
    if (segments->ends && segments->markers)
        return TRI_OK;
    return tri_fail(error, TRI_NO_MEMORY, spool->path, 0, "no memory to write segments");
}

void tri_h5_segments_free(struct tri_h5_segments *segments)
{
    free(segments->ends);
    free(segments->markers);
    *segments = (struct tri_h5_segments){0};
}

/* The first place of the batch that begins with segment i. */
static uint64_t place_of(int64_t i) { return (uint64_t)(i / TRI_H5_KEPT_SEGMENTS) * BATCH_BYTES; }

static enum tri_status write_batch(struct tri_h5_segments *s, struct tri_error *error)
{
    const uint64_t place = place_of(s->n - 1);
    int result = tri_output_write_at(s->spool, place, (const char *)s->ends, END_BYTES);
    if (result == 0)
        result = tri_output_write_at(s->spool, place + END_BYTES, (const char *)s->markers, BATCH_BYTES - END_BYTES);
    return tri_output_conclude(s->spool, result, error);
}

enum tri_status tri_h5_segments_add(struct tri_h5_segments *s, const struct tri_tile *tile, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; i < tile->n_segments && !status; i++) {
        const int64_t k = s->n % TRI_H5_KEPT_SEGMENTS;
        if (s->n > 0 && k == 0)
            status = write_batch(s, error);
        memcpy(s->ends[k], tile->ends[i], sizeof s->ends[k]);
        s->markers[k] = tile->segment_markers[i];
        s->n++;
    }
    return status;
}

static bool read_batch(struct tri_h5_segments *s)
{
    const uint64_t place = place_of(s->n_read);
    return tri_read_again(s->spool->file, (char *)s->ends, END_BYTES, place) &&
           tri_read_again(s->spool->file, (char *)s->markers, BATCH_BYTES - END_BYTES, place + END_BYTES);
}

enum tri_status tri_h5_segments_next(struct tri_h5_segments *s, struct tri_tile *tile, struct tri_error *error)
{
    const int64_t left = s->n - s->n_read;
    const bool spooled = s->n > TRI_H5_KEPT_SEGMENTS;
    enum tri_status status = TRI_OK;
    if (spooled && s->n_read == 0) /* the last batch makes room for the first */
        status = write_batch(s, error);
    if (!status && spooled && !(left > 0 ? read_batch(s) : tri_file_cut(s->spool->file, 0)))
        status = tri_fail_system(error, TRI_CANNOT_WRITE, s->spool->path, "cannot read segments again", errno);
    *tile = (struct tri_tile){.ends = (const int64_t(*)[2])s->ends, .segment_markers = s->markers,
                              .first_segment = s->n_read};
    tile->n_segments = (int32_t)(left < TRI_H5_KEPT_SEGMENTS ? left : TRI_H5_KEPT_SEGMENTS);
    s->n_read += tile->n_segments;
    return status;
}
