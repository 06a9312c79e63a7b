/* An HDF5 file behind a tri_output (triangle/text/output.h): its temporary name, its lock, its stop and its errors are
 * those of every other output.
 *
 * So that the same mesh gives the same bytes: no times are kept, and the version of the file format is fixed (1.10,
 * the oldest that knows virtual datasets). */
#ifndef TRIANGLE_HDF5_FILE_H
#define TRIANGLE_HDF5_FILE_H

#include <hdf5.h>

#include "triangle/base/status.h"
#include "triangle/text/output.h"

struct tri_h5_file {
    hid_t id;       /* of the file; < 0: not open */
    hid_t driver;
    struct tri_output *output; /* borrowed */
    int failure;    /* what writing has met first, as of tri_output_write_at; 0: nothing. From then on nothing is
                       written, and HDF5 is told that all is well, so that it lets go of what it has */
    const void *sought; /* what is written from there is not: the driver tells where it would have gone; NULL */
    int64_t found;      /* there; < 0: nothing has come */
};

/* Creates the file in an output that has places: else TRI_CANNOT_WRITE. To be closed in any case; may not move. */
enum tri_status tri_h5_create(struct tri_h5_file *file, struct tri_output *output, struct tri_error *error);

/* Writes what HDF5 has kept, and closes the file, unless that has been done; the output stays open. */
enum tri_status tri_h5_close(struct tri_h5_file *file, struct tri_error *error);

/* What to say after a call of HDF5 has failed: what writing met, or what HDF5 tells. Never TRI_OK. */
enum tri_status tri_h5_fail(struct tri_h5_file *file, const char *what, struct tri_error *error);

/* The innermost message of HDF5's stack of errors, and whether memory was the reason. */
struct tri_h5_reason {
    char text[200];
    bool no_memory;
};
struct tri_h5_reason tri_h5_reason(void);

/* Closes what there is; id < 0: nothing. */
static inline void tri_h5_drop(herr_t (*close_call)(hid_t), hid_t id)
{
    if (id >= 0)
        close_call(id);
}

/* Properties of a new file, group or dataset (H5P_.._CREATE) that keeps no times; to be closed. < 0: an error. */
hid_t tri_h5_no_times(hid_t kind);

/* A new dataset of that size, which may grow to `most` (NULL: not). Closes the properties, whose failure (< 0) is
 * passed on. < 0: an error. */
hid_t tri_h5_new_dataset(const struct tri_h5_file *file, const char *path, hid_t type, int rank, const hsize_t *size,
                         const hsize_t *most, hid_t creation);

/* Groups and attributes, by paths that begin at the root. False: HDF5 could not (tri_h5_fail tells). */
bool tri_h5_add_group(struct tri_h5_file *file, const char *path);

/* An attribute of n numbers, or, where n is 0, of a single one that is no array. */
bool tri_h5_add_integers(struct tri_h5_file *file, const char *path, const char *name, int n, const int64_t *values);
bool tri_h5_add_reals(struct tri_h5_file *file, const char *path, const char *name, int n, const double *values);
bool tri_h5_add_text(struct tri_h5_file *file, const char *path, const char *name, const char *text);

#endif
