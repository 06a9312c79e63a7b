/* Rows of the arrays of an HDF5 file on their way to their places, without HDF5: all of them, or the part that one of
 * several processes has; these may write at a time. */
#ifndef TRIANGLE_HDF5_BUFFER_H
#define TRIANGLE_HDF5_BUFFER_H

#include "triangle/hdf5/rows.h"
#include "triangle/text/output.h"

/* Where the rows of all arrays lie; the same on all machines that may write parts, but for the pointers. */
struct tri_h5_layout {
    struct tri_h5_laid {
        enum tri_h5_type type;
        int32_t width, chunk_rows; /* numbers in a row, 0: there is no such array; rows at a place */
        int64_t n, *place;         /* [n] in bytes from the begin of the file */
    } array[TRI_H5_KINDS];
};

static inline size_t tri_h5_row_bytes(const struct tri_h5_laid *laid)
{
    return (laid->type == TRI_H5_INT32 ? 4u : 8u) * (size_t)laid->width;
}

struct tri_h5_part;

/* All are borrowed but the stream, which is that of the tiles to come. Of a layout that grows: whenever rows of an
 * array fill its chunk_rows the place for these must be known, and all at the end. alone: nobody else writes
 * the file. Then buffers hold a chunk each, 20 MB in all, and are written behind the caller's back; else 7 MB.
 * TRI_NO_MEMORY. */
enum tri_status tri_h5_part_new(struct tri_h5_part **part, const struct tri_h5_layout *layout, bool alone,
                                const struct tri_stream *stream, struct tri_output *file, struct tri_error *error);

/* Rows of the arrays that there are; tiles come in the order of their numbers. Errors of triangle/text/output.h. */
enum tri_status tri_h5_part_take(struct tri_h5_part *part, const struct tri_tile *tile, struct tri_error *error);

/* All that has come is in the file afterwards. */
enum tri_status tri_h5_part_end(struct tri_h5_part *part, struct tri_error *error);

/* All rows of an array that have come are in the file afterwards; those to come may be wider. */
enum tri_status tri_h5_part_pause(struct tri_h5_part *part, enum tri_h5_kind kind, struct tri_error *error);

/* NULL is fine. */
void tri_h5_part_free(struct tri_h5_part *part);

#endif
