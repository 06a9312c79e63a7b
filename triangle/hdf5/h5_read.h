/* Reads slices of a mesh from an HDF5 file (triangle/hdf5/rows.h), so that meshes of any size can be processed. If only
 * points and triangles are needed, the file may come from another program, provided that its arrays are like ours: the
 * same types, uncompressed, and complete in the file itself. Call from one thread at a time. */
#ifndef TRIANGLE_HDF5_H5_READ_H
#define TRIANGLE_HDF5_H5_READ_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/hdf5/rows.h"

struct tri_h5;

struct tri_h5_counts {
    int64_t points, triangles, segments;
    int64_t input_points;  /* number of leading points that existed before refinement; -1: unknown */
    int32_t attributes;    /* attributes of each point */
    int32_t columns;       /* attributes of each triangle */
    bool point_markers, lists_segments, segment_markers; /* whether these arrays exist */
};

/* Opens a file; path must live as long. Sets *h5 to NULL on failure. TRI_CANNOT_READ: no such file, not an HDF5 file,
 * or no HDF5 in this build; TRI_BAD_INPUT: the file does not contain such a mesh; TRI_NO_MEMORY. */
enum tri_status tri_h5_open(const char *path, struct tri_h5 **h5, struct tri_error *error);

/* NULL is allowed. */
void tri_h5_free(struct tri_h5 *h5);

const struct tri_h5_counts *tri_h5_count(const struct tri_h5 *h5);

/* Reads rows first .. first + n - 1, which must exist: reals as double, markers as int32_t, point numbers as int64_t.
 * If the array does not exist, markers are 0 and other arrays are left unchanged. Values are not checked.
 * TRI_CANNOT_READ, TRI_NO_MEMORY. */
enum tri_status tri_h5_read(const struct tri_h5 *h5, enum tri_h5_kind kind, int64_t first, int64_t n, void *out,
                            struct tri_error *error);

#endif
