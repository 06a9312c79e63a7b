/* Datasets are opened once; a slice is a selection of rows.
 *
 * The origin of a file is not trusted. HDF5 would follow links, virtual datasets and external storage to other files,
 * even pipes, load filters from libraries, and replace missing data by zeros. So only arrays like those of the writer
 * are opened: stored in this file, uncompressed and complete. Then no array is larger than the file. */
#include "triangle/hdf5/h5_read.h"

#include <assert.h>
#include <errno.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/system.h"
#include "triangle/hdf5/array.h"

static const struct tri_h5_form *const forms = tri_h5_forms;

struct tri_h5 {
    const char *path; /* borrowed */
    hid_t file;
    int64_t bytes; /* size of the file */
    hid_t datasets[TRI_H5_KINDS]; /* < 0: no such dataset */
    int64_t rows[TRI_H5_KINDS];
    int32_t width[TRI_H5_KINDS];
    struct tri_h5_counts counts;
};

/* --- opening */

static bool has_type(hid_t dataset, unsigned wanted)
{
    hid_t type = H5Dget_type(dataset);
    bool found = false;
    for (enum tri_h5_type k = TRI_H5_FLOAT64; type >= 0 && k <= TRI_H5_INT64; k++)
        found = found || ((wanted >> k & 1) && H5Tequal(type, tri_h5_type_id(k)) > 0);
    tri_h5_close_id(H5Tclose, type);
    return found;
}

/* Determines rows and width. Returns whether the array has the required form. */
static bool measure(struct tri_h5 *h5, enum tri_h5_kind k)
{
    hsize_t size[2] = {0, 1};
    hid_t space = H5Dget_space(h5->datasets[k]);
    if (space < 0)
        return false;
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool fits = rank == (forms[k].width == 0 ? 1 : 2) && H5Sget_simple_extent_dims(space, size, NULL) == rank;
    H5Sclose(space);
    if (!fits || size[0] > INT64_MAX / 8192 || size[1] < 1 || size[1] > 1000)
        return false;
    h5->rows[k] = (int64_t)size[0];
    h5->width[k] = (int32_t)size[1];
    return (forms[k].width <= 0 || (int64_t)size[1] == forms[k].width) && has_type(h5->datasets[k], forms[k].types) &&
           h5->rows[k] == h5->rows[forms[k].rows_of];
}

/* Returns the number of elements that its storage must hold, in whole chunks. */
static double stored_numbers(const struct tri_h5 *h5, enum tri_h5_kind k, hid_t creation)
{
    const int64_t size[2] = {h5->rows[k], h5->width[k]};
    const int rank = forms[k].width == 0 ? 1 : 2;
    hsize_t chunk[2] = {1, 1};
    double n = 1;
    if (H5Pget_layout(creation) == H5D_CHUNKED && H5Pget_chunk(creation, rank, chunk) != rank)
        return HUGE_VAL;
    for (int i = 0; i < rank; i++)
        n *= ceil((double)size[i] / (double)chunk[i]) * (double)chunk[i];
    return n;
}

/* Returns the fault in the storage of the array; NULL: none. */
static const char *wrong_storage(const struct tri_h5 *h5, enum tri_h5_kind k, hid_t creation)
{
    const H5D_layout_t layout = H5Pget_layout(creation);
    hid_t type = H5Dget_type(h5->datasets[k]);
    const double bytes = type >= 0 ? (double)H5Tget_size(type) : 8;
    tri_h5_close_id(H5Tclose, type);
    if (layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED)
        return "has virtual or compact storage, which is not supported";
    if (H5Pget_external_count(creation) != 0)
        return "is stored in another file, which is not supported";
    if (H5Pget_nfilters(creation) != 0)
        return "is compressed, which is not supported; to uncompress it: h5repack -f NONE";
    if (bytes * (double)h5->rows[k] * h5->width[k] > (double)h5->bytes ||
        (double)H5Dget_storage_size(h5->datasets[k]) < bytes * stored_numbers(h5, k, creation))
        return "is incomplete";
    return NULL;
}

/* Does the array have more rows than a planar mesh allows? There are at most twice as many triangles as points, and
 * three times as many segments. */
