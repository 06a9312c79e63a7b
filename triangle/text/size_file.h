/* Edge lengths in files: rasters, and meshes with a length at each vertex (docs/formats.md, "Sizes").
 *
 * A damaged file is rejected with a one-sentence error, which names the line of a text. Counts are compared with the
 * number of remaining bytes before memory is allocated. Numbers that are not above 0, and no-data values, stay in the
 * field as no data (struct tri_size_field). In a binary array NaN is no data as well. */
#ifndef TRIANGLE_TEXT_SIZE_FILE_H
#define TRIANGLE_TEXT_SIZE_FILE_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/text/words.h"

struct tri_size_file {
    struct tri_size_field field; /* of kind RASTER or MESH; its arrays are those below */
    double *values, *points;     /* from malloc; points: NULL for a raster */
    int32_t *triangles;          /* from malloc; NULL for a raster */
};

#define TRI_SIZE_SUFFIXES ".asc, .npy, .node, .msh, .pos, .vtu, .2dm, .14, .grd"

/* Does the name end in one of these suffixes? */
bool tri_size_file_is_known(const char *path);

/* Reads a field in the format of its suffix. extent: x, y of the first and x, y of the last value of a .npy file; NULL:
 * not given. Free *file in any case. TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_TOO_LARGE, TRI_NO_MEMORY. */
enum tri_status tri_size_file_read(struct tri_size_file *file, const char *path, const double extent[4],
                                   const struct tri_executor *executor, struct tri_error *error);
void tri_size_file_free(struct tri_size_file *file);

/* --- readers of single formats. Those of meshes fill words->to, with one attribute per point. */

/* Allocates the values for the given numbers of rows and columns. */
bool tri_size_raster_begin(struct tri_words *words, struct tri_size_file *file, int64_t rows, int64_t columns);

bool tri_size_read_asc(struct tri_words *words, struct tri_size_file *file);
bool tri_size_read_jigsaw(struct tri_words *words, struct tri_size_file *file); /* meshes and grids */
bool tri_size_read_gmsh(struct tri_words *words); /* versions 2.2 and 4.1 as text */
bool tri_size_read_pos(struct tri_words *words);  /* a parsed view of Gmsh */
enum tri_status tri_size_read_npy(struct tri_size_file *file, const char *path, const double extent[4],
                                  struct tri_error *error);

#endif
