/* The layout of a mesh in an HDF5 file, for its writers and readers; described for users in docs/formats.md.
 *
 *     /points              [n][2] float64
 *     /point_markers       [n]    int32                       unless markers are left out
 *     /point_attributes    [n][any] float64                   if there are any
 *     /triangles           [m][3] int32, or int64 if a point number does not fit
 *     /triangle_attributes [m][any] int32 if all are integers that fit, otherwise float64; if there are any
 *     /segments            [s][2] as /triangles
 *     /segment_markers     [s]    int32                       unless markers are left out
 *     /about               attributes that describe the contents of the file
 *
 * There are also views for programs that expect other names (triangle/hdf5/views.h). Numbers count from 0; arrays are
 * row-major and little-endian. */
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
#define TRI_H5_ABOUT_VERSION "version"          /* int64, version of the format */
#define TRI_H5_ABOUT_INPUT_POINTS "input_points" /* number of leading points that existed before refinement */

enum { TRI_H5_VERSION = 1 };

/* In the order of their offsets. */
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

/* The required form of an array. */
struct tri_h5_form {
    const char *name;
    int32_t width;            /* numbers in a row; 0: one-dimensional; -1: any */
    bool needed;              /* every file must have it */
    enum tri_h5_kind rows_of; /* it has as many rows as this array */
    unsigned types;           /* allowed types: bits 1 << enum tri_h5_type */
};
extern const struct tri_h5_form tri_h5_forms[TRI_H5_KINDS];

struct tri_h5_rows {
    const struct tri_tile *tile;
    const double *columns; /* [regions][n_columns] attributes of the triangles in each region */
    int32_t n_attributes, n_columns;
};

/* Stores rows i to end - 1 of the tile's array at `at`. */
void tri_h5_put(const struct tri_h5_rows *rows, enum tri_h5_kind kind, enum tri_h5_type type, int32_t i, int32_t end,
                char *at);

/* Extends bounds (least x, least y, largest x, largest y) by the tile's points. */
void tri_h5_extend_bounds(double bounds[4], const struct tri_tile *tile);

/* --- writing rows without HDF5
 *
 * One process writes all rows, or several processes write parts of them in parallel. */

/* The offsets of the rows of all arrays; the same on all machines that write parts, except for the pointers. */
struct tri_h5_layout {
    struct tri_h5_plan {
        enum tri_h5_type type;
        int32_t width, chunk_rows; /* numbers in a row, 0: no such array; rows in a chunk */
        int64_t n, *place;         /* [n] offsets of the chunks in the file, in bytes */
    } array[TRI_H5_KINDS];
};

static inline size_t tri_h5_row_bytes(const struct tri_h5_plan *plan)
{
    return (plan->type == TRI_H5_INT32 ? 4u : 8u) * (size_t)plan->width;
}

struct tri_h5_part;

/* All arguments are borrowed, except the stream, from which the tiles will come. The layout may grow: when rows of an
 * array fill a chunk, the offset of that chunk must be known, and all offsets at the end. alone: no other process
 * writes the file. Then buffers hold one chunk each, 20 MB in total, and are written asynchronously; otherwise they
 * take 7 MB. TRI_NO_MEMORY. */
enum tri_status tri_h5_part_new(struct tri_h5_part **part, const struct tri_h5_layout *layout, bool alone,
                                const struct tri_stream *stream, struct tri_output *file, struct tri_error *error);

/* Writes the rows of a tile; tiles must come in the order of their numbers. Errors of triangle/text/output.h. */
enum tri_status tri_h5_part_take(struct tri_h5_part *part, const struct tri_tile *tile, struct tri_error *error);

/* Flushes all rows to the file. */
enum tri_status tri_h5_part_end(struct tri_h5_part *part, struct tri_error *error);

/* Flushes the rows of one array to the file. Later rows may have a wider type. */
enum tri_status tri_h5_part_pause(struct tri_h5_part *part, enum tri_h5_kind kind, struct tri_error *error);

/* NULL is allowed. */
void tri_h5_part_free(struct tri_h5_part *part);

#endif
