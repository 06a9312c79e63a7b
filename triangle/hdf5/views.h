/* The arrays of a mesh once more, where other programs look for them. Nearly nothing is written for it: a view is a
 * virtual dataset, which says where its numbers lie, or a second name (a hard link).
 *
 *     /VTKHDF                               VTK and ParaView: one unstructured grid, triangles and then segments as
 *                                           lines, as in .vtu files ("VTKHDF file format", docs.vtk.org)
 *     /geometry/vertices, /viz/topology/cells  PETSc: -dm_plex_create_from_hdf5_xdmf
 *
 * VTK wants three coordinates: the third column has no data but its fill value. The kinds of the cells are two fill
 * values. Where the nodes of each cell end is the one array that must be written (tri_h5_write_ends). */
#ifndef TRIANGLE_HDF5_VIEWS_H
#define TRIANGLE_HDF5_VIEWS_H

#include "triangle/hdf5/array.h"

/* arrays: by kind, as they have ended; those without a file are not there. */
enum tri_status tri_h5_write_views(struct tri_h5_file *file, const struct tri_h5_array arrays[TRI_H5_KINDS],
                                   struct tri_error *error);

/* Where the nodes of each cell end in a list of all cells' nodes: 0, 3, 6, .. behind triangles, then in steps of two
 * behind segments. VTK wants this array in full, 8 bytes a cell; in the file it is deflated, to about a hundredth. Adds
 * the dataset, of triangles + segments + 1 numbers. TRI_NO_MEMORY and errors of writing. */
enum tri_status tri_h5_write_ends(struct tri_h5_file *file, const char *path, int64_t triangles, int64_t segments,
                                  struct tri_error *error);

/* An XDMF text that names the arrays of an HDF5 file (XDMF model and format 3, xdmf.org). One grid, the triangles,
 * since readers such as meshio refuse a second one. name: of the file, which lies beside the text. */
enum tri_status tri_h5_write_xdmf(struct tri_output *output, const char *name,
                                  const struct tri_h5_array arrays[TRI_H5_KINDS], struct tri_error *error);

#endif
