/* A part of the rows of an HDF5 file whose arrays have their places: written there by whoever has them, without HDF5.
 * Parts of one file may be written by several processes at a time. */
#ifndef TRIANGLE_HDF5_BUFFER_H
#define TRIANGLE_HDF5_BUFFER_H

#include "triangle/hdf5/rows.h"
#include "triangle/text/output.h"

/* Where the rows of all arrays lie; the same on all machines that may write parts. */
struct tri_h5_layout {
    struct tri_h5_laid {
        enum tri_h5_type type;
        int32_t width, chunk_rows; /* numbers in a row, rows at a place */
        int64_t first, n;          /* in the list of places; n = 0: there is no such array */
    } array[TRI_H5_KINDS];
    int64_t n; /* places of all arrays, in bytes from the begin of the file */
};

struct tri_h5_part;

/* All are borrowed but the stream, which is that of the tiles to come. TRI_NO_MEMORY: about 7 MB. */
enum tri_status tri_h5_part_new(struct tri_h5_part **part, const struct tri_h5_layout *layout, const int64_t *place,
                                const struct tri_stream *stream, struct tri_output *file, struct tri_error *error);

/* Tiles come in the order of their numbers; after the end all has been written. Errors of triangle/text/output.h. */
enum tri_status tri_h5_part_take(struct tri_h5_part *part, const struct tri_tile *tile, struct tri_error *error);
enum tri_status tri_h5_part_end(struct tri_h5_part *part, struct tri_error *error);

/* NULL is fine. */
void tri_h5_part_free(struct tri_h5_part *part);

#endif
