/* The dataset of an array that grows row by row, its length unknown until it ends.
 *
 * Its rows go past HDF5, straight to their places in the file (triangle/hdf5/rows.h). Where chunks lie is decided by
 * whoever allocates them, not by when they are full: so what the file holds need not depend on the order in which rows
 * of several arrays come. An array whose rows fit in one chunk, and for which nothing was allocated, is a dataset
 * without chunks, of just its size. */
#ifndef TRIANGLE_HDF5_ARRAY_H
#define TRIANGLE_HDF5_ARRAY_H

#include "triangle/hdf5/rows.h"
#include "triangle/hdf5/file.h"

struct tri_h5_array {
    struct tri_h5_file *file; /* borrowed; NULL: there is no such array */
    const char *name;
    bool is_list;             /* of one dimension; its width is 1 */
    struct tri_h5_laid *laid; /* where its rows go; borrowed, but for the list of places */
    int64_t n;                /* rows, once it has ended */
    hid_t dataset;            /* < 0: nothing is allocated */
};

/* Begins an array of tables [n][width], or, where width is 0, of lists [n]. */
void tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                        struct tri_h5_laid *laid, enum tri_h5_type type, int32_t width, int32_t chunk_rows);

/* Gives the array so many chunks in all, if it has fewer. TRI_NO_MEMORY, and errors of writing, as of all. */
enum tri_status tri_h5_array_allocate(struct tri_h5_array *array, int64_t n_chunks, struct tri_error *error);

/* From now on the integers have 64 bits; those that are in the file already are rewritten, with the chunks that have
 * been allocated. The space in the file is used again. */
enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error);

/* The array has n rows: chunks that are not needed are given back, what has none gets its place, and the dataset is
 * closed. Rows may be put there afterwards. */
enum tri_status tri_h5_array_end(struct tri_h5_array *array, int64_t n, struct tri_error *error);

/* After any error, and after the end. */
void tri_h5_array_free(struct tri_h5_array *array);

hid_t tri_h5_type_id(enum tri_h5_type type); /* in the file */

#endif
