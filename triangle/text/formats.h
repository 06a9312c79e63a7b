/* A mesh in files of other programs, written and read.
 *
 * All carry the nodes, the triangles and the boundary with its markers; what else each can hold, and how it is read
 * again: docs/formats.md. Numbers are exact: bytes, or %.17g. Sizes are 64 bits wide. Each writer is a tri_write_call
 * (triangle/text/write.h): rows are worked out one by one, so that the grid may lie anywhere. */
#ifndef TRIANGLE_TEXT_FORMATS_H
#define TRIANGLE_TEXT_FORMATS_H

#include "triangle/mesh/pslg.h"
#include "triangle/text/write.h"

enum { TRI_OPEN_BOUNDARY = 2 }; /* marker by which fort.14 tells open boundaries from land */

tri_write_call tri_write_vtu; /* VTK XML, unstructured grid: binary, appended raw */
tri_write_call tri_write_msh; /* Gmsh 4.1, binary */
tri_write_call tri_write_2dm; /* SMS */
tri_write_call tri_write_14;  /* ADCIRC; no second-order triangles: TRI_BAD_INPUT */

/* The mesh cut into n parts (triangle/text/parts.h), each in a file of its own. */
enum { TRI_MOST_PARTS = 512 };
typedef enum tri_status tri_write_parts_call(struct tri_output *const *outputs, int n, const struct tri_grid *grid,
                                             const struct tri_executor *executor, struct tri_error *error);
tri_write_parts_call tri_write_msh_parts;

/* Reads what the writer of that name makes, and what of others is like it (docs/formats.md): points, triangles,
 * segments, and what there is of markers and attributes; corners and ends are numbers of points, coordinates finite.
 * Both structs are empty before, and to be freed in any case. TRI_CANNOT_READ, TRI_BAD_INPUT, TRI_TOO_LARGE,
 * TRI_NO_MEMORY. Memory: about twice the file. Linear, but for nodes that are not numbered in order: n log n. */
typedef enum tri_status tri_read_call(const char *path, struct tri_pslg *mesh, struct tri_elements *elements,
                                      const struct tri_executor *executor, struct tri_error *error);
tri_read_call tri_read_vtu; /* one piece, arrays appended raw or as text */
tri_read_call tri_read_msh; /* 4.1, binary; a part of a mesh, too */
tri_read_call tri_read_msh_data; /* the same; the first numbers at nodes are an attribute, however they are called */
tri_read_call tri_read_2dm;
tri_read_call tri_read_14;

struct tri_format {
    const char *suffix; /* of the files' names, in small letters */
    const char *name;   /* whose format */
    bool second_order;   /* it can hold second-order triangles, */
    bool inner_segments; /* and segments that are not on the boundary */
    int32_t base;        /* what numbers of its nodes and elements count from, in files of its writer */
    tri_write_call *write;
    tri_write_parts_call *write_parts; /* NULL: it has no parts */
    tri_read_call *read;
};

/* The format that the name of a file asks for by its end (tri_name_ends); NULL: none of these. */
const struct tri_format *tri_format_of(const char *name);
#define TRI_FORMAT_SUFFIXES ".vtu, .msh, .2dm, .14, .grd"

/* The suffix of a name, with its dot, where it asks for a format that is none of these; NULL: the name asks for none. A
 * suffix is what follows the last dot, if that is letters alone (or h5, hdf5, gr3, su2, 3dm): "x.shp" has one, "run.1",
 * "mesh.v2" and ".hidden" have not. Triangle's own suffixes are such, too: see tri_format_base. */
const char *tri_format_missing(const char *name);

/* How much of a name is the base of Triangle's files: all of it, less .node, .ele or .poly at its end. */
size_t tri_format_base(const char *name);

#endif
