/* A stream of tiles as an HDF5 file: the arrays of triangle/hdf5/rows.h, views for other programs, and beside the
 * file a short XDMF text that names its arrays, for what reads meshes by way of that.
 *
 * The bytes depend on the mesh alone, not on how it was cut into tiles. Numbers of points take 32 bits as long as they
 * fit; only when one does not the array of triangles is rewritten, once: sizes are not known before the end, and half
 * of a file are these numbers. Memory: about 20 MB, whatever the mesh. */
#ifndef TRIANGLE_HDF5_H5_WRITE_H
#define TRIANGLE_HDF5_H5_WRITE_H

#include "ptriangle/tiles.h"
#include "triangle/hdf5/rows.h"
#include "triangle/text/output.h"

struct tri_h5_options {
    const char *program;   /* name and version, for /about */
    const char *name;      /* of the file, as the XDMF text beside it calls it */
    bool markers;          /* they are written */
    struct tri_output *file, *xdmf; /* opened, and the caller's; the first has places */
    int64_t n_orphans;     /* points of a stream on several ranks that are left out */
    int64_t most_narrow;   /* so many points have 32-bit numbers; <= 0: as many as can */
};

struct tri_h5_writer;

/* Bytes of memory that a writer takes while it is given a mesh of so many triangles. Measured. */
static inline double tri_h5_writer_bytes(double triangles)
{
    const double least = 2e7 + 40 * triangles, most = 6e7;
    return least < most ? least : most;
}

/* Is there HDF5 in this build? */
bool tri_h5_is_there(void);

/* *sink writes the file, anew where it is told of the beginning again; its calls come from one thread at a time. After
 * its end the outputs are complete, and their owner commits them; after any failure, or where no end comes, he aborts
 * them. Texts and outputs of the options outlive the writer. TRI_NO_MEMORY; TRI_CANNOT_WRITE: this build has no HDF5.
 * Errors of the sink: those of triangle/text/output.h. */
enum tri_status tri_h5_writer_new(struct tri_h5_writer **writer, const struct tri_h5_options *options,
                                  struct tri_sink *sink, struct tri_error *error);

/* On several ranks (a stream with n_ranks > 1) the writer, which is on one of them, is told of the beginning and the
 * end alone: at the beginning it gives all arrays their places, which are known from then on, and whoever has rows puts
 * them there (triangle/hdf5/rows.h), until before the end. The layout is the writer's. */
const struct tri_h5_layout *tri_h5_writer_layout(const struct tri_h5_writer *writer);

/* What it has to know then, before the end: points that there were before refinement, and the bounds of all. */
void tri_h5_writer_tell(struct tri_h5_writer *writer, int64_t n_input, const double bounds[4]);

/* NULL is fine. */
void tri_h5_writer_free(struct tri_h5_writer *writer);

#endif
