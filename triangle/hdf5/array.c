/* Chunks of an array, from a buffer into the file.
 *
 * INVARIANT between calls: the buffer holds the last n_buffer <= chunk_rows rows; those before it are a whole number of
 * chunks, and in the file, but for at most one that is on its way there from the other buffer. */
#include "triangle/hdf5/array.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

static size_t number_bytes(enum tri_h5_type type) { return type == TRI_H5_INT32 ? 4 : 8; }

static size_t row_bytes(const struct tri_h5_array *array)
{
    return number_bytes(array->type) * (size_t)array->width;
}

static size_t chunk_bytes(const struct tri_h5_array *array) { return (size_t)array->chunk_rows * row_bytes(array); }

static int dimensions(const struct tri_h5_array *array) { return array->is_list ? 1 : 2; }

hid_t tri_h5_type_id(enum tri_h5_type type)
{
    return type == TRI_H5_FLOAT64 ? H5T_IEEE_F64LE : type == TRI_H5_INT32 ? H5T_STD_I32LE : H5T_STD_I64LE;
}

static enum tri_status no_memory(const struct tri_h5_array *array, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, array->file->output->path, 0, "no memory to write %s", array->name);
}

/* Where bytes go that may pass the system's cache. */
static char *new_buffer(size_t bytes)
{
    void *buffer = NULL;
    return posix_memalign(&buffer, TRI_BEHIND_BYTES, bytes) == 0 ? buffer : NULL;
}

enum tri_status tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                                   enum tri_h5_type type, int32_t width, int32_t chunk_rows, struct tri_error *error)
{
    *array = (struct tri_h5_array){.file = file, .name = name, .type = type, .width = width > 0 ? width : 1,
                                   .is_list = width == 0, .chunk_rows = chunk_rows, .dataset = -1};
    array->buffer = new_buffer(chunk_bytes(array));
    return array->buffer ? TRI_OK : no_memory(array, error);
}

void tri_h5_array_free(struct tri_h5_array *array)
{
    if (array->file)
        tri_h5_wait(array->file, &array->behind);
    if (array->file && array->dataset >= 0)
        H5Dclose(array->dataset);
    free(array->buffer);
    free(array->other);
    *array = (struct tri_h5_array){.dataset = -1};
}

/* --- datasets */

/* How the dataset is kept: in chunks or in one piece, which have their place as soon as they are part of it and are not
 * filled before they are written. < 0: an error. */
static hid_t creation_of(const struct tri_h5_array *array, bool in_chunks)
{
    const hsize_t chunk[2] = {(hsize_t)array->chunk_rows, (hsize_t)array->width};
    hid_t creation = tri_h5_no_times(H5P_DATASET_CREATE);
    if (creation < 0)
        return creation;
    if ((!in_chunks || H5Pset_chunk(creation, dimensions(array), chunk) >= 0) &&
        H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY) >= 0 &&
        H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER) >= 0)
        return creation;
    H5Pclose(creation);
    return -1;
}

/* A dataset of n rows; < 0: an error. */
static hid_t create_dataset(const struct tri_h5_array *array, int64_t n, bool in_chunks)
{
    const hsize_t size[2] = {(hsize_t)n, (hsize_t)array->width}, most[2] = {H5S_UNLIMITED, (hsize_t)array->width};
    hid_t space = H5Screate_simple(dimensions(array), size, in_chunks ? most : NULL);
    hid_t creation = creation_of(array, in_chunks), dataset = -1;
    if (space >= 0 && creation >= 0)
        dataset = H5Dcreate2(array->file->id, array->name, tri_h5_type_id(array->type), space, H5P_DEFAULT, creation,
                             H5P_DEFAULT);
    if (creation >= 0)
        H5Pclose(creation);
    if (space >= 0)
        H5Sclose(space);
    return dataset;
}

static enum tri_status resize(struct tri_h5_array *array, int64_t n, struct tri_error *error)
{
    const hsize_t size[2] = {(hsize_t)n, (hsize_t)array->width};
    return H5Dset_extent(array->dataset, size) < 0 ? tri_h5_fail(array->file, array->name, error) : TRI_OK;
}

