/* Where the nodes of each cell end in a list of all cells' nodes: 0, 3, 6, .. behind triangles, then in steps of two
 * behind segments. VTK wants this array in full, 8 bytes a cell; in the file it is deflated, to about a hundredth. */
#ifndef TRIANGLE_HDF5_ENDS_H
#define TRIANGLE_HDF5_ENDS_H

#include "triangle/hdf5/file.h"

/* Adds the dataset, of triangles + segments + 1 numbers. TRI_NO_MEMORY and errors of writing. */
enum tri_status tri_h5_write_ends(struct tri_h5_file *file, const char *path, int64_t triangles, int64_t segments,
                                  struct tri_error *error);

#endif
