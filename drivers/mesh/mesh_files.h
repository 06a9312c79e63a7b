/* Writes a mesh: selects the files of Triangle, and writes their rows directly from the mesh. */
#ifndef DRIVERS_MESH_MESH_FILES_H
#define DRIVERS_MESH_MESH_FILES_H

#include <stdbool.h>

#include "drivers/mesh/size_options.h"
#include "triangle/mesh/grid.h"
#include "triangle/text/formats.h"

struct run; /* drivers/mesh/stages.h */

enum { MESH_FILES_MOST_NAMES = 5 + SIZE_OPTIONS_MOST };

/* Returns names of files, which are borrowed. */
struct file_names {
    int n;
    const char *name[MESH_FILES_MOST_NAMES];
};

/* Returns true if the file with this suffix, such as ".node", is written. */
bool mesh_files_has(const struct run *run, const char *suffix);

/* Checks before meshing that all files of the run can be created, and that none of them is an input file or the same as
 * another. Creates nothing. To be called after the input has been read. TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
enum tri_status mesh_files_check(const struct run *run, const struct file_names *read);

/* Returns the mesh as shown in Triangle's files, or as in files for solvers, which leave out unused points. */
struct tri_grid_options mesh_files_grid(const struct run *run, bool for_solvers);

/* Writes the mesh, which must have no free numbers, into run->outputs. The caller commits or aborts the outputs. Input
 * points are written exactly as they were read. Prints a line for each file, and one for all parts of a mesh. */
enum tri_status mesh_files_write(const struct run *run);

/* --- The mesh in a format of another program: one file, or one for each part. */

struct export {
    const struct tri_format *format;
    int n_parts; /* number of parts; 0: one file */
    struct tri_output *output[TRI_MOST_PARTS];
};

/* Makes an export with this number of parts if the format has parts, otherwise as a whole. */
struct export export_of(const char *name, int n_parts);

/* Opens a file in the guarded set (drivers/interrupt.h). name: malloc'ed, freed here; NULL: no memory. */
enum tri_status mesh_files_open(struct tri_output_set *set, char *name, struct tri_output **output,
                                struct tri_error *error);

/* Opens the files of an export in the guarded set. */
enum tri_status export_open(struct export *export, const char *name, struct tri_output_set *set,
                            struct tri_error *error);
enum tri_status export_write(const struct export *export, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error);

#endif
