/* A mesh in files of other programs.
 *
 * All carry the nodes, the triangles and the boundary with its markers; what else each can hold, and how it is read
 * again: docs/formats.md. Numbers are exact: bytes, or %.17g. Sizes are 64 bits wide. Each writer is a tri_write_call
 * (triangle/text/write.h): rows are worked out one by one, so that the grid may lie anywhere. */
#ifndef TRIANGLE_TEXT_FORMATS_H
#define TRIANGLE_TEXT_FORMATS_H

#include "triangle/text/write.h"

#ifdef __cplusplus
extern "C" {
#endif

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

struct tri_format {
    const char *suffix; /* of the files' names, in small letters */
    const char *name;   /* whose format */
    bool second_order;  /* it can hold second-order triangles */
    tri_write_call *write;
    tri_write_parts_call *write_parts; /* NULL: it has no parts */
};

/* The format that the name of a file asks for by its end (tri_name_ends); NULL: none of these. */
const struct tri_format *tri_format_of(const char *name);

#ifdef __cplusplus
}
#endif

#endif
