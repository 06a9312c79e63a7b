/* Reads figures from files of Triangle and of other programs, and writes them. These functions are in the library
 * ptriangle-files. */
#ifndef PTRIANGLE_FILES_H
#define PTRIANGLE_FILES_H

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads a figure. The ending of path selects the format:
 *   x.poly  points, segments, holes and regions; if the file has no points, they are read from x.node
 *   x.node  points
 *   x.ele   a mesh: x.node and x.ele; also the segments of x.poly and the bounds of x.area if these files exist
 *   x.vtu, x.msh, x.2dm, x.14, x.grd  a mesh in the form that tri_file_write and the program ptriangle write. Each
 *           format stores a part of the figure (docs/formats.md). Other variants of these formats are errors. Of
 *           second-order triangles the corners are read
 * The HDF5 files (.h5) of ptriangle are not read here. They contain plain arrays, which any HDF5 library reads. Files
 * may count from 0 or from 1; *figure counts from 0. Extra words and fields, and missing attributes and markers, are
 * accepted. Text without a meaning in the format is an error.
 *
 * The caller initialises *figure with tri_no_figure, and frees its arrays with tri_file_free. Errors, with file and
 * line: TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_NO_MEMORY, TRI_TOO_LARGE. After an error *figure is empty. Time: linear,
 * about 250 MB of text per second. */
enum tri_status tri_file_read(const char *path, struct tri_figure *figure, struct tri_error *error);

/* Frees the arrays of a figure that tri_file_read has filled, and makes the figure empty. */
void tri_file_free(struct tri_figure *figure);

/* Writes a figure. The ending of name selects the files:
 *   x.vtu, x.msh, x.2dm, x.14, x.grd  one file for VTK, Gmsh, SMS or ADCIRC (docs/formats.md)
 *   x, x.node, x.ele, x.poly          x.node; also x.ele if the figure has triangles, and x.poly if it has segments.
 *                                     Numbers count from `first`, which is 0 or 1
 * Another suffix of letters, such as x.shp, is TRI_BAD_INPUT, and the error text lists the valid ones. Names such as
 * "run.1" and "mesh.v2" are allowed. Reading a file back gives the same coordinates: text has 17 digits, and binary
 * formats store the bytes. All files appear together once all are complete. After an error no file has changed.
 * Existing files are replaced. If a format stores the boundary, the segments must include it. Here triangles may be
 * [n][6], of second order: three corners, then the midpoints of the edges opposite to them. ADCIRC has no such
 * triangles.
 *
 * Errors: TRI_CANNOT_WRITE; TRI_NO_MEMORY; TRI_BAD_INPUT also if `first` is invalid, if an array has the wrong shape,
 * or if triangles or segments for one of these programs refer to points that do not exist. */
enum tri_status tri_file_write(const char *name, const struct tri_figure *figure, int first, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
