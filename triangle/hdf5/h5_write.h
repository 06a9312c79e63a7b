/* Writes a stream of tiles as an HDF5 file: the arrays of triangle/hdf5/rows.h, views for other programs, and a short
 * XDMF file that describes the arrays, for programs that read XDMF.
 *
 * The bytes depend on the mesh only, not on its division into tiles. Point numbers are stored as 32 bits as long as
 * they fit. If one does not, the array of triangles is rewritten once. (The size is not known before the end, and these
 * numbers are half of a file.) Memory: about 20 MB, regardless of the size of the mesh. */
#ifndef TRIANGLE_HDF5_H5_WRITE_H
#define TRIANGLE_HDF5_H5_WRITE_H

#include "ptriangle/tiles.h"
#include "triangle/hdf5/rows.h"
#include "triangle/text/output.h"

struct tri_h5_options {
    const char *program;   /* program name and version, for /about */
    const char *name;      /* name of the file as referenced by the XDMF file */
    bool markers;          /* write markers */
    struct tri_output *file, *xdmf; /* open outputs of the caller; `file` must have offsets */
    int64_t n_orphans;     /* with several ranks: number of points that are left out */
    int64_t max_narrow;   /* number of points up to which 32-bit numbers are used; <= 0: the maximum */
};

struct tri_h5_writer;

/* Estimates the memory that a writer uses for a mesh of this size. Measured. */
static inline double tri_h5_writer_bytes(double triangles)
{
    const double least = 2e7 + 40 * triangles, most = 6e7;
    return least < most ? least : most;
}

/* Does this build have HDF5? */
bool tri_h5_is_available(void);

/* Makes a sink that writes the file; if the stream begins again, the file is written again from the start. Call the
 * sink from one thread at a time. After the end of the stream the outputs are complete and the caller commits them.
 * After a failure, or without an end, the caller aborts them. Texts and outputs in the options must outlive the writer.
 * TRI_NO_MEMORY; TRI_CANNOT_WRITE: this build has no HDF5. Errors of the sink: those of triangle/text/output.h. */
enum tri_status tri_h5_writer_new(struct tri_h5_writer **writer, const struct tri_h5_options *options,
                                  struct tri_sink *sink, struct tri_error *error);

/* With several ranks (a stream with n_ranks > 1) the writer is on one of them, and its sink is called only for the
 * beginning and the end. At the beginning it allocates all arrays. Between these calls, all ranks write their rows to
 * the offsets in this layout (triangle/hdf5/rows.h), which belongs to the writer. */
const struct tri_h5_layout *tri_h5_writer_layout(const struct tri_h5_writer *writer);

/* With several ranks the writer cannot determine the following values. Set them before the end: the number of points
 * that existed before refinement, and the bounds of all points. */
void tri_h5_writer_set_totals(struct tri_h5_writer *writer, int64_t n_input, const double bounds[4]);

/* NULL is allowed. */
void tri_h5_writer_free(struct tri_h5_writer *writer);

#endif
