/* An array of an HDF5 file that grows row by row, its length unknown until it ends.
 *
 * Rows gather in a buffer, as bytes of the file. A full buffer becomes a chunk of the dataset, written past HDF5's
 * caches in one piece, while rows gather in a second buffer. Where chunks lie in the file is decided by whoever
 * allocates them, not by when they are full: so what the file holds need not depend on the order in which rows of
 * several arrays come. An array whose rows fit in the buffer, and for which nothing was allocated, is a dataset without
 * chunks, of just its size. */
#ifndef TRIANGLE_HDF5_ARRAY_H
#define TRIANGLE_HDF5_ARRAY_H

#include "triangle/hdf5/file.h"
#include "triangle/hdf5/rows.h"

/* May not move once something is allocated for it. */
struct tri_h5_array {
    struct tri_h5_file *file; /* borrowed; NULL: there is no such array */
    const char *name;
    enum tri_h5_type type;
    int32_t width;     /* numbers in a row */
    bool is_list;      /* of one dimension; width is 1 */
    int32_t chunk_rows;
    int64_t n;         /* rows so far */
    int32_t n_buffer;  /* the last of them, which are in the buffer and not in the file */
    char *buffer;      /* [chunk_rows] rows */
    char *other;       /* as large: what is on its way into the file; NULL: none was needed */
    struct tri_behind behind;
    int64_t n_chunks;  /* allocated in the file */
    hid_t dataset;     /* < 0: nothing is allocated */
};

/* Begins an array of tables [n][width], or, where width is 0, of lists [n]. TRI_NO_MEMORY. */
enum tri_status tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                                   enum tri_h5_type type, int32_t width, int32_t chunk_rows, struct tri_error *error);

/* Gives the array so many chunks in all, if it has fewer. */
enum tri_status tri_h5_array_allocate(struct tri_h5_array *array, int64_t n_chunks, struct tri_error *error);

/* Where the next rows go, and how many there is room for, at least one. If the buffer is full, it is written: a chunk
 * must have been allocated for it, else TRI_INTERNAL. */
enum tri_status tri_h5_array_room(struct tri_h5_array *array, char **at, int32_t *rows, struct tri_error *error);

/* So many rows have been put there. */
void tri_h5_array_advance(struct tri_h5_array *array, int32_t rows);

/* From now on the integers have 64 bits; those that there are already are rewritten. TRI_NO_MEMORY and errors of
 * writing. Reads and writes what has been written; the space in the file is used again. */
enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error);

/* Instead of rows: the array has n of them, in so many chunks as have been allocated, or in one piece. place receives
 * where each of the chunks that n rows fill lies in the file, or the piece. Then the dataset is closed, and somebody
 * else puts the rows there. */
enum tri_status tri_h5_array_lay_out(struct tri_h5_array *array, int64_t n, int64_t *place, struct tri_error *error);

/* Writes the rest, gives back chunks that were not needed, and closes the dataset. */
enum tri_status tri_h5_array_end(struct tri_h5_array *array, struct tri_error *error);

/* After any error, and after the end. */
void tri_h5_array_free(struct tri_h5_array *array);

hid_t tri_h5_type_id(enum tri_h5_type type); /* in the file */

#endif
