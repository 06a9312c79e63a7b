/* Meshes in the file formats of other programs, written and read.
 *
 * All formats hold the nodes, the triangles and the boundary with its markers. docs/formats.md describes what else each
 * can hold, and how it is read. Numbers are exact: binary, or %.17g. Sizes are 64 bits wide. Each writer is a
 * tri_write_call (triangle/text/write.h): rows are computed one by one, so that the grid may be stored anywhere. */
#ifndef TRIANGLE_TEXT_FORMATS_H
#define TRIANGLE_TEXT_FORMATS_H

#include "triangle/mesh/pslg.h"
#include "triangle/text/write.h"

enum { TRI_OPEN_BOUNDARY = 2 }; /* marker of open boundaries in fort.14; all others are land */

tri_write_call tri_write_vtu; /* VTK XML, unstructured grid: binary, appended raw */
tri_write_call tri_write_msh; /* Gmsh 4.1, binary */
tri_write_call tri_write_2dm; /* SMS */
tri_write_call tri_write_14;  /* ADCIRC; no second-order triangles: returns TRI_BAD_INPUT */

/* Writes the mesh divided into n parts (triangle/text/parts.h), each to its own file. */
enum { TRI_MOST_PARTS = 512 };
typedef enum tri_status tri_write_parts_call(struct tri_output *const *outputs, int n, const struct tri_grid *grid,
                                             const struct tri_executor *executor, struct tri_error *error);
tri_write_parts_call tri_write_msh_parts;

/* Reads files of this project's writer, and compatible files of other programs (docs/formats.md): points, triangles,
 * segments, and markers and attributes if present. Corners and ends are valid point numbers, and coordinates are
 * finite. Both structs must be empty, and must be freed in any case. TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_TOO_LARGE,
 * TRI_NO_MEMORY. Memory: about twice the file. Time is linear, or n log n if nodes are not numbered in order. */
typedef enum tri_status tri_read_call(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                                      const struct tri_executor *executor, struct tri_error *error);
tri_read_call tri_read_vtu; /* one piece, arrays appended raw or as text */
tri_read_call tri_read_msh; /* 4.1, binary; also a part of a mesh */
tri_read_call tri_read_msh_data; /* the same; the first data at nodes become an attribute, regardless of their name */
tri_read_call tri_read_2dm;
tri_read_call tri_read_14;

struct tri_format {
    const char *suffix; /* suffix of file names, in lower case */
    const char *name;   /* the program or organisation behind it */
    bool second_order;   /* can hold second-order triangles */
    bool inner_segments; /* can hold segments that are not on the boundary */
    int32_t base;        /* first number of nodes and elements in files of its writer */
    tri_write_call *write;             /* writes a mesh */
    tri_write_parts_call *write_parts; /* NULL: the format has no parts */
    tri_read_call *read;               /* reads a mesh */
};

/* Returns the format for the ending of a file name (tri_name_ends); NULL: none of these formats. */
const struct tri_format *tri_format_of(const char *name);
#define TRI_FORMAT_SUFFIXES ".vtu, .msh, .2dm, .14, .grd"

/* Returns the suffix of a name, including its dot, if it seems to ask for a format that is not one of these; otherwise
 * NULL. A suffix is the text after the last dot if it consists of letters (or is h5, hdf5, gr3, su2 or 3dm): "x.shp"
 * has one; "run.1", "mesh.v2" and ".hidden" have none. Triangle's own suffixes count as well: see tri_format_base. */
const char *tri_format_missing(const char *name);

/* Returns the length of the base name of Triangle's files: the whole name without a final .node, .ele or .poly. */
size_t tri_format_base(const char *name);

#endif