static bool are_too_many(const struct tri_h5 *h5, enum tri_h5_kind k)
{
    const int64_t points = h5->rows[TRI_H5_OF_POINTS];
    return h5->rows[k] / 3 > points || (k == TRI_H5_OF_TRIANGLES && h5->rows[k] / 2 > points);
}

static enum tri_status check_array(struct tri_h5 *h5, enum tri_h5_kind k, struct tri_error *error)
{
    if (!measure(h5, k))
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "the array /%s has an unexpected type or size",
                        forms[k].name);
    hid_t creation = H5Dget_create_plist(h5->datasets[k]);
    const char *wrong = creation < 0            ? "cannot be examined"
                        : are_too_many(h5, k)   ? "has more rows than a mesh with this number of points can have"
                                                : wrong_storage(h5, k, creation);
    tri_h5_close_id(H5Pclose, creation);
    return wrong ? tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "the array /%s %s", forms[k].name, wrong) : TRI_OK;
}

/* Is the name a hard link, which refers to an object in this file? */
static bool is_own(const struct tri_h5 *h5, const char *name)
{
    H5L_info_t link;
    return H5Lget_info(h5->file, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
}

static enum tri_status open_array(struct tri_h5 *h5, enum tri_h5_kind k, struct tri_error *error)
{
    const bool there = H5Lexists(h5->file, forms[k].name, H5P_DEFAULT) > 0;
    if (!forms[k].needed && !there)
        return TRI_OK;
    if (there && !is_own(h5, forms[k].name))
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "/%s is a link, which is not followed", forms[k].name);
    h5->datasets[k] = H5Dopen2(h5->file, forms[k].name, H5P_DEFAULT);
    if (h5->datasets[k] < 0)
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "there is no array /%s that can be opened", forms[k].name);
    return check_array(h5, k, error);
}

/* Returns an attribute of /about; -1: it does not exist. */
static int64_t about(const struct tri_h5 *h5, const char *name)
{
    int64_t value = -1;
    if (!is_own(h5, TRI_H5_ABOUT))
        return -1;
    hid_t attribute = H5Aopen_by_name(h5->file, "/" TRI_H5_ABOUT, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0)
        return -1;
    hid_t space = H5Aget_space(attribute), type = H5Aget_type(attribute);
    if (space < 0 || type < 0 || H5Sget_simple_extent_npoints(space) != 1 || H5Tequal(type, H5T_STD_I64LE) <= 0 ||
        H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
        value = -1;
    tri_h5_close_id(H5Sclose, space);
    tri_h5_close_id(H5Tclose, type);
    H5Aclose(attribute);
    return value;
}

static bool has(const struct tri_h5 *h5, enum tri_h5_kind k) { return h5->datasets[k] >= 0; }

static enum tri_status open_arrays(struct tri_h5 *h5, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (enum tri_h5_kind k = 0; k < TRI_H5_KINDS && !status; k++)
        status = open_array(h5, k, error);
    if (status)
        return status;
    if (about(h5, TRI_H5_ABOUT_VERSION) > TRI_H5_VERSION)
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "written by a newer version; this version reads format %d",
                        TRI_H5_VERSION);
    const int64_t input_points = about(h5, TRI_H5_ABOUT_INPUT_POINTS);
    h5->counts = (struct tri_h5_counts){
        .points = h5->rows[TRI_H5_OF_POINTS], .triangles = h5->rows[TRI_H5_OF_TRIANGLES],
        .segments = h5->rows[TRI_H5_OF_SEGMENTS],
        .input_points = input_points <= h5->rows[TRI_H5_OF_POINTS] ? input_points : -1,
        .attributes = has(h5, TRI_H5_OF_POINT_ATTRIBUTES) ? h5->width[TRI_H5_OF_POINT_ATTRIBUTES] : 0,
        .columns = has(h5, TRI_H5_OF_TRIANGLE_ATTRIBUTES) ? h5->width[TRI_H5_OF_TRIANGLE_ATTRIBUTES] : 0,
        .point_markers = has(h5, TRI_H5_OF_POINT_MARKERS), .lists_segments = has(h5, TRI_H5_OF_SEGMENTS),
        .segment_markers = has(h5, TRI_H5_OF_SEGMENT_MARKERS)};
    return TRI_OK;
}

/* Checks that the file is a regular one, because HDF5 does not distinguish a missing file from one in another
 * format. */
