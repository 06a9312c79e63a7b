/* Writing a mesh: which of Triangle's files are made, and their rows, straight from the mesh. */
#ifndef DRIVERS_MESH_MESH_FILES_H
#define DRIVERS_MESH_MESH_FILES_H

#include <stdbool.h>

#include "drivers/mesh/size_options.h"
#include "triangle/mesh/grid.h"
#include "triangle/text/formats.h"

struct run; /* drivers/mesh/stages.h */

enum { MESH_FILES_MOST_NAMES = 4 + SIZE_OPTIONS_MOST };

/* Names of files, borrowed. */
struct file_names {
    int n;
    const char *name[MESH_FILES_MOST_NAMES];
};

/* Is the file with this suffix, ".node", among those that are written? */
bool mesh_files_has(const struct run *run, const char *suffix);

/* Looks whether all files of the run could be created, so that nobody waits for a mesh that cannot be kept, and whether
 * each is a file of its own that nobody has read. Leaves nothing behind. After the input has been read.
 * TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status mesh_files_check(const struct run *run, const struct file_names *read);

/* The mesh as Triangle's files show it, or as those of solvers do, which hold no point that no triangle uses. */
struct tri_grid_options mesh_files_grid(const struct run *run, bool for_solvers);

/* Writes the mesh, which has no free numbers, into run->outputs, whoever fails: its caller commits or aborts. Input
 * points are written bit by bit as they were read. Says a line for each file, and one for all parts of a mesh. */
enum tri_status mesh_files_write(const struct run *run);

/* --- The mesh in a format of another program: one file, or one for each of its parts. */

struct export {
    const struct tri_format *format;
    int n_parts; /* 0: it is one file */
    struct tri_output *output[TRI_MOST_PARTS];
};

/* Of so many parts where the format has parts, else as a whole. */
struct export export_of(const char *name, int n_parts);

/* Opens a file in the guarded set (drivers/interrupt.h). name: malloc'ed, and freed here; NULL: no memory. */
enum tri_status mesh_files_open(struct tri_output_set *set, char *name, struct tri_output **output,
                                struct tri_error *error);

/* Opens them in the guarded set. */
enum tri_status export_open(struct export *export, const char *name, struct tri_output_set *set,
                            struct tri_error *error);
enum tri_status export_write(const struct export *export, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error);

#endif
