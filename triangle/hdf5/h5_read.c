/* Datasets are opened once; a slice is one selection of rows.
 *
 * A file may come from anywhere, and HDF5 follows what it says: links and virtual datasets to other files, or storage
 * in them, pipes among these, filters from libraries, and fills what is not there with zeros. So only what the writer
 * makes is opened: arrays that this very file holds, uncompressed and in full. No array is then larger than the
 * file. */
#include "triangle/hdf5/h5_read.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "triangle/hdf5/file.h"
#include "triangle/hdf5/layout.h"

enum which {
    POINTS, POINT_MARKERS, POINT_ATTRIBUTES, TRIANGLES, TRIANGLE_ATTRIBUTES, SEGMENTS, SEGMENT_MARKERS, ARRAYS
};

enum { FLOAT64 = 1, INT32 = 2, INT64 = 4 };

/* What an array must look like. */
static const struct form {
    const char *name;
    int64_t width;      /* numbers in a row; 0: a list, -1: a table of any */
    bool needed;
    enum which rows_of; /* it has as many rows as this */
    unsigned types;     /* that it may have */
} forms[ARRAYS] = {
    {TRI_H5_POINTS, 2, true, POINTS, FLOAT64},
    {TRI_H5_POINT_MARKERS, 0, false, POINTS, INT32},
    {TRI_H5_POINT_ATTRIBUTES, -1, false, POINTS, FLOAT64},
    {TRI_H5_TRIANGLES, 3, true, TRIANGLES, INT32 | INT64},
    {TRI_H5_TRIANGLE_ATTRIBUTES, -1, false, TRIANGLES, FLOAT64 | INT32},
    {TRI_H5_SEGMENTS, 2, false, SEGMENTS, INT32 | INT64},
    {TRI_H5_SEGMENT_MARKERS, 0, false, SEGMENTS, INT32},
};

struct tri_h5 {
    char *path;
    hid_t file;
    int64_t bytes; /* of the file */
    hid_t datasets[ARRAYS]; /* < 0: there is none */
    int64_t rows[ARRAYS];
    int32_t width[ARRAYS];
    struct tri_h5_counts counts;
};

/* --- opening */

static bool has_type(hid_t dataset, unsigned wanted)
{
    hid_t type = H5Dget_type(dataset);
    const bool found = type >= 0 && ((wanted & FLOAT64 && H5Tequal(type, H5T_IEEE_F64LE) > 0) ||
                                     (wanted & INT32 && H5Tequal(type, H5T_STD_I32LE) > 0) ||
                                     (wanted & INT64 && H5Tequal(type, H5T_STD_I64LE) > 0));
    if (type >= 0)
        H5Tclose(type);
    return found;
}

/* Its rows and width, if it has the form. */
static bool measure(struct tri_h5 *h5, enum which k)
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

/* Numbers that its storage must have room for: whole chunks. */
static double stored_numbers(const struct tri_h5 *h5, enum which k, hid_t creation)
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

/* What is wrong with how the array is kept; NULL: nothing. */
static const char *wrong_storage(const struct tri_h5 *h5, enum which k, hid_t creation)
{
    const H5D_layout_t layout = H5Pget_layout(creation);
    hid_t type = H5Dget_type(h5->datasets[k]);
    const double bytes = type >= 0 ? (double)H5Tget_size(type) : 8;
    if (type >= 0)
        H5Tclose(type);
    if (layout != H5D_CONTIGUOUS && layout != H5D_CHUNKED)
        return "is kept in a way that is not read: virtual or compact";
    if (H5Pget_external_count(creation) != 0)
        return "lies in another file, which is not read";
    if (H5Pget_nfilters(creation) != 0)
        return "is compressed, which is not read: h5repack -f NONE";
    if (bytes * (double)h5->rows[k] * h5->width[k] > (double)h5->bytes ||
        (double)H5Dget_storage_size(h5->datasets[k]) < bytes * stored_numbers(h5, k, creation))
        return "is not there in full";
    return NULL;
}

