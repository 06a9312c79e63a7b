/* The files of a mesh on trial, and its input. */
#ifndef DRIVERS_JUDGED_FILES_H
#define DRIVERS_JUDGED_FILES_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/pslg.h"
#include "triangle/reconstruct.h"

struct judged_files {
    struct tri_pslg mesh; /* points and subsegments */
    struct tri_elements elements;
    int32_t *neighbors;   /* [elements.n][3], or NULL: there is no such file, or ... */
    bool stale_neighbors; /* ... it is of another mesh, of other size */
    struct tri_pslg input;
    bool has_poly;
    int32_t base;
};

/* Reads base.node or base.poly, base.ele and base.neigh. */
enum tri_status judged_read_mesh(struct judged_files *files, const char *base, struct tri_error *error);

/* Reads a .poly or .node file. */
enum tri_status judged_read_input(struct judged_files *files, const char *path, struct tri_error *error);
void judged_files_free(struct judged_files *files);

/* Cuts the suffix off, if it is there. */
bool judged_cut_suffix(char *path, const char *suffix);

#endif
