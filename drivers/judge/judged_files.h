/* The files of a mesh on trial, and its input.
 *
 * Triangle's text files become rows of numbers, in memory where they fit, else in scratch files; an HDF5 file is read
 * in slices; files of other formats (triangle/text/formats.h) are read into memory, or refused. */
#ifndef DRIVERS_JUDGE_JUDGED_FILES_H
#define DRIVERS_JUDGE_JUDGED_FILES_H

#include <stdbool.h>
#include <stdint.h>

#include "drivers/judge/judged_text.h"
#include "triangle/cdt/reconstruct.h"
#include "triangle/check/check.h"
#include "triangle/mesh/pslg.h"
#include "triangle/text/formats.h"

/* Bytes: less is not worth a refusal. */
#define JUDGED_WORTH_A_LOOK 1e7

struct tri_h5;

struct judged_files {
    struct tri_check_source source; /* what they hold; its memory and scratch are those asked for */
    struct tri_pslg input;
    bool stale_neighbors; /* the .neigh file is of another mesh, of other size: not given */
    int32_t base;         /* of their numbers */
    int64_t n_nodes;      /* points, nodes amid edges included */

    /* of the mesh: one of three */
    struct tri_pslg mesh; /* points and subsegments */
    struct tri_elements elements;
    struct tri_check_mesh arrays;
    bool boundary_alone; /* it may have segments inside that its format does not keep */
    bool for_solvers;    /* its format leaves out points of the input that no triangle uses */
    struct judged_text text;
    struct tri_h5 *h5; /* NULL: the mesh is not in HDF5 */
};

struct judged_ask {
    const char *base;    /* of the mesh's names; or the name of one file */
    bool is_base;        /* it is no name of a file, whatever it ends in */
    bool may_lack_triangles; /* points and segments alone will do */
    const char *input;   /* NULL: none */
    double memory;       /* bytes that may be used */
    const char *scratch; /* folder */
    const struct tri_executor *executor; /* reads text in stretches; NULL: nobody */
};

/* Reads base.node or base.poly, base.ele and base.neigh, or base itself; and the input, a .poly or .node file. */
enum tri_status judged_read(struct judged_files *files, const struct judged_ask *ask, struct tri_error *error);
void judged_files_free(struct judged_files *files);

/* Cuts the suffix off, if it is one of those of text files of a mesh. */
bool judged_cut_text_suffix(char *path);

#endif