enum tri_status tri_h5_array_allocate(struct tri_h5_array *array, int64_t n_chunks, struct tri_error *error)
{
    if (n_chunks <= array->n_chunks)
        return TRI_OK;
    if (array->dataset < 0)
        array->dataset = create_dataset(array, 0, true);
    if (array->dataset < 0)
        return tri_h5_fail(array->file, array->name, error);
    array->n_chunks = n_chunks;
    return resize(array, n_chunks * array->chunk_rows, error);
}

/* Waits for what is on its way, then sends the buffer after it. */
static bool send_chunk(struct tri_h5_array *array, const hsize_t place[2])
{
    tri_h5_wait(array->file, &array->behind);
    array->other = array->other ? array->other : new_buffer(chunk_bytes(array));
    array->file->behind = array->other ? &array->behind : NULL;
    array->file->behind_data = array->buffer;
    const bool sent = H5Dwrite_chunk(array->dataset, H5P_DEFAULT, 0, place, chunk_bytes(array), array->buffer) >= 0;
    array->file->behind = NULL;
    if (array->behind.under_way) {
        char *buffer = array->buffer;
        array->buffer = array->other;
        array->other = buffer;
    }
    return sent && array->file->failure == 0;
}

/* The buffer as the chunk that begins with row `first`. */
static enum tri_status write_chunk(struct tri_h5_array *array, int64_t first, struct tri_error *error)
{
    const hsize_t place[2] = {(hsize_t)first, 0};
    assert(first % array->chunk_rows == 0);
    if (first / array->chunk_rows >= array->n_chunks)
        return tri_fail(error, TRI_INTERNAL, array->file->output->path, 0, "%s has more rows than expected",
                        array->name);
    return send_chunk(array, place) ? TRI_OK : tri_h5_fail(array->file, array->name, error);
}

static enum tri_status write_whole(struct tri_h5_array *array, struct tri_error *error)
{
    array->dataset = create_dataset(array, array->n, false);
    if (array->dataset < 0 || H5Dwrite(array->dataset, tri_h5_type_id(array->type), H5S_ALL, H5S_ALL, H5P_DEFAULT,
                                       array->buffer) < 0)
        return tri_h5_fail(array->file, array->name, error);
    return TRI_OK;
}

/* --- rows */

enum tri_status tri_h5_array_room(struct tri_h5_array *array, char **at, int32_t *rows, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (array->n_buffer == array->chunk_rows) {
        status = write_chunk(array, array->n - array->n_buffer, error);
        array->n_buffer = 0;
    }
    *rows = array->chunk_rows - array->n_buffer;
    *at = array->buffer + (size_t)array->n_buffer * row_bytes(array);
    return status;
}

void tri_h5_array_advance(struct tri_h5_array *array, int32_t rows)
{
    assert(rows >= 0 && rows <= array->chunk_rows - array->n_buffer);
    array->n += rows;
    array->n_buffer += rows;
}

/* Bytes behind the last row are written, and must not depend on what was there. */
static void clear_rest(struct tri_h5_array *array)
{
    size_t taken = (size_t)array->n_buffer * row_bytes(array);
    memset(array->buffer + taken, 0, chunk_bytes(array) - taken);
}

/* Gives back chunks that are not needed, and closes the dataset. */
static enum tri_status conclude(struct tri_h5_array *array, struct tri_error *error)
{
    enum tri_status status = array->n_chunks > 0 ? resize(array, array->n, error) : TRI_OK;
    if (array->dataset >= 0 && H5Dclose(array->dataset) < 0 && !status)
        status = tri_h5_fail(array->file, array->name, error);
    array->dataset = -1;
    return status;
}

enum tri_status tri_h5_array_end(struct tri_h5_array *array, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    clear_rest(array);
    if (array->dataset < 0)
        status = write_whole(array, error);
    else if (array->n_buffer > 0)
        status = write_chunk(array, array->n - array->n_buffer, error);
    tri_h5_wait(array->file, &array->behind);
    if (!status && array->file->failure != 0)
        status = tri_h5_fail(array->file, array->name, error);
    return status ? status : conclude(array, error);
}

/* --- rows that others write */

/* Where the chunk that begins with this row lies, of so many bytes. HDF5 tells it only at the price of going through
 * all chunks before (H5Dget_chunk_info_by_coord in 1.10); where it writes to it knows at once. False: it fails. */
