/* Small things in an HDF5 file: groups and attributes, by paths that begin at its root. False: HDF5 could not
 * (tri_h5_fail tells). */
#ifndef TRIANGLE_HDF5_ITEMS_H
#define TRIANGLE_HDF5_ITEMS_H

#include "triangle/hdf5/file.h"

bool tri_h5_add_group(struct tri_h5_file *file, const char *path);

/* An attribute of n numbers, or, where n is 0, of a single one that is no array. */
bool tri_h5_add_integers(struct tri_h5_file *file, const char *path, const char *name, int n, const int64_t *values);
bool tri_h5_add_reals(struct tri_h5_file *file, const char *path, const char *name, int n, const double *values);
bool tri_h5_add_text(struct tri_h5_file *file, const char *path, const char *name, const char *text);

#endif
