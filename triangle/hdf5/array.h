/* An array of an HDF5 file that grows row by row, its length unknown until it ends.
 *
 * Rows gather in a buffer of TRI_H5_CHUNK_ROWS of them, as bytes of the file. A full buffer becomes a chunk of the
 * dataset, written past HDF5's caches in one piece. An array that ends before its first chunk is full is a dataset
 * without chunks, of just its size. What the file holds depends on the rows alone, not on the pieces they came in. */
#ifndef TRIANGLE_HDF5_ARRAY_H
#define TRIANGLE_HDF5_ARRAY_H

#include "triangle/hdf5/file.h"

enum { TRI_H5_CHUNK_ROWS = 1 << 18 }; /* 1 to 6 MiB each */

enum tri_h5_type { TRI_H5_FLOAT64, TRI_H5_INT32, TRI_H5_INT64 };

struct tri_h5_array {
    struct tri_h5_file *file; /* borrowed; NULL: there is no such array */
    const char *name;
    enum tri_h5_type type;
    int32_t width;     /* numbers in a row */
    bool is_list;      /* of one dimension; width is 1 */
    int64_t n;         /* rows so far */
    char *buffer;      /* [TRI_H5_CHUNK_ROWS] rows, those behind the last full chunk */
    hid_t dataset;     /* < 0: the first chunk is not full yet */
};

/* Begins an array of tables [n][width], or, where width is 0, of lists [n]. TRI_NO_MEMORY. */
enum tri_status tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                                   enum tri_h5_type type, int32_t width, struct tri_error *error);

/* Where the next rows go, and how many there is room for, at least one. */
char *tri_h5_array_room(struct tri_h5_array *array, int32_t *rows);

/* So many rows have been put there. */
enum tri_status tri_h5_array_advance(struct tri_h5_array *array, int32_t rows, struct tri_error *error);

/* From now on the integers have 64 bits; those that there are already are rewritten. TRI_NO_MEMORY and errors of
 * writing. Reads and writes what has been written; the space in the file is used again. */
enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error);

/* Writes the rest, and closes the dataset. */
enum tri_status tri_h5_array_end(struct tri_h5_array *array, struct tri_error *error);

/* After any error, and after the end. */
void tri_h5_array_free(struct tri_h5_array *array);

hid_t tri_h5_type_id(enum tri_h5_type type); /* in the file */

#endif
