/* Lengths of edges in files: rasters, and meshes with a length at each vertex (docs/formats.md, "Sizes").
 *
 * A reader refuses a damaged file in one sentence, with the line in a text. Counts are compared with the bytes that are
 * left before room is made for them. A number that is not above 0, and a no-data value, stay in the field as no data
 * (struct tri_size_field). In a binary array NaN is no data, too. */
#ifndef TRIANGLE_TEXT_SIZE_FILE_H
#define TRIANGLE_TEXT_SIZE_FILE_H

#include "triangle/base/executor.h"
#include "triangle/base/status.h"
#include "triangle/text/words.h"

struct tri_size_file {
    struct tri_size_field field; /* RASTER or MESH, whose arrays are .. */
    double *values, *points;     /* .. these, malloc'ed; points: NULL for a raster */
    int32_t *triangles;          /* likewise */
};

#define TRI_SIZE_SUFFIXES ".asc, .npy, .node, .msh, .pos, .vtu, .2dm, .14, .grd"

/* Does the name end in one of these? */
bool tri_size_file_is_known(const char *path);

/* Reads a field; the suffix says the format. extent: for .npy, the places of the first value and of the last one: x and
 * y, x and y; NULL: not given. *file is to be freed in any case. TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_TOO_LARGE,
 * TRI_NO_MEMORY. */
enum tri_status tri_size_file_read(struct tri_size_file *file, const char *path, const double extent[4],
                                   const struct tri_executor *executor, struct tri_error *error);
void tri_size_file_free(struct tri_size_file *file);

/* --- the readers. Those of meshes fill words->to, with one attribute a point. */

/* Room for the values, of so many rows and columns. */
bool tri_size_raster_begin(struct tri_words *words, struct tri_size_file *file, int64_t rows, int64_t columns);

bool tri_size_read_asc(struct tri_words *words, struct tri_size_file *file);
bool tri_size_read_jigsaw(struct tri_words *words, struct tri_size_file *file); /* both kinds */
bool tri_size_read_gmsh(struct tri_words *words); /* 2.2 and 4.1 as text */
bool tri_size_read_pos(struct tri_words *words);  /* what Gmsh calls a parsed view */
enum tri_status tri_size_read_npy(struct tri_size_file *file, const char *path, const double extent[4],
                                  struct tri_error *error);

#endif