static bool chunk_place(const struct tri_h5_array *array, hid_t dataset, int64_t row, size_t bytes, int64_t *place)
{
    const hsize_t first[2] = {(hsize_t)row, 0};
    struct tri_h5_file *file = array->file;
    file->sought = array->buffer;
    file->found = -1;
    const bool sent = H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, first, bytes, array->buffer) >= 0;
    file->sought = NULL;
    *place = file->found;
    return sent && file->found >= 0;
}

enum tri_status tri_h5_array_lay_out(struct tri_h5_array *array, int64_t n, int64_t *place, struct tri_error *error)
{
    const size_t bytes = chunk_bytes(array);
    array->n = n;
    if (array->n_chunks == 0) {
        array->dataset = create_dataset(array, n, false);
        *place = array->dataset >= 0 ? (int64_t)H5Dget_offset(array->dataset) : 0; /* without rows there is none */
    }
    if (array->dataset < 0)
        return tri_h5_fail(array->file, array->name, error);
    for (int64_t k = 0; array->n_chunks > 0 && k * array->chunk_rows < n; k++)
        if (!chunk_place(array, array->dataset, k * array->chunk_rows, bytes, &place[k]))
            return tri_h5_fail(array->file, array->name, error);
    return conclude(array, error);
}

/* --- wider numbers */

/* n numbers of 32 bits, little-endian, as 64 bits; in place, from the last to the first. */
static void widen_numbers(char *data, size_t n)
{
    for (size_t i = n; i-- > 0;) {
        memmove(data + 8 * i, data + 4 * i, 4);
        memset(data + 8 * i + 4, data[8 * i + 3] < 0 ? -1 : 0, 4);
    }
}

/* What lies in a file must not depend on what has lain there before. */
static bool clear_chunk(const struct tri_h5_array *array, hid_t dataset, int64_t row)
{
    const size_t size = chunk_bytes(array) / 2; /* its integers have 32 bits */
    int64_t place;
    if (!chunk_place(array, dataset, row, size, &place))
        return false;
    const int failure = tri_output_clear(array->file->output, (uint64_t)place, size);
    array->file->failure = array->file->failure ? array->file->failure : failure;
    return failure == 0;
}

/* Copies the chunks of the old dataset, by way of the buffer. */
static enum tri_status copy_chunks(struct tri_h5_array *array, hid_t old, struct tri_error *error)
{
    const int64_t end = array->n - array->n_buffer;
    enum tri_status status = TRI_OK;
    for (int64_t first = 0; first < end && !status; first += array->chunk_rows) {
        const hsize_t place[2] = {(hsize_t)first, 0};
        uint32_t filters = 0;
        if (H5Dread_chunk(old, H5P_DEFAULT, place, &filters, array->buffer) < 0 || !clear_chunk(array, old, first))
            return tri_h5_fail(array->file, array->name, error);
        widen_numbers(array->buffer, (size_t)array->chunk_rows * (size_t)array->width);
        status = write_chunk(array, first, error);
    }
    return status;
}

static enum tri_status replace_dataset(struct tri_h5_array *array, struct tri_error *error)
{
    const int64_t n_chunks = array->n_chunks;
    hid_t old = array->dataset;
    enum tri_status status = TRI_OK;
    array->dataset = -1;
    array->n_chunks = 0;
    if (H5Ldelete(array->file->id, array->name, H5P_DEFAULT) < 0)
        status = tri_h5_fail(array->file, array->name, error);
    status = status ? status : tri_h5_array_allocate(array, n_chunks, error);
    status = status ? status : copy_chunks(array, old, error);
    H5Dclose(old); /* and its space is free */
    return status;
}

enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error)
{
    assert(array->type == TRI_H5_INT32);
    const size_t rest = (size_t)array->n_buffer * (size_t)array->width;
    char *wide = new_buffer(2 * chunk_bytes(array)), *narrow = array->buffer;
    if (!wide)
        return no_memory(array, error);
    tri_h5_wait(array->file, &array->behind);
    free(array->other); /* too small from now on */
    array->other = NULL;
    array->type = TRI_H5_INT64;
    array->buffer = wide;
    enum tri_status status = array->dataset >= 0 ? replace_dataset(array, error) : TRI_OK;
    memcpy(array->buffer, narrow, 4 * rest);
    widen_numbers(array->buffer, rest);
    free(narrow);
    return status;
}
