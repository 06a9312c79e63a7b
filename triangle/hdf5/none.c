/* Replacement for a build without HDF5: opening fails with a message. */
#include <assert.h>
#include <stddef.h>

#include "triangle/hdf5/h5_read.h"
#include "triangle/hdf5/h5_write.h"

static const char NO_HDF5[] = "this build has no HDF5 (Debian: libhdf5-dev, then build again)";

bool tri_h5_is_available(void) { return false; }

enum tri_status tri_h5_writer_new(struct tri_h5_writer **writer, const struct tri_h5_options *options,
                                  struct tri_sink *sink, struct tri_error *error)
{
    (void)sink;
    *writer = NULL;
    return tri_fail(error, TRI_CANNOT_WRITE, options->name, 0, "%s", NO_HDF5);
}

void tri_h5_writer_free(struct tri_h5_writer *writer) { (void)writer; }

const struct tri_h5_layout *tri_h5_writer_layout(const struct tri_h5_writer *writer)
{
    (void)writer;
    assert(false);
    return NULL;
}

void tri_h5_writer_set_totals(struct tri_h5_writer *writer, int64_t n_input, const double bounds[4])
{
    (void)writer, (void)n_input, (void)bounds;
}

enum tri_status tri_h5_open(const char *path, struct tri_h5 **h5, struct tri_error *error)
{
    *h5 = NULL;
    return tri_fail(error, TRI_CANNOT_READ, path, 0, "%s", NO_HDF5);
}

void tri_h5_free(struct tri_h5 *h5) { (void)h5; }

/* --- never called, since nothing can be opened */

const struct tri_h5_counts *tri_h5_count(const struct tri_h5 *h5)
{
    (void)h5;
    assert(false);
    return NULL;
}

enum tri_status tri_h5_read(const struct tri_h5 *h5, enum tri_h5_kind kind, int64_t first, int64_t n, void *out,
                            struct tri_error *error)
{
    (void)h5, (void)kind, (void)first, (void)n, (void)out;
    return tri_fail(error, TRI_INTERNAL, NULL, 0, "%s", NO_HDF5);
}
