/* Arrays as chunked datasets, and the offsets of their chunks. */
#include "triangle/hdf5/array.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"
#include "triangle/base/system.h"

static size_t chunk_bytes(const struct tri_h5_plan *plan)
{
    return (size_t)plan->chunk_rows * tri_h5_row_bytes(plan);
}

static int dimensions(const struct tri_h5_array *array) { return array->is_list ? 1 : 2; }

hid_t tri_h5_type_id(enum tri_h5_type type)
{
    return type == TRI_H5_FLOAT64 ? H5T_IEEE_F64LE : type == TRI_H5_INT32 ? H5T_STD_I32LE : H5T_STD_I64LE;
}

static enum tri_status no_memory(const struct tri_h5_array *array, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, array->file->output->path, 0, "no memory to write %s", array->name);
}

void tri_h5_array_begin(struct tri_h5_array *array, struct tri_h5_file *file, const char *name,
                        struct tri_h5_plan *plan, enum tri_h5_type type, int32_t width, int32_t chunk_rows)
{
    *array = (struct tri_h5_array){.file = file, .name = name, .is_list = width == 0, .plan = plan, .dataset = -1};
    *plan = (struct tri_h5_plan){.type = type, .width = width > 0 ? width : 1, .chunk_rows = chunk_rows};
}

void tri_h5_array_free(struct tri_h5_array *array)
{
    if (array->file && array->dataset >= 0)
        H5Dclose(array->dataset);
    if (array->file)
        free(array->plan->place);
    *array = (struct tri_h5_array){.dataset = -1};
}

/* --- datasets */

/* Returns the creation properties of a dataset: in chunks or contiguous, with space allocated at once and not filled. <
 * 0: an error. */