/* Triangles and segments of so many points can be no more than these: twice and three times as many. */
static bool are_too_many(const struct tri_h5 *h5, enum which k)
{
    return h5->rows[k] / 3 > h5->rows[POINTS] || (k == TRIANGLES && h5->rows[k] / 2 > h5->rows[POINTS]);
}

static enum tri_status check_array(struct tri_h5 *h5, enum which k, struct tri_error *error)
{
    if (!measure(h5, k))
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "the array /%s has not the type and size that it should",
                        forms[k].name);
    hid_t creation = H5Dget_create_plist(h5->datasets[k]);
    const char *wrong = creation < 0            ? "cannot be looked at"
                        : are_too_many(h5, k)   ? "has more rows than a mesh of so many points"
                                                : wrong_storage(h5, k, creation);
    if (creation >= 0)
        H5Pclose(creation);
    return wrong ? tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "the array /%s %s", forms[k].name, wrong) : TRI_OK;
}

/* Does the name lead to something in this very file, and no further? */
static bool is_own(const struct tri_h5 *h5, const char *name)
{
    H5L_info_t link;
    return H5Lget_info(h5->file, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
}

static enum tri_status open_array(struct tri_h5 *h5, enum which k, struct tri_error *error)
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

/* An attribute of /about; -1: there is none. */
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
    if (space >= 0)
        H5Sclose(space);
    if (type >= 0)
        H5Tclose(type);
    H5Aclose(attribute);
    return value;
}

static enum tri_status open_arrays(struct tri_h5 *h5, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int k = 0; k < ARRAYS && !status; k++)
        status = open_array(h5, (enum which)k, error);
    if (status)
        return status;
    if (about(h5, TRI_H5_ABOUT_VERSION) > TRI_H5_VERSION)
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "written by a newer version: this one knows format %d",
                        TRI_H5_VERSION);
    const int64_t input_points = about(h5, TRI_H5_ABOUT_INPUT_POINTS);
    h5->counts = (struct tri_h5_counts){
        h5->rows[POINTS], h5->rows[TRIANGLES], h5->rows[SEGMENTS],
        input_points <= h5->rows[POINTS] ? input_points : -1,
        h5->datasets[POINT_ATTRIBUTES] >= 0 ? h5->width[POINT_ATTRIBUTES] : 0,
        h5->datasets[TRIANGLE_ATTRIBUTES] >= 0 ? h5->width[TRIANGLE_ATTRIBUTES] : 0,
        h5->datasets[POINT_MARKERS] >= 0, h5->datasets[SEGMENTS] >= 0, h5->datasets[SEGMENT_MARKERS] >= 0};
    return TRI_OK;
}

/* HDF5 does not tell a file that is not there from one that is none of its own. */
static enum tri_status open_file(struct tri_h5 *h5, struct tri_error *error)
{
    struct stat state;
    int file = open(h5->path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "cannot open: %s", strerror(errno));
    const bool regular = fstat(file, &state) == 0 && S_ISREG(state.st_mode);
    close(file);
    if (!regular)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "not a regular file");
    h5->bytes = (int64_t)state.st_size;
    h5->file = H5Fopen(h5->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    if (h5->file < 0)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "not an HDF5 file that can be opened: \"%s\"",
                        tri_h5_reason().text);
    return open_arrays(h5, error);
}

static struct tri_h5 *new_mesh(const char *path)
{
    struct tri_h5 *h5 = malloc(sizeof *h5);
    char *name = malloc(strlen(path) + 1);
    if (!h5 || !name) {
        free(h5);
        free(name);
        return NULL;
    }
    *h5 = (struct tri_h5){.path = strcpy(name, path), .file = -1};
    for (int k = 0; k < ARRAYS; k++)
        h5->datasets[k] = -1;
    return h5;
}

