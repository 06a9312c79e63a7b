/* What stands where in an HDF5 file of a mesh, for those who write one and those who read it; docs/formats.md tells it
 * to users.
 *
 *     /points              [n][2] float64
 *     /point_markers       [n]    int32                       unless markers are left out
 *     /point_attributes    [n][any] float64                   where there are any
 *     /triangles           [m][3] int32, or int64 where a number of a point does not fit
 *     /triangle_attributes [m][any] int32 where all are whole numbers that fit, else float64; where there are any
 *     /segments            [s][2] as /triangles
 *     /segment_markers     [s]    int32                       unless markers are left out
 *     /about               its attributes say what the file holds
 *
 * Beside them stand views for programs that look elsewhere (triangle/hdf5/views.h). Numbers count from 0 and lie in
 * memory's order, little-endian. */
#ifndef TRIANGLE_HDF5_ROWS_H
#define TRIANGLE_HDF5_ROWS_H

#include "ptriangle/tiles.h"
#include "triangle/text/output.h"

#define TRI_H5_POINTS "points"
#define TRI_H5_POINT_MARKERS "point_markers"
#define TRI_H5_POINT_ATTRIBUTES "point_attributes"
#define TRI_H5_TRIANGLES "triangles"
#define TRI_H5_TRIANGLE_ATTRIBUTES "triangle_attributes"
#define TRI_H5_SEGMENTS "segments"
#define TRI_H5_SEGMENT_MARKERS "segment_markers"

#define TRI_H5_ABOUT "about"
#define TRI_H5_ABOUT_VERSION "version"          /* int64, of the format */
#define TRI_H5_ABOUT_INPUT_POINTS "input_points" /* the first so many were there before refinement */

enum { TRI_H5_VERSION = 1 };

/* In the order in which they are laid out. */
enum tri_h5_kind {
    TRI_H5_OF_POINTS,
    TRI_H5_OF_POINT_MARKERS,
    TRI_H5_OF_POINT_ATTRIBUTES,
    TRI_H5_OF_TRIANGLES,
    TRI_H5_OF_TRIANGLE_ATTRIBUTES,
    TRI_H5_OF_SEGMENTS,
    TRI_H5_OF_SEGMENT_MARKERS,
    TRI_H5_KINDS
};

enum tri_h5_type { TRI_H5_FLOAT64, TRI_H5_INT32, TRI_H5_INT64 };

/* What an array must look like. */
struct tri_h5_form {
    const char *name;
    int32_t width;            /* numbers in a row; 0: a list, -1: a table of any */
    bool needed;
    enum tri_h5_kind rows_of; /* it has as many rows as this */
    unsigned types;           /* that it may have: bits 1 << enum tri_h5_type */
};
extern const struct tri_h5_form tri_h5_forms[TRI_H5_KINDS];

struct tri_h5_rows {
    const struct tri_tile *tile;
    const double *columns; /* [regions][n_columns] */
    int32_t n_attributes, n_columns;
};

/* Puts rows i to end - 1 of the tile's array at `at`. */
void tri_h5_put(const struct tri_h5_rows *rows, enum tri_h5_kind kind, enum tri_h5_type type, int32_t i, int32_t end,
                char *at);

/* Least x, least y, largest x, largest y, of these and of the tile's points. */
void tri_h5_extend_bounds(double bounds[4], const struct tri_tile *tile);

/* --- rows on their way to their places, without HDF5
 *
 * All of them, or the part that one of several processes has; these may write at a time. */

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
