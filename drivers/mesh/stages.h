/* A run of a mesh generator from the command line, from files to files: what `triangle` and its parallel sister
 * share.
 *
 * The stages and their order are fixed; how the mesh is refined and who runs independent pieces of work is plugged
 * in. */
#ifndef DRIVERS_MESH_STAGES_H
#define DRIVERS_MESH_STAGES_H

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/long_options.h"
#include "drivers/mesh/mesh_files.h"
#include "drivers/mesh/orphans.h"
#include "triangle/base/executor.h"
#include "triangle/api/generate.h"
#include "triangle/mesh/topology.h"
#include "triangle/text/names.h"
#include "triangle/text/read.h"

enum run_stage {
    RUN_READ,     /* files to PSLG or mesh */
    RUN_DELAUNAY,
    RUN_SEGMENTS,
    RUN_HOLES,    /* carving and regions */
    RUN_QUALITY,
    RUN_WRITE,
    RUN_STAGES
};

/* How the mesh is made: see drivers/mesh/plan.h. */
struct run_plan {
    bool swept;    /* files are written meanwhile, and the mesh goes; else it stays a mesh .. */
    bool filed;    /* .. which lies in files as far as it does not fit in memory; else in memory */
    double memory; /* bytes of memory that the process may take; HUGE_VAL: not known */
    double triangles; /* that are expected */
};

/* All about a run, as far as it got. */
struct run {
    const struct run_hooks *hooks;
    const struct arguments *arguments;
    struct tri_options options;
    struct tri_pslg pslg;
    struct tri_elements elements; /* -r: the triangles */
    bool *is_edge;                /* [n_segments] -r: is the segment an edge of the mesh? Else NULL */
    int32_t base;                 /* 0 or 1 */
    bool points_in_poly;
    struct run_plan plan; /* once refinement begins */
    struct tri_mesh mesh;
    struct tri_report report;
    struct tri_counts counts;
    int64_t remain[TRI_EXCUSES]; /* triangles that stay below the bounds, */
    bool remain_known;           /* where they have been counted */
    double seconds[RUN_STAGES];
    double total_seconds;
    const char *stopped; /* what stopped the run, of which this is the mesh so far: "SIGTERM"; NULL: nothing */
    struct console console;
    struct tri_output_set *outputs; /* the guarded set (drivers/interrupt.h) of its files */
    struct tri_error *error;

    /* Of the stages alone: */
    struct tri_names names; /* of what is read */
    int64_t input_warnings;
    double begin, mark; /* when the run and the stage began */
    int32_t *twin;      /* [pslg.n_points] first one of the points at a place, where the mesh will be gone; else NULL */
    struct orphans unused; /* vertices in no triangle, by the caller's numbers; n is -1: not counted */
    bool built;         /* there is a mesh: what stops now leaves one that is valid */
};

struct run_hooks {
    const char *program;
    const struct tri_executor *executor; /* for reading and writing; NULL: one task after another */
    /* Refines the mesh as run->plan says; NULL: tri_refine does. Where run->plan.swept, also writes its files into
     * run->outputs, and counts it: run->counts. The mesh is gone then. */
    enum tri_status (*refine)(void *user, struct run *run, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_refine_report *report);
    /* Beside a mesh that is not swept, so many bytes of memory will be needed: what of it does not fit then, moves to
     * files. NULL: nothing moves. */
    enum tri_status (*make_room)(void *user, struct run *run, double bytes);
    /* How many triangles the mesh will have, to the order; NULL: what areas ask for is all that is known. */
    double (*estimate)(void *user, const struct tri_mesh *mesh, const struct tri_quality *quality);
    bool always_sweep;              /* on ranks, and for tests: also what would fit in memory */
    bool written_elsewhere;         /* another rank reads and writes all files */
    int n_ranks;                    /* that share the mesh; 0: it is all here */
    /* Several ranks, which call these together. share: after the first has read the input; all have it then. agree:
     * before anything gets its name, and by whoever fails, at whatever call the others are. Both return the same status
     * on all, with the same error. NULL: there is one. */
    enum tri_status (*share)(void *user, struct run *run, enum tri_status status);
    enum tri_status (*agree)(void *user, enum tri_status status, struct tri_error *error);
    int threads;                    /* to refine with, for estimates */
    /* Triangles in a cell of the schedule, where the mesh ends with about so many; NULL: there are no cells. */
    double (*cell_triangles)(double triangles);
    const struct long_options *options; /* what the command line says beyond the switches of Triangle; maybe all 0 */
    /* Writes what the options want beside the mesh into run->outputs; NULL: nothing. */
    enum tri_status (*write)(void *user, struct run *run);
    void *user;
};

/* Carries out what the arguments say, after arguments_end. Returns the exit code: 0; 1 after an error, which has been
 * reported; then no file has been touched; after a stop that of interrupt_code: then no file has been touched either,
 * unless partial meshes are wanted and it says where one is. All files appear together, as the last thing that can
 * fail. */
int run_arguments(const struct arguments *arguments, const struct run_hooks *hooks);

#endif
