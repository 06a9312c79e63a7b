/* Triangle's files, and meshes in the formats of other programs, read into figures and written from them; in the
 * library ptriangle-files. */
#ifndef PTRIANGLE_FILES_H
#define PTRIANGLE_FILES_H

#include "ptriangle/tri.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Reads, by the ending of path,
 *   x.poly  points, segments, holes and regions; the points from x.node where the file has none;
 *   x.node  points;
 *   x.ele   a mesh: x.node, x.ele, and the segments of x.poly and the bounds of x.area where there are such files;
 *   x.vtu, x.msh, x.2dm, x.14, x.grd  a mesh, as tri_file_write and the program ptriangle write them, with what the
 *           format keeps of it (docs/formats.md); what they do not write is refused. Of second-order triangles the
 *           corners.
 * The HDF5 files (.h5) of the program are not read here: they are plain arrays, for any HDF5 library. Files may count
 * from 0 or from 1; *figure counts from 0. Strict where the format has no meaning, lenient where it has
 * one: words between numbers, extra fields, missing attributes and markers.
 *
 * *figure comes from tri_no_figure; its arrays belong to it until tri_file_free. Errors, with file and line:
 * TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_NO_MEMORY, TRI_TOO_LARGE; *figure is empty then. Linear; about 250 MB of text a
 * second. */
enum tri_status tri_file_read(const char *path, struct tri_figure *figure, struct tri_error *error);

/* Frees the arrays of a figure that was read, and empties it. */
void tri_file_free(struct tri_figure *figure);

/* Writes a figure: by the ending of name,
 *   x.vtu, x.msh, x.2dm, x.14, x.grd  this file alone, for VTK, Gmsh, SMS, ADCIRC (docs/formats.md);
 *   x, x.node, x.ele, x.poly          x.node, x.ele where the figure has triangles, and x.poly where it has segments,
 *                                     counting from `first`, 0 or 1.
 * Another suffix of letters alone, such as x.shp, is TRI_BAD_INPUT, and the text lists those there are; "run.1" and
 * "mesh.v2" are names. Coordinates have 17 digits, or are bytes: what is read back is the same. All files appear
 * together, when all are complete, or none; files that exist are replaced. The boundary, where a format asks for it, is
 * among the segments. TRI_CANNOT_WRITE, TRI_NO_MEMORY; TRI_BAD_INPUT also: another `first`, an array has not the shape
 * it should have, or triangles and segments for those formats name points that are not there. Here triangles may be
 * [n][6], of second order: behind the corners the points amid the edges opposite to them. ADCIRC's files hold none. */
enum tri_status tri_file_write(const char *name, const struct tri_figure *figure, int first, struct tri_error *error);

#ifdef __cplusplus
}
#endif

#endif
