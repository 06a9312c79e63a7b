/* Datasets are opened once; a slice is one selection of rows. */
#include "triangle/hdf5/read.h"

#include <assert.h>
#include <errno.h>
#include <fcntl.h>
#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "triangle/hdf5/file.h"
#include "triangle/hdf5/layout.h"

enum which {
    POINTS, POINT_MARKERS, POINT_ATTRIBUTES, TRIANGLES, TRIANGLE_ATTRIBUTES, SEGMENTS, SEGMENT_MARKERS, ARRAYS
};

/* What an array must look like. */
static const struct form {
    const char *name;
    int64_t width;      /* numbers in a row; 0: a list, -1: a table of any */
    bool needed;
    enum which rows_of; /* it has as many rows as this */
    H5T_class_t type;
} forms[ARRAYS] = {
    {TRI_H5_POINTS, 2, true, POINTS, H5T_FLOAT},
    {TRI_H5_POINT_MARKERS, 0, false, POINTS, H5T_INTEGER},
    {TRI_H5_POINT_ATTRIBUTES, -1, false, POINTS, H5T_FLOAT},
    {TRI_H5_TRIANGLES, 3, true, TRIANGLES, H5T_INTEGER},
    {TRI_H5_TRIANGLE_ATTRIBUTES, -1, false, TRIANGLES, H5T_NO_CLASS}, /* either */
    {TRI_H5_SEGMENTS, 2, false, SEGMENTS, H5T_INTEGER},
    {TRI_H5_SEGMENT_MARKERS, 0, false, SEGMENTS, H5T_INTEGER},
};

struct tri_h5 {
    char *path;
    hid_t file;
    hid_t datasets[ARRAYS]; /* < 0: there is none */
    int64_t rows[ARRAYS];
    int32_t width[ARRAYS];
    struct tri_h5_counts counts;
};

/* --- opening */

static bool has_type(hid_t dataset, H5T_class_t wanted)
{
    hid_t type = H5Dget_type(dataset);
    H5T_class_t found = type >= 0 ? H5Tget_class(type) : H5T_NO_CLASS;
    if (type >= 0)
        H5Tclose(type);
    return wanted == H5T_NO_CLASS ? found == H5T_INTEGER || found == H5T_FLOAT : found == wanted;
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
    if (!fits || size[0] > INT64_MAX / 64 || size[1] < 1 || size[1] > 1000)
        return false;
    h5->rows[k] = (int64_t)size[0];
    h5->width[k] = (int32_t)size[1];
    return (forms[k].width <= 0 || (int64_t)size[1] == forms[k].width) && has_type(h5->datasets[k], forms[k].type) &&
           h5->rows[k] == h5->rows[forms[k].rows_of];
}

static enum tri_status open_array(struct tri_h5 *h5, enum which k, struct tri_error *error)
{
    if (!forms[k].needed && H5Lexists(h5->file, forms[k].name, H5P_DEFAULT) <= 0)
        return TRI_OK;
    h5->datasets[k] = H5Dopen2(h5->file, forms[k].name, H5P_DEFAULT);
    if (h5->datasets[k] < 0)
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "there is no array /%s that can be opened", forms[k].name);
    if (!measure(h5, k))
        return tri_fail(error, TRI_BAD_INPUT, h5->path, 0, "the array /%s has not the type and size that it should",
                        forms[k].name);
    return TRI_OK;
}

/* An attribute of /about; -1: there is none. */
static int64_t about(const struct tri_h5 *h5, const char *name)
{
    int64_t value = -1;
    hid_t attribute = H5Aopen_by_name(h5->file, "/" TRI_H5_ABOUT, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0)
        return -1;
    hid_t space = H5Aget_space(attribute);
    if (space < 0 || H5Sget_simple_extent_npoints(space) != 1 || H5Aread(attribute, H5T_NATIVE_INT64, &value) < 0)
        value = -1;
    if (space >= 0)
        H5Sclose(space);
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
    h5->counts = (struct tri_h5_counts){
        h5->rows[POINTS], h5->rows[TRIANGLES], h5->rows[SEGMENTS], about(h5, TRI_H5_ABOUT_INPUT_POINTS),
        h5->datasets[POINT_ATTRIBUTES] >= 0 ? h5->width[POINT_ATTRIBUTES] : 0,
        h5->datasets[TRIANGLE_ATTRIBUTES] >= 0 ? h5->width[TRIANGLE_ATTRIBUTES] : 0,
        h5->datasets[POINT_MARKERS] >= 0, h5->datasets[SEGMENTS] >= 0, h5->datasets[SEGMENT_MARKERS] >= 0};
    return TRI_OK;
}

/* HDF5 does not tell a file that is not there from one that is none of its own. */
static enum tri_status open_file(struct tri_h5 *h5, struct tri_error *error)
{
    int file = open(h5->path, O_RDONLY | O_CLOEXEC);
    if (file < 0)
        return tri_fail(error, TRI_CANNOT_READ, h5->path, 0, "cannot open: %s", strerror(errno));
    close(file);
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
