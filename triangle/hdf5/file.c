/* A file driver for HDF5 with eight functions, and error messages.
 *
 * HDF5's own driver would open the file by name a second time, so that closing it drops the lock of the output. It
 * reports system errors as text only. And after a failed write HDF5 cannot close a file: it keeps the file until the
 * process ends, and tries again then. This driver stores and reports the first failure, and ignores all later
 * writes. */
#include "triangle/hdf5/file.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if H5_VERSION_GE(1, 13, 0)
#include <H5FDdevelop.h>
#endif

#include "triangle/base/system.h"

enum { PAGE_BYTES = 4096, LARGE_BYTES = 1 << 16 }; /* large objects start at a page boundary */

/* --- the driver */

struct driven {
    H5FD_t head; /* must come first, for HDF5 */
    struct tri_h5_file *file;
    haddr_t allocated, written; /* sizes of the file so far */
};

static H5FD_t *open_driven(const char *name, unsigned flags, hid_t access, haddr_t most)
{
    (void)name, (void)flags, (void)most;
    struct tri_h5_file *const *file = H5Pget_driver_info(access);
    struct driven *driven = file ? calloc(1, sizeof *driven) : NULL;
    if (!driven)
        return NULL;
    driven->file = *file;
    return &driven->head;
}

static herr_t close_driven(H5FD_t *head)
{
    free(head);
    return 0;
}

static herr_t get_features(const H5FD_t *head, unsigned long *flags)
{
    (void)head;
    *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
             H5FD_FEAT_AGGREGATE_SMALLDATA;
    return 0;
}

static haddr_t get_allocated(const H5FD_t *head, H5FD_mem_t kind)
{
    (void)kind;
    return ((const struct driven *)head)->allocated;
}

static herr_t set_allocated(H5FD_t *head, H5FD_mem_t kind, haddr_t end)
{
    (void)kind;
    ((struct driven *)head)->allocated = end;
    return 0;
}

static haddr_t get_written(const H5FD_t *head, H5FD_mem_t kind)
{
    (void)kind;
    return ((const struct driven *)head)->written;
}

static herr_t note(struct tri_h5_file *file, int failure)
{
    if (failure != 0 && file->failure == 0)
        file->failure = failure;
    return failure == 0 ? 0 : -1;
}

/* Reads bytes. Bytes never written are zeros. */
static herr_t read_driven(H5FD_t *head, H5FD_mem_t kind, hid_t transfer, haddr_t place, size_t size, void *data)
{
    const struct driven *driven = (const struct driven *)head;
    const int64_t got = tri_read_at(driven->file->output->file, data, size, place);
    (void)kind, (void)transfer;
    if (got < 0)
        return note(driven->file, errno);
    memset((char *)data + got, 0, size - (size_t)got);
    return 0;
}

static herr_t write_driven(H5FD_t *head, H5FD_mem_t kind, hid_t transfer, haddr_t place, size_t size, const void *data)
{
    struct driven *driven = (struct driven *)head;
    (void)kind, (void)transfer;
    if (data == driven->file->probed) {
        driven->file->found = (int64_t)place;
        return 0;
    }
    if (driven->written < place + size)
        driven->written = place + size;
    if (driven->file->failure == 0)
        (void)note(driven->file, tri_output_write_at(driven->file->output, place, data, size));
    return 0; /* if HDF5 were notified of a failure, it would not free all its resources */
}

/* Sets the file size to the end of the allocated space. */
static herr_t truncate_driven(H5FD_t *head, hid_t transfer, hbool_t closing)
{
    struct driven *driven = (struct driven *)head;
    (void)transfer, (void)closing;
    driven->written = driven->allocated;
    if (driven->file->failure != 0)
        return 0;
    return note(driven->file, tri_file_set_size(driven->file->output->file, driven->allocated) ? 0 : errno);
}

static const H5FD_class_t driver = {
#ifdef H5FD_CLASS_VERSION
    .version = H5FD_CLASS_VERSION,
    .value = (H5FD_class_value_t)H5_VFD_RESERVED + 73,
#endif
    .name = "tri_output",
    .maxaddr = (haddr_t)INT64_MAX,
    .fc_degree = H5F_CLOSE_STRONG,
    .fapl_size = sizeof(struct tri_h5_file *),
    .open = open_driven,
    .close = close_driven,
    .query = get_features,
    .get_eoa = get_allocated,
    .set_eoa = set_allocated,
    .get_eof = get_written,
    .read = read_driven,
    .write = write_driven,
    .truncate = truncate_driven,
    .fl_map = H5FD_FLMAP_SINGLE,
};

/* --- errors */

static herr_t take_reason(unsigned n, const H5E_error2_t *entry, void *user)
{
    struct tri_h5_reason *reason = user;
    if (n == 0)
        snprintf(reason->text, sizeof reason->text, "%s", entry->desc ? entry->desc : "");
    reason->no_memory = reason->no_memory || entry->min_num == H5E_NOSPACE || entry->maj_num == H5E_RESOURCE;
    return 0;
}

