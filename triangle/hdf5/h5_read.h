/* Reads slices of a mesh from an HDF5 file (triangle/hdf5/rows.h), so that one of any size can be gone through. What
 * wants no more than points and triangles may come from another program, if its arrays are such as ours: of our types,
 * uncompressed, in full in the file itself. Calls come from one thread at a time. */
#ifndef TRIANGLE_HDF5_H5_READ_H
#define TRIANGLE_HDF5_H5_READ_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/hdf5/rows.h"

struct tri_h5;

struct tri_h5_counts {
    int64_t points, triangles, segments;
    int64_t input_points;  /* the first so many were there before refinement; -1: not known */
    int32_t attributes;    /* of a point */
    int32_t columns;       /* attributes of a triangle */
    bool point_markers, lists_segments, segment_markers; /* there are any */
};

/* Opens a file; path must live as long. TRI_CANNOT_READ: no such file, no HDF5 file, or no HDF5 in this build;
 * TRI_BAD_INPUT: it holds no such mesh; TRI_NO_MEMORY. *h5 is NULL then. */
enum tri_status tri_h5_open(const char *path, struct tri_h5 **h5, struct tri_error *error);

/* NULL is fine. */
void tri_h5_free(struct tri_h5 *h5);

const struct tri_h5_counts *tri_h5_count(const struct tri_h5 *h5);

/* Rows first .. first + n - 1, which are there: reals are doubles, markers int32_t, numbers of points int64_t. Of an
 * array that is not there: markers 0, nothing else. Values are as the file has them, and not looked at.
 * TRI_CANNOT_READ, TRI_NO_MEMORY. */
enum tri_status tri_h5_read(const struct tri_h5 *h5, enum tri_h5_kind kind, int64_t first, int64_t n, void *out,
                            struct tri_error *error);

#endif