static enum tri_status open_file(struct tri_h5 *h5, struct tri_error *error)
{
    struct tri_file_facts facts;
    const tri_file file = tri_file_open(h5->path, TRI_OPEN_NO_WAIT);
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_CANNOT_READ, h5->path, "cannot open", errno);
    const bool regular = tri_file_get_facts(file, &facts) && facts.kind == TRI_REGULAR;
    (void)tri_file_close(file);
    if (!regular)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "not a regular file");
    h5->bytes = (int64_t)facts.size;
    h5->file = H5Fopen(h5->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (h5->file < 0)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "not an HDF5 file that can be opened: \"%s\"",
                        tri_h5_reason().text);
    return open_arrays(h5, error);
}

enum tri_status tri_h5_open(const char *path, struct tri_h5 **h5, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    *h5 = malloc(sizeof **h5);
    if (!*h5)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "no memory to read the file");
    **h5 = (struct tri_h5){.path = path, .file = -1};
    for (int k = 0; k < TRI_H5_KINDS; k++)
        (*h5)->datasets[k] = -1;
    (void)H5dont_atexit(); /* must be first: otherwise HDF5 prints messages about damaged files when the process ends */
    H5E_BEGIN_TRY
    {
        status = open_file(*h5, error);
    }
    H5E_END_TRY
    if (status) {
        tri_h5_free(*h5);
        *h5 = NULL;
    }
    return status;
}

void tri_h5_free(struct tri_h5 *h5)
{
    if (!h5)
        return;
    H5E_BEGIN_TRY
    {
        for (int k = 0; k < TRI_H5_KINDS; k++)
            tri_h5_close_id(H5Dclose, h5->datasets[k]);
        tri_h5_close_id(H5Fclose, h5->file);
    }
    H5E_END_TRY
    free(h5);
}

const struct tri_h5_counts *tri_h5_count(const struct tri_h5 *h5) { return &h5->counts; }

/* --- slices */

/* Reads rows of an array. Returns false if HDF5 fails. */
static bool read_rows(const struct tri_h5 *h5, enum tri_h5_kind k, int64_t first, int64_t n, hid_t type, void *out)
{
    const hsize_t place[2] = {(hsize_t)first, 0}, size[2] = {(hsize_t)n, (hsize_t)h5->width[k]};
    const int rank = forms[k].width == 0 ? 1 : 2;
    hid_t memory = H5Screate_simple(rank, size, NULL), space = H5Dget_space(h5->datasets[k]);
    bool done = memory >= 0 && space >= 0 &&
                H5Sselect_hyperslab(space, H5S_SELECT_SET, place, NULL, size, NULL) >= 0 &&
                H5Dread(h5->datasets[k], type, memory, space, H5P_DEFAULT, out) >= 0;
    tri_h5_close_id(H5Sclose, memory);
    tri_h5_close_id(H5Sclose, space);
    return done;
}

static enum tri_status slice(const struct tri_h5 *h5, enum tri_h5_kind k, int64_t first, int64_t n, hid_t type,
                             void *out, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    assert(h5->datasets[k] >= 0 && first >= 0 && n >= 0 && n <= h5->rows[k] - first);
    if (n == 0)
        return TRI_OK;
    H5E_BEGIN_TRY
    {
        if (!read_rows(h5, k, first, n, type, out)) {
            struct tri_h5_reason reason = tri_h5_reason();
            status = tri_fail(error, reason.no_memory ? TRI_NO_MEMORY : TRI_CANNOT_READ, h5->path, 0,
                              "cannot read /%s: \"%s\"", forms[k].name, reason.text);
        }
    }
    H5E_END_TRY
    return status;
}

enum tri_status tri_h5_read(const struct tri_h5 *h5, enum tri_h5_kind kind, int64_t first, int64_t n, void *out,
                            struct tri_error *error)
{
    const unsigned types = forms[kind].types;
    const hid_t type = types >> TRI_H5_FLOAT64 & 1 ? H5T_NATIVE_DOUBLE
                       : types >> TRI_H5_INT64 & 1 ? H5T_NATIVE_INT64
                                                   : H5T_NATIVE_INT32;
    if (h5->datasets[kind] >= 0)
        return slice(h5, kind, first, n, type, out, error);
    if (types == 1u << TRI_H5_INT32)
        memset(out, 0, (size_t)n * sizeof(int32_t));
    return TRI_OK;
}