enum tri_status tri_h5_open(const char *path, struct tri_h5 **h5, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    *h5 = new_mesh(path);
    if (!*h5)
        return tri_fail(error, TRI_NO_MEMORY, path, 0, "no memory to read the file");
    (void)H5dont_atexit(); /* before all else: at the end of the process HDF5 would print about what is damaged */
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
        for (int k = 0; k < ARRAYS; k++)
            if (h5->datasets[k] >= 0)
                H5Dclose(h5->datasets[k]);
        if (h5->file >= 0)
            H5Fclose(h5->file);
    }
    H5E_END_TRY
    free(h5->path);
    free(h5);
}

const struct tri_h5_counts *tri_h5_count(const struct tri_h5 *h5) { return &h5->counts; }

/* --- slices */

/* False: HDF5 could not. */
static bool read_rows(const struct tri_h5 *h5, enum which k, int64_t first, int64_t n, hid_t type, void *out)
{
    const hsize_t place[2] = {(hsize_t)first, 0}, size[2] = {(hsize_t)n, (hsize_t)h5->width[k]};
    const int rank = forms[k].width == 0 ? 1 : 2;
    hid_t memory = H5Screate_simple(rank, size, NULL), space = H5Dget_space(h5->datasets[k]);
    bool done = memory >= 0 && space >= 0 &&
                H5Sselect_hyperslab(space, H5S_SELECT_SET, place, NULL, size, NULL) >= 0 &&
                H5Dread(h5->datasets[k], type, memory, space, H5P_DEFAULT, out) >= 0;
    if (memory >= 0)
        H5Sclose(memory);
    if (space >= 0)
        H5Sclose(space);
    return done;
}

static enum tri_status slice(const struct tri_h5 *h5, enum which k, int64_t first, int64_t n, hid_t type, void *out,
                             struct tri_error *error)
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

enum tri_status tri_h5_points(struct tri_h5 *h5, int64_t first, int64_t n, double (*out)[2], struct tri_error *error)
{
    return slice(h5, POINTS, first, n, H5T_NATIVE_DOUBLE, out, error);
}

enum tri_status tri_h5_triangles(struct tri_h5 *h5, int64_t first, int64_t n, int64_t (*out)[3],
                                 struct tri_error *error)
{
    return slice(h5, TRIANGLES, first, n, H5T_NATIVE_INT64, out, error);
}

enum tri_status tri_h5_segments(struct tri_h5 *h5, int64_t first, int64_t n, int64_t (*out)[2],
                                struct tri_error *error)
{
    return h5->datasets[SEGMENTS] < 0 ? TRI_OK : slice(h5, SEGMENTS, first, n, H5T_NATIVE_INT64, out, error);
}

static enum tri_status markers(const struct tri_h5 *h5, enum which k, int64_t first, int64_t n, int32_t *out,
                               struct tri_error *error)
{
    if (h5->datasets[k] >= 0)
        return slice(h5, k, first, n, H5T_NATIVE_INT32, out, error);
    memset(out, 0, (size_t)n * sizeof *out);
    return TRI_OK;
}

enum tri_status tri_h5_point_markers(struct tri_h5 *h5, int64_t first, int64_t n, int32_t *out, struct tri_error *error)
{
    return markers(h5, POINT_MARKERS, first, n, out, error);
}

enum tri_status tri_h5_segment_markers(struct tri_h5 *h5, int64_t first, int64_t n, int32_t *out,
                                       struct tri_error *error)
{
    return markers(h5, SEGMENT_MARKERS, first, n, out, error);
}

enum tri_status tri_h5_point_attributes(struct tri_h5 *h5, int64_t first, int64_t n, double *out,
                                        struct tri_error *error)
{
    return h5->counts.attributes == 0 ? TRI_OK : slice(h5, POINT_ATTRIBUTES, first, n, H5T_NATIVE_DOUBLE, out, error);
}

enum tri_status tri_h5_triangle_attributes(struct tri_h5 *h5, int64_t first, int64_t n, double *out,
                                           struct tri_error *error)
{
    return h5->counts.columns == 0 ? TRI_OK
                                   : slice(h5, TRIANGLE_ATTRIBUTES, first, n, H5T_NATIVE_DOUBLE, out, error);
}