struct tri_h5_reason tri_h5_reason(void)
{
    struct tri_h5_reason reason = {"no reason given", false};
    (void)H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_reason, &reason);
    return reason;
}

enum tri_status tri_h5_fail(struct tri_h5_file *file, const char *what, struct tri_error *error)
{
    if (file->failure != 0)
        return tri_output_conclude(file->output, file->failure, error);
    struct tri_h5_reason reason = tri_h5_reason();
    file->output->failed = true;
    if (reason.no_memory)
        return tri_fail(error, TRI_NO_MEMORY, file->output->path, 0, "no memory to write %s (HDF5)", what);
    return tri_fail(error, TRI_CANNOT_WRITE, file->output->path, 0, "cannot write %s: HDF5 reports \"%s\"", what,
                    reason.text);
}

/* --- opening and closing */

static hid_t access_of(struct tri_h5_file *file)
{
    hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    if (access < 0)
        return access;
    if (H5Pset_driver(access, file->driver, &file) >= 0 && H5Pset_alignment(access, LARGE_BYTES, PAGE_BYTES) >= 0 &&
        H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110) >= 0)
        return access;
    H5Pclose(access);
    return -1;
}

hid_t tri_h5_no_times(hid_t kind)
{
    hid_t creation = H5Pcreate(kind);
    if (creation >= 0 && H5Pset_obj_track_times(creation, false) >= 0)
        return creation;
    tri_h5_close_id(H5Pclose, creation);
    return -1;
}

hid_t tri_h5_new_dataset(const struct tri_h5_file *file, const char *path, hid_t type, int rank, const hsize_t *size,
                         const hsize_t *most, hid_t creation)
{
    hid_t space = H5Screate_simple(rank, size, most), dataset = -1;
    if (space >= 0 && creation >= 0)
        dataset = H5Dcreate2(file->id, path, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    tri_h5_close_id(H5Pclose, creation);
    tri_h5_close_id(H5Sclose, space);
    return dataset;
}

enum tri_status tri_h5_create(struct tri_h5_file *file, struct tri_output *output, struct tri_error *error)
{
    *file = (struct tri_h5_file){.id = -1, .driver = -1, .output = output};
    if (!tri_output_has_offsets(output))
        return tri_fail(error, TRI_CANNOT_WRITE, output->path, 0, "an HDF5 file cannot be written to a device or pipe");
    file->driver = H5FDregister(&driver);
    hid_t access = file->driver >= 0 ? access_of(file) : -1, creation = tri_h5_no_times(H5P_FILE_CREATE);
    if (access >= 0 && creation >= 0)
        file->id = H5Fcreate(output->path, H5F_ACC_TRUNC, creation, access);
    enum tri_status status = file->id >= 0 ? TRI_OK : tri_h5_fail(file, "the file", error);
    tri_h5_close_id(H5Pclose, access);
    tri_h5_close_id(H5Pclose, creation);
    return status;
}

enum tri_status tri_h5_close(struct tri_h5_file *file, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (file->id >= 0 && (H5Fclose(file->id) < 0 || file->failure != 0))
        status = tri_h5_fail(file, "the file", error);
    if (file->driver >= 0)
        H5FDunregister(file->driver);
    file->id = file->driver = -1;
    return status;
}

/* --- groups and attributes */

bool tri_h5_add_group(struct tri_h5_file *file, const char *path)
{
    hid_t creation = tri_h5_no_times(H5P_GROUP_CREATE);
    if (creation < 0)
        return false;
    hid_t group = H5Gcreate2(file->id, path, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    return group >= 0 && H5Gclose(group) >= 0;
}

/* type: in the file; memory: type of data[]. */
static bool add_attribute(struct tri_h5_file *file, const char *path, const char *name, hid_t type, hid_t memory, int n,
                          const void *data)
{
    const hsize_t size = (hsize_t)n;
    hid_t space = n > 0 ? H5Screate_simple(1, &size, NULL) : H5Screate(H5S_SCALAR), attribute = -1;
    if (space < 0)
        return false;
    attribute = H5Acreate_by_name(file->id, path, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool done = attribute >= 0 && H5Awrite(attribute, memory, data) >= 0;
    H5Sclose(space);
    return attribute >= 0 && H5Aclose(attribute) >= 0 && done;
}

bool tri_h5_add_integers(struct tri_h5_file *file, const char *path, const char *name, int n, const int64_t *values)
{
    return add_attribute(file, path, name, H5T_STD_I64LE, H5T_NATIVE_INT64, n, values);
}

bool tri_h5_add_reals(struct tri_h5_file *file, const char *path, const char *name, int n, const double *values)
{
    return add_attribute(file, path, name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, n, values);
}

bool tri_h5_add_text(struct tri_h5_file *file, const char *path, const char *name, const char *text)
{
    hid_t type = H5Tcopy(H5T_C_S1);
    bool done = type >= 0 && H5Tset_size(type, strlen(text) + 1) >= 0 &&
                add_attribute(file, path, name, type, type, 0, text);
    return type >= 0 && H5Tclose(type) >= 0 && done;
}
