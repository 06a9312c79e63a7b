/* An HDF5 file in a tri_output (triangle/text/output.h), with the same temporary names, locks, stop requests and errors
 * as other outputs.
 *
 * To make files reproducible, no time stamps are stored, and the version of the file format is fixed (1.10, the oldest
 * one with virtual datasets). */
#ifndef TRIANGLE_HDF5_FILE_H
#define TRIANGLE_HDF5_FILE_H

#include <hdf5.h>

#include "triangle/base/status.h"
#include "triangle/text/output.h"

struct tri_h5_file {
    hid_t id;       /* HDF5 identifier; < 0: not open */
    hid_t driver;   /* HDF5 identifier of the file driver; < 0: none */
    struct tri_output *output; /* borrowed */
    int failure;    /* first failure, as from tri_output_write_at; 0: none. Later writes are ignored but reported to
                       HDF5 as successful, so that it frees its resources */
    const void *probed; /* for writes from this address, only their file offset is recorded, in `found`; NULL: none */
    int64_t found;      /* that offset; < 0: no such write yet */
};

/* Creates the file in an output with offsets; otherwise returns TRI_CANNOT_WRITE. Call tri_h5_close in any case. The
 * struct must not move. */
enum tri_status tri_h5_create(struct tri_h5_file *file, struct tri_output *output, struct tri_error *error);

/* Flushes and closes the file if it is open; the output stays open. */
enum tri_status tri_h5_close(struct tri_h5_file *file, struct tri_error *error);

/* Reports an error after a call of HDF5 has failed: the first failed write, or HDF5's own message. Never returns
 * TRI_OK. */
enum tri_status tri_h5_fail(struct tri_h5_file *file, const char *what, struct tri_error *error);

/* The innermost message of HDF5's error stack, and whether the cause was lack of memory. */
struct tri_h5_reason {
    char text[200]; /* the message */
    bool no_memory; /* the cause was lack of memory */
};
struct tri_h5_reason tri_h5_reason(void);

/* Closes an object; does nothing if id < 0. */
static inline void tri_h5_close_id(herr_t (*close_call)(hid_t), hid_t id)
{
    if (id >= 0)
        close_call(id);
}

/* Returns creation properties of a file, group or dataset (H5P_.._CREATE) without time stamps; the caller closes them.
 * < 0: an error. */
hid_t tri_h5_no_times(hid_t kind);

/* Creates a dataset of the given size, which may grow to `most` (NULL: fixed size). Closes the properties; if they are
 * invalid (< 0), fails. < 0: an error. */
hid_t tri_h5_new_dataset(const struct tri_h5_file *file, const char *path, hid_t type, int rank, const hsize_t *size,
                         const hsize_t *most, hid_t creation);

/* Add a group or an attribute; paths start at the root. They return false if HDF5 fails (see tri_h5_fail). */
bool tri_h5_add_group(struct tri_h5_file *file, const char *path);

/* Adds an attribute of n numbers or, if n is 0, a scalar. */
bool tri_h5_add_integers(struct tri_h5_file *file, const char *path, const char *name, int n, const int64_t *values);
bool tri_h5_add_reals(struct tri_h5_file *file, const char *path, const char *name, int n, const double *values);
bool tri_h5_add_text(struct tri_h5_file *file, const char *path, const char *name, const char *text);

#endif
