/* The mesh in a format of another program: one file, or one for each of its parts. */
#ifndef DRIVERS_MESH_EXPORT_H
#define DRIVERS_MESH_EXPORT_H

#include "triangle/text/formats.h"

struct export {
    const struct tri_format *format;
    int n_parts; /* 0: it is one file */
    struct tri_output *output[TRI_MOST_PARTS];
};

/* Of so many parts where the format has parts, else as a whole. */
struct export export_of(const char *name, int n_parts);

/* How many files there are, and the name of one, malloc'ed: of "mesh.msh" that itself, or "mesh_1.msh" and so on, as
 * Gmsh does. NULL: no memory. */
int export_files(const struct export *export);
char *export_name(const struct export *export, const char *name, int file);

/* Opens them in the guarded set (drivers/interrupt.h). */
enum tri_status export_open(struct export *export, const char *name, struct tri_output_set *set,
                            struct tri_error *error);
enum tri_status export_write(const struct export *export, const struct tri_grid *grid,
                             const struct tri_executor *executor, struct tri_error *error);

#endif