static hid_t creation_of(const struct tri_h5_array *array, bool in_chunks)
{
    const hsize_t chunk[2] = {(hsize_t)array->plan->chunk_rows, (hsize_t)array->plan->width};
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

/* Creates a dataset of n rows; < 0: an error. */
static hid_t create_dataset(const struct tri_h5_array *array, int64_t n, bool in_chunks)
{
    const hsize_t width = (hsize_t)array->plan->width, size[2] = {(hsize_t)n, width}, most[2] = {H5S_UNLIMITED, width};
    return tri_h5_new_dataset(array->file, array->name, tri_h5_type_id(array->plan->type), dimensions(array), size,
                              in_chunks ? most : NULL, creation_of(array, in_chunks));
}

static bool resize(const struct tri_h5_array *array, int64_t n)
{
    const hsize_t size[2] = {(hsize_t)n, (hsize_t)array->plan->width};
    return H5Dset_extent(array->dataset, size) >= 0;
}

/* Finds the offset of chunk k by writing to it, which makes HDF5 call the file driver with the offset.
 * H5Dget_chunk_info_by_coord would visit all previous chunks (in 1.10). Returns false on failure. */
static bool find_chunk(const struct tri_h5_array *array, int64_t k)
{
    const hsize_t first[2] = {(hsize_t)(k * array->plan->chunk_rows), 0};
    struct tri_h5_file *file = array->file;
    file->probed = array; /* its contents are ignored */
    file->found = -1;
    const bool sent = H5Dwrite_chunk(array->dataset, H5P_DEFAULT, 0, first, chunk_bytes(array->plan), array) >= 0;
    file->probed = NULL;
    array->plan->place[k] = file->found;
    return sent && file->found >= 0;
}

enum tri_status tri_h5_array_allocate(struct tri_h5_array *array, int64_t n_chunks, struct tri_error *error)
{
    struct tri_h5_plan *plan = array->plan;
    if (n_chunks <= plan->n)
        return TRI_OK;
    if (!tri_resize(&plan->place, (size_t)n_chunks, sizeof *plan->place))
        return no_memory(array, error);
    if (array->dataset < 0)
        array->dataset = create_dataset(array, 0, true);
    if (array->dataset < 0 || !resize(array, n_chunks * plan->chunk_rows))
        return tri_h5_fail(array->file, array->name, error);
    while (plan->n < n_chunks)
        if (!find_chunk(array, plan->n++))
            return tri_h5_fail(array->file, array->name, error);
    return TRI_OK;
}

enum tri_status tri_h5_array_end(struct tri_h5_array *array, int64_t n, struct tri_error *error)
{
    struct tri_h5_plan *plan = array->plan;
    const bool in_chunks = array->dataset >= 0;
    array->n = n;
    if (!in_chunks && !tri_resize(&plan->place, 1, sizeof *plan->place))
        return no_memory(array, error);
    if (!in_chunks) {
        array->dataset = create_dataset(array, n, false);
        plan->n = 1;
        *plan->place = array->dataset >= 0 ? (int64_t)H5Dget_offset(array->dataset) : 0; /* none if there are no rows */
    }
    bool done = array->dataset >= 0 && (!in_chunks || resize(array, n));
    done = array->dataset >= 0 && H5Dclose(array->dataset) >= 0 && done;
    array->dataset = -1;
    return done && array->file->failure == 0 ? TRI_OK : tri_h5_fail(array->file, array->name, error);
}

/* --- conversion to 64 bits */

/* Converts n little-endian 32-bit integers to 64 bits; in place, from the last to the first. */
static void widen_numbers(char *data, size_t n)
{
    for (size_t i = n; i-- > 0;) {
        memmove(data + 8 * i, data + 4 * i, 4);
        memset(data + 8 * i + 4, data[8 * i + 3] < 0 ? -1 : 0, 4);
    }
}

/* Moves the written part of a chunk through the buffer, and converts it. Fills the old location with zeros, because the
 * contents of a file must not depend on what was stored there before. */
static enum tri_status move_chunk(const struct tri_h5_array *array, int64_t from, int64_t to, char *buffer,
                                  struct tri_error *error)
{
    struct tri_output *output = array->file->output;
    const size_t bytes = chunk_bytes(array->plan), half = bytes / 2;
    const int64_t got = tri_read_at(output->file, buffer, half, (uint64_t)from);
    if (got < 0)
        return tri_fail_system(error, TRI_CANNOT_WRITE, output->path, "cannot read again", errno);
    memset(buffer + got, 0, half - (size_t)got);
    widen_numbers(buffer, half / 4);
    int result = tri_output_write_at(output, (uint64_t)to, buffer, bytes);
    memset(buffer, 0, half);
    result = result ? result : tri_output_write_at(output, (uint64_t)from, buffer, half);
    return tri_output_conclude(output, result, error);
}

static enum tri_status replace_dataset(struct tri_h5_array *array, const struct tri_h5_plan *old,
                                       struct tri_error *error)
{
    hid_t dataset = array->dataset;
    char *buffer = malloc(chunk_bytes(array->plan));
    enum tri_status status = buffer ? TRI_OK : no_memory(array, error);
    array->dataset = -1;
    if (!status && H5Ldelete(array->file->id, array->name, H5P_DEFAULT) < 0)
        status = tri_h5_fail(array->file, array->name, error);
    status = status ? status : tri_h5_array_allocate(array, old->n, error);
    for (int64_t k = 0; k < old->n && !status; k++)
        status = move_chunk(array, old->place[k], array->plan->place[k], buffer, error);
    H5Dclose(dataset); /* frees the old dataset's space */
    free(buffer);
    return status;
}

enum tri_status tri_h5_array_widen(struct tri_h5_array *array, struct tri_error *error)
{
    const struct tri_h5_plan old = *array->plan;
    *array->plan = (struct tri_h5_plan){.type = TRI_H5_INT64, .width = old.width, .chunk_rows = old.chunk_rows};
    const enum tri_status status = replace_dataset(array, &old, error);
    free(old.place);
    return status;
}
