/* A dataset for an array that grows row by row and whose length is unknown until it ends.
 *
 * Rows are written directly to their offsets in the file, without HDF5 (triangle/hdf5/rows.h). The caller decides when
 * chunks are allocated, independently of when they fill up. So the layout of the file need not depend on the order in
 * which rows of several arrays arrive. An array without allocated chunks, whose rows fit in one chunk, becomes a
 * contiguous dataset of exactly its size. */
#ifndef TRIANGLE_HDF5_ARRAY_H
#define TRIANGLE_HDF5_ARRAY_H

#include "triangle/hdf5/rows.h"
#include "triangle/hdf5/file.h"

struct tri_h5_array {
    struct tri_h5_file *file; /* borrowed; NULL: the array does not exist */
    const char *name;         /* name of the dataset; borrowed */
    bool is_list;             /* one-dimensional; its width is 1 */
    struct tri_h5_plan *plan; /* offsets of its rows; borrowed, except the array of offsets */
    int64_t n;                /* number of rows, after the end */
    hid_t dataset;            /* < 0: not allocated */
};

/* Begins a two-dimensional array [n][width] or, if width is 0, a one-dimensional array [n]. */
void tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                        struct tri_h5_plan *plan, enum tri_h5_type type, int32_t width, int32_t chunk_rows);

/* Allocates chunks until there are n_chunks. TRI_NO_MEMORY, and errors of writing, as for all functions here. */
enum tri_status tri_h5_array_allocate(struct tri_h5_array *array, int64_t n_chunks, struct tri_error *error);

/* Changes the integers of an array to 64 bits. Rows that are in the file are rewritten, in as many chunks as were
 * allocated. The freed space is reused. */
enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error);

/* Sets the number of rows to n and closes the dataset. Frees chunks that are not needed; an array without chunks is
 * allocated now. Rows may be written afterwards. */
enum tri_status tri_h5_array_end(struct tri_h5_array *array, int64_t n, struct tri_error *error);

/* Call it after the end, and after any error. */
void tri_h5_array_free(struct tri_h5_array *array);

hid_t tri_h5_type_id(enum tri_h5_type type); /* type of the elements in the file */

#endif
