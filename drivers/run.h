/* A run of a mesh generator from the command line, from files to files: what `triangle` and its parallel sister
 * share.
 *
 * The stages and their order are fixed; how the mesh is refined and who runs independent pieces of work is plugged
 * in. */
#ifndef DRIVERS_RUN_H
#define DRIVERS_RUN_H

#include "drivers/arguments.h"
#include "triangle/executor.h"
#include "triangle/read.h"
#include "triangle/stats.h"
#include "triangle/tri.h"

enum run_stage {
    RUN_READ,     /* files to PSLG or mesh */
    RUN_DELAUNAY,
    RUN_SEGMENTS,
    RUN_HOLES,    /* carving and regions */
    RUN_QUALITY,
    RUN_WRITE,
    RUN_STAGES
};

/* All about a run, as far as it got. */
struct run {
    const struct run_hooks *hooks;
    const struct arguments *arguments;
    struct tri_options options;
    struct tri_pslg pslg;
    struct tri_elements elements; /* -r: the triangles */
    bool *is_edge;                /* [n_segments] -r: is the segment an edge of the mesh? Else NULL */
    int32_t n_loose;              /* segments that are not */
    int32_t base;                 /* 0 or 1 */
    bool points_in_poly;
    struct tri_mesh mesh;
    struct tri_report report;
    struct tri_counts counts;
    double seconds[RUN_STAGES];
    double total_seconds;
};

struct run_hooks {
    const char *program;
    const struct tri_executor *executor; /* for reading and writing; NULL: one task after another */
    /* Refines the mesh as tri_refine does; NULL: tri_refine itself. */
    enum tri_status (*refine)(void *user, struct tri_mesh *mesh, const struct tri_refine_options *options,
                              struct tri_refine_report *report, struct tri_error *error);
    /* Told when all files are written; NULL: nobody. A failure is an error of the run. */
    enum tri_status (*done)(void *user, const struct run *run, struct tri_error *error);
    void *user;
};

/* Carries out what the arguments say, after arguments_end. Returns the exit code: 0, or 1 after an error, which has
 * been reported; then no file has been touched. */
int run_arguments(const struct arguments *arguments, const struct run_hooks *hooks);

/* All of the above for a program without arguments of its own. */
int run_words(int argc, char **argv, const struct run_hooks *hooks);

#endif
