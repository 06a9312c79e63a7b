/* An XDMF text that names the arrays of an HDF5 file (XDMF model and format 3, xdmf.org). One grid, the triangles,
 * since readers such as meshio refuse a second one. */
#ifndef TRIANGLE_HDF5_XDMF_H
#define TRIANGLE_HDF5_XDMF_H

#include "triangle/hdf5/array.h"

/* name: of the file, which lies beside the text. */
enum tri_status tri_h5_write_xdmf(struct tri_output *output, const char *name,
                                  const struct tri_h5_array arrays[TRI_H5_KINDS], struct tri_error *error);

#endif
