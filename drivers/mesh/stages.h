/* A run of a mesh generator on the command line, from files to files. `triangle` and `ptriangle` share these stages.
 * Each program calls them in the order below, with its own steps between: begin, read, make, then, after write_begin,
 * write_mesh, tell and commit, unless it is a dry run. end always comes last. A stage that fails returns its status,
 * with run->error. After a failure a program calls only commit and end. */
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

/* Properties of the machine and of the tasks; all 0: one core, no schedule. */
struct run_settings {
    const struct long_options *options;  /* options beyond the switches of Triangle; may be all 0 */
    const struct tri_executor *executor; /* executor for reading and writing; NULL: one task after another */
    int threads;            /* threads of the schedule; 0: tri_refine refines without a schedule */
    /* What the schedule needs (drivers/mesh/needs.h); NULL: there is none. */
    void (*schedule_needs)(const struct run *run, bool sweeps, double grown, double demand, struct needs *needs);
    int n_ranks;            /* number of ranks that share the mesh; 0: a single process */
    bool written_elsewhere; /* another rank reads and writes all files */
    bool always_sweep;      /* sweep even if the mesh would fit in memory; on ranks, and for tests */
};

struct run_input {
    struct tri_names names; /* names of the files; empty before run_begin */
    struct tri_pslg pslg;
    struct tri_elements elements; /* with -r: the triangles; otherwise empty */
    int32_t base;           /* 0 or 1: the first number in the files */
    bool points_in_poly;    /* there is no .node file */
    int64_t warnings;       /* number of warnings about lines of the files */
};

/* How the mesh is made, see drivers/mesh/plan.h. */
struct run_plan {
    bool swept;    /* write files during refinement and free the mesh; if false, keep the mesh */
    bool filed;    /* keep the part of the mesh that does not fit in memory in files */
    double memory; /* bytes of memory that the process may use; HUGE_VAL: not known */
    double triangles; /* expected number of triangles */
};

/* Times in seconds. */
struct run_time {
    double begin, mark; /* by tri_seconds: start of the run, and of the stage */
    double stage[RUN_STAGES]; /* duration of each stage; 0: not yet */
    double total;       /* from the start to the statistics; 0: not yet */
};

/* A run, as far as it has come. */
struct run {
    struct run_settings settings;
    const struct arguments *arguments;
    struct tri_options options;     /* set by the switches; refine_call and refine_user belong to the program, which
                                       refines between run_refine_begin and run_refine_end */
    struct run_input input;
    struct size_fields sizes;       /* options.quality.lengths refers to it after run_refine_begin */
    struct run_plan plan;           /* all 0 before refinement */
    struct tri_mesh mesh;
    bool built;                     /* the mesh is valid from now on, also after a stop */
    bool *is_edge;                  /* [n_segments] with -r: whether the segment is an edge of the mesh; otherwise
                                       NULL */
    int32_t *twin;                  /* [pslg.n_points] the first point at the same place, if the mesh will be gone;
                                       otherwise NULL */
    struct orphans unused;          /* vertices in no triangle, by the caller's numbers; n is -1: not counted */
    struct tri_report report;
    struct tri_counts counts;       /* counts of the finished mesh; set by a sweep, otherwise by run_print_statistics */
    int64_t remain[TRI_EXCUSES];    /* triangles that violate the bounds, by reason */
    bool remain_known;              /* `remain` has been counted */
    struct run_time time;
    const char *stopped;            /* cause of the stop, such as "SIGTERM", if the mesh is incomplete; NULL: not
                                       stopped */
    struct console console;
    struct tri_output_set *outputs; /* the guarded set of its files (drivers/interrupt.h) */
    struct tri_error *error;
};

/* Returns a run with arguments after arguments_end, which name an input. The caller must still set the settings and the
 * refine call. All pointers are borrowed. */
struct run run_new(const char *program, const struct arguments *arguments, struct tri_error *error);

/* Starts the clock and the signal handlers, and checks the switches. */
enum tri_status run_begin(struct run *run);

/* Reads the input, unless written_elsewhere. Without ranks it also checks that the input can be triangulated in
 * memory. */
enum tri_status run_read(struct run *run);

/* Makes the mesh, refined by options.refine_call. A dry run does not refine; it prints what the run would need and
 * whether it would be refused. */
enum tri_status run_make(struct run *run);

/* Finds the unused vertices of a mesh that has no free numbers: run->unused. run_refine_begin does so while the mesh is
 * small. TRI_NO_MEMORY. */
enum tri_status run_find_unused(struct run *run);

/* A refine_call calls begin, refines as run->plan says, which begin has set, and calls end. If run->plan.swept, the
 * refine_call also writes the files into run->outputs and sets run->counts, and the mesh is gone. If begin fails, the
 * refine_call returns that status; otherwise it returns the result of end. */
enum tri_status run_refine_begin(struct run *run);
enum tri_status run_refine_end(struct run *run, enum tri_status status);

/* Begins the output. After a sweep everything has been written, and write_mesh does nothing. */
void run_write_begin(struct run *run);

/* Returns the bytes of memory that write_mesh needs beside the mesh. */
double run_write_bytes(const struct run *run);
enum tri_status run_write_mesh(struct run *run);

/* Prints the statistics. */
enum tri_status run_print_statistics(struct run *run);

/* Commits the output, after run_write_begin. All files appear together, as the last action that can fail; after a
 * failure (status) none. */
enum tri_status run_commit(struct run *run, enum tri_status status);

/* Reports a failure or a stop, and frees everything. Returns the exit code: 0 for success; 1 after an error, without a
 * changed file; after a stop that of interrupt_code. After a stop no file has changed either, unless a partial mesh was
 * requested, whose place is printed. */
int run_end(struct run *run, enum tri_status status);

#endif
