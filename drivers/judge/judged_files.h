/* The files of a mesh to check, and its input.
 *
 * Triangle's text files become rows of numbers, in memory if they fit, otherwise in scratch files. An HDF5 file is read
 * in slices. Files of other formats (triangle/text/formats.h) are read into memory, or rejected if they do not fit. */
#ifndef DRIVERS_JUDGE_JUDGED_FILES_H
#define DRIVERS_JUDGE_JUDGED_FILES_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/judge/judged_text.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/check/check.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/formats.h"

/* bytes; smaller meshes are never rejected */
#define JUDGED_WORTH_A_LOOK 1e7

struct tri_h5;

struct judged_files {
    struct tri_check_source source; /* contents of the files; memory and scratch are those requested */
    struct tri_pslg input;
    bool stale_neighbors; /* the .neigh file belongs to a mesh of another size, and is ignored */
    int32_t base;         /* first number in the files, 0 or 1 */
    int64_t n_nodes;      /* number of points, with midpoints of edges */

    /* The mesh, in one of three forms. */
    struct tri_pslg mesh; /* points and subsegments */
    struct tri_elements elements;
    struct tri_check_mesh arrays;
    bool boundary_alone; /* the format does not store segments inside the mesh */
    bool for_solvers;    /* the format leaves out input points that no triangle uses */
    struct judged_text text;
    struct tri_h5 *h5; /* NULL: the mesh is not in HDF5 */
};

struct judged_request {
    const char *base;    /* base of the mesh's file names, or name of one file */
    bool is_base;        /* a base name, regardless of its ending */
    bool may_lack_triangles; /* points and segments without triangles are allowed */
    const char *input;   /* file name of the input; NULL: none */
    double memory;       /* bytes that may be used */
    const char *scratch; /* folder for scratch files */
    const struct tri_executor *executor; /* for reading text in parallel; NULL: none */
};

/* Reads base.node or base.poly, base.ele and base.neigh, or the single file base; and the input, a .poly or .node
 * file. */
enum tri_status judged_read(struct judged_files *files, const struct judged_request *ask, struct tri_error *error);
void judged_files_free(struct judged_files *files);

/* Removes the suffix if it is one of the text files of a mesh. */
bool judged_cut_text_suffix(char *path);

#endif
