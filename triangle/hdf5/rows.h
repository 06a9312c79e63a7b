/* The arrays of a mesh in an HDF5 file (triangle/hdf5/layout.h), and rows of a tile as bytes of them. */
#ifndef TRIANGLE_HDF5_ROWS_H
#define TRIANGLE_HDF5_ROWS_H

#include "ptriangle/tiles.h"

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

#endif
