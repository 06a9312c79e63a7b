/* Writing a mesh: which of Triangle's files are made, and their rows, straight from the mesh. */
#ifndef DRIVERS_MESH_MESH_FILES_H
#define DRIVERS_MESH_MESH_FILES_H

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/long_options.h"
#include "triangle/base/executor.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/mesh/mesh.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/output.h"

enum { MESH_FILES_MOST_NAMES = 16 };

/* Bytes of memory for rows on their way to a file: a triangle, and at the most. */
enum { MESH_FILES_ROW_BYTES = 64, MESH_FILES_BYTES = 20 << 20 };

/* Names of files, borrowed. */
struct file_names {
    int n;
    const char *name[MESH_FILES_MOST_NAMES];
};

/* What is written, and how. All borrowed. */
struct mesh_files {
    const struct arguments *arguments;
    const struct console *console;
    const struct tri_executor *executor; /* NULL: one task after another */
    const struct tri_mesh *mesh;         /* without free numbers */
    const struct tri_pslg *pslg;         /* the input: its points are written bit by bit as they were read */
    bool points_in_poly;                 /* the points came from a .poly file */
    int32_t base;                        /* 0 or 1 */
    const struct tri_elements *elements; /* -r: the input's triangles; else n is 0 */
    const struct long_options *options;  /* files in other formats, and how */
    const bool *is_edge;                 /* [n_segments] -rp: the segments of the input that are not are written again;
                                            NULL: no -r */
};

/* Is the file with this suffix, ".node", among those that are written? */
bool mesh_files_has(const struct mesh_files *files, const char *suffix);

/* Looks whether all files, and further ones, could be created, so that nobody waits for a mesh that cannot be kept, and
 * whether each is a file of its own that nobody has read. Leaves nothing behind. Only the arguments, options and
 * points_in_poly must be set. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status mesh_files_check(const struct mesh_files *files, const struct file_names *further,
                                 const struct file_names *read, struct tri_error *error);

/* Writes all of them into the guarded set (drivers/interrupt.h), whoever fails: its caller commits or aborts. Says a
 * line for each, and one for all parts of a mesh. */
enum tri_status mesh_files_write(const struct mesh_files *files, struct tri_output_set *set, struct tri_error *error);

#endif
