/* The arrays of a mesh once more, where other programs look for them. Nearly nothing is written for it: a view is a
 * virtual dataset, which says where its numbers lie, or a second name (a hard link).
 *
 *     /VTKHDF                               VTK and ParaView: one unstructured grid, triangles and then segments as
 *                                           lines, as in .vtu files ("VTKHDF file format", docs.vtk.org)
 *     /geometry/vertices, /viz/topology/cells  PETSc: -dm_plex_create_from_hdf5_xdmf
 *
 * VTK wants three coordinates: the third column has no data but its fill value. The kinds of the cells are two fill
 * values. Where the nodes of each cell end is the one array that must be written (triangle/hdf5/ends.h). */
#ifndef TRIANGLE_HDF5_VIEWS_H
#define TRIANGLE_HDF5_VIEWS_H

#include "triangle/hdf5/array.h"

/* arrays: by kind, as they have ended; those without a file are not there. */
enum tri_status tri_h5_write_views(struct tri_h5_file *file, const struct tri_h5_array arrays[TRI_H5_KINDS],
                                   struct tri_error *error);

#endif
