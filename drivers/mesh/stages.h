/* A run of a mesh generator from the command line, from files to files: the stages that `triangle` and its parallel
 * sister share. Each program calls them in the order below, with its own steps between: begin, read and make,
 * then, after write_begin, write_mesh, tell and commit, unless the run is dry. Whatever happens, end comes last.
 * A stage that fails returns its status, with run->error; a program calls no stage after that but commit and end. */
#ifndef DRIVERS_MESH_STAGES_H
#define DRIVERS_MESH_STAGES_H

#include "drivers/mesh/arguments.h"
#include "drivers/mesh/console.h"
#include "drivers/mesh/long_options.h"
#include "drivers/mesh/mesh_files.h"
#include "drivers/mesh/orphans.h"
#include "drivers/mesh/size_options.h"
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

struct needs; /* drivers/mesh/needs.h */

/* What the program says of the machine and of its tasks; all 0: one core, no schedule. */
struct run_settings {
    const struct long_options *options;  /* what the command line says beyond the switches of Triangle; maybe all 0 */
    const struct tri_executor *executor; /* for reading and writing; NULL: one task after another */
    int threads;            /* of the schedule that refines; 0: there is no schedule, tri_refine refines */
    /* What the schedule needs (drivers/mesh/needs.h); NULL: there is none. */
    void (*schedule_needs)(const struct run *run, bool sweeps, double grown, double demand, struct needs *needs);
    int n_ranks;            /* that share the mesh; 0: it is all here */
    bool written_elsewhere; /* another rank reads and writes all files */
    bool always_sweep;      /* on ranks, and for tests: also what would fit in memory */
};

struct run_input {
    struct tri_names names; /* of the files; empty before run_begin */
    struct tri_pslg pslg;
    struct tri_elements elements; /* -r: the triangles; else none */
    int32_t base;           /* 0 or 1: the first number in the files */
    bool points_in_poly;    /* there is no .node */
    int64_t warnings;       /* about lines of the files */
};

/* How the mesh is made: see drivers/mesh/plan.h. */
struct run_plan {
    bool swept;    /* files are written meanwhile, and the mesh goes; else it stays a mesh .. */
    bool filed;    /* .. which lies in files as far as it does not fit in memory; else in memory */
    double memory; /* bytes of memory that the process may take; HUGE_VAL: not known */
    double triangles; /* that are expected */
};

/* In seconds. */
struct run_time {
    double begin, mark; /* by tri_seconds: when the run and the stage began */
    double stage[RUN_STAGES]; /* spent in each; 0: not yet */
    double total;       /* from the begin to the statistics; 0: not yet */
};

/* All about a run, as far as it got. */
struct run {
    struct run_settings settings;
    const struct arguments *arguments;
    struct tri_options options;     /* by the switches; refine_call and refine_user are the program's, which refines
                                       between run_refine_begin and run_refine_end */
    struct run_input input;
    struct size_fields sizes;       /* options.quality.lengths are its own, from run_refine_begin on */
    struct run_plan plan;           /* all 0 until refinement begins */
    struct tri_mesh mesh;
    bool built;                     /* there is a mesh: what stops now leaves one that is valid */
    bool *is_edge;                  /* [n_segments] -r: is the segment an edge of the mesh? Else NULL */
    int32_t *twin;                  /* [pslg.n_points] first one of the points at a place, where the mesh will be gone;
                                       else NULL */
    struct orphans unused;          /* vertices in no triangle, by the caller's numbers; n is -1: not counted */
    struct tri_report report;
    struct tri_counts counts;       /* of the finished mesh; whoever sweeps fills them, else run_tell */
    int64_t remain[TRI_EXCUSES];    /* triangles that stay below the bounds, by reason */
    bool remain_known;              /* they have been counted */
    struct run_time time;
    const char *stopped;            /* by what, "SIGTERM", and this is the mesh so far; NULL: by nothing */
    struct console console;
    struct tri_output_set *outputs; /* the guarded set (drivers/interrupt.h) of its files */
    struct tri_error *error;
};

/* Arguments after arguments_end, with the name of an input. The settings, and who refines, are still to be set. All
 * pointers are borrowed. */
struct run run_new(const char *program, const struct arguments *arguments, struct tri_error *error);

/* Starts the clock and the watch for signals, and checks the switches. */
enum tri_status run_begin(struct run *run);

/* Unless written_elsewhere. Where there are no ranks, also: can what has been read be triangulated in memory? */
enum tri_status run_read(struct run *run);

/* Makes the mesh, refined by options.refine_call. A dry run leaves it as it is before, and ends here: it says what the
 * true one would need, and where it would be refused. */
enum tri_status run_make(struct run *run);

/* Finds the vertices of no triangle in a mesh that has no free numbers: run->unused. run_refine_begin does so while the
 * mesh is small. TRI_NO_MEMORY. */
enum tri_status run_find_unused(struct run *run);

/* For a refine_call: before it refines as run->plan says, which begin finds out. Where run->plan.swept, it also writes
 * the files into run->outputs, and counts: run->counts; the mesh is gone then. After a failure of begin it returns that
 * status; else what end makes of its own. */
enum tri_status run_refine_begin(struct run *run);
enum tri_status run_refine_end(struct run *run, enum tri_status status);

/* Begins to write. Of a mesh that was swept all is written, and write_mesh does nothing. */
void run_write_begin(struct run *run);

/* Bytes of memory that write_mesh takes beside the mesh. */
double run_write_bytes(const struct run *run);
enum tri_status run_write_mesh(struct run *run);

/* Says the statistics. */
enum tri_status run_tell(struct run *run);

/* After run_write_begin. All files appear together, as the last thing that can fail; after a failure, status, none. */
enum tri_status run_commit(struct run *run, enum tri_status status);

/* Says how the run failed or was stopped, and frees all. Returns the exit code: 0; 1 after an error: then no file has
 * been touched; after a stop that of interrupt_code: then no file has been touched either, unless partial meshes are
 * wanted and it says where one is. */
int run_end(struct run *run, enum tri_status status);

#endif
