/* The arrays of a mesh under the names that other programs expect. This needs almost no space: a view is a virtual
 * dataset, which refers to data elsewhere in the file, or a second name (a hard link).
 *
 *     /VTKHDF                               VTK and ParaView: one unstructured grid, triangles and then segments as
 *                                           lines, as in .vtu files ("VTKHDF file format", docs.vtk.org)
 *     /geometry/vertices, /viz/topology/cells  PETSc: -dm_plex_create_from_hdf5_xdmf
 *
 * VTK requires three coordinates: the third column consists of the fill value. The cell types are two fill values. Only
 * the array of the end of each cell's nodes must be written (tri_h5_write_ends). */
#ifndef TRIANGLE_HDF5_VIEWS_H
#define TRIANGLE_HDF5_VIEWS_H

#include "triangle/hdf5/array.h"

/* Adds the views. arrays: by kind, after their end; those without a file do not exist. */
enum tri_status tri_h5_write_views(struct tri_h5_file *file, const struct tri_h5_array arrays[TRI_H5_KINDS],
                                   struct tri_error *error);

/* Adds a dataset of triangles + segments + 1 numbers: the end of each cell's nodes in the list of all nodes, which is
 * 0, 3, 6, .. for triangles and then grows by two per segment. VTK requires this array, of 8 bytes per cell;
 * compression reduces it to about a hundredth. TRI_NO_MEMORY and errors of writing. */
enum tri_status tri_h5_write_ends(struct tri_h5_file *file, const char *path, int64_t triangles, int64_t segments,
                                  struct tri_error *error);

/* Writes an XDMF file that describes the arrays of an HDF5 file in the same folder (XDMF model and format 3, xdmf.org).
 * It has one grid, the triangles, since readers such as meshio reject a second one. name: of the HDF5 file. */
enum tri_status tri_h5_write_xdmf(struct tri_output *output, const char *name,
                                  const struct tri_h5_array arrays[TRI_H5_KINDS], struct tri_error *error);

#endif
