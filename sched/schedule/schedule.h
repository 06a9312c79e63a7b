/* Parallel refinement: the four-phase schedule, for any PSLG.
 *
 * The resulting mesh depends only on the input mesh, the bounds and the cell size. It does not depend on the number of
 * threads, the machine, or the order in which blocks run.
 *
 * Source: A. N. Chernikov and N. P. Chrisochoides, ICS 2004 (full reference: sched/schedule/prerefine.h). How segments,
 * grading and ownership are handled: triangle/refine/refine.h and sched/schedule/partition.h. */
#ifndef SCHED_SCHEDULE_SCHEDULE_H
#define SCHED_SCHEDULE_SCHEDULE_H

#include "ptriangle/tiles.h"
#include "sched/schedule/partition.h"
#include "triangle/base/executor.h"
#include "triangle/api/generate.h"
#include "triangle/refine/refine.h"

struct par_carrier;
struct par_checkpoint;
struct par_park;
struct par_team;

enum { PAR_NUMBERING = PAR_PHASES + 1 }; /* the value of par_place.phase while the mesh is numbered */

/* The progress of a refinement. Passed to the progress callback when a phase begins and when blocks of it end. */
struct par_place {
    int level;                 /* 0: the requested mesh; k > 0: the coarser mesh that prepares level k - 1 */
    bool sizes;                /* true: the first of two schedules, for sizes alone; a second one for all bounds
                                  follows */
    int32_t column, n_columns; /* of a sweep, counted from 1; 0: the mesh is not swept */
    int round, phase;          /* round from 0; phase 0: pre-refinement, 1 to 4: the phases of a round, PAR_NUMBERING:
                                  numbering at the end */
    double done;               /* share of the phase's estimated work that all threads together have finished, 0 to 1 */
    int64_t triangles;         /* in the mesh so far, approximate */
};

struct par_options {
    int threads;             /* number of threads, as par_threads takes it; 0: OMP_NUM_THREADS if set, otherwise one per
                                processor */
    struct par_team *team;   /* the caller's team, whose threads do the work; NULL: the call starts its own */
    double cell_triangles;  /* approximate number of final triangles in a cell; 0: the default. The mesh depends on
                               it */
    bool size_test_in_parallel; /* the size function and the size test may be called by several threads at once. If
                                   false, a size function makes the call use one thread (the mesh is the same), and a
                                   size test makes the refinement sequential */
    const struct tri_refine_hooks *hooks; /* only gate, fence and told are used, and only by sequential calls. With a
                                             gate or a fence there is no schedule. NULL: no hooks */
    bool by_block;           /* true: new vertices and triangles keep the numbers that their blocks gave them, which
                                takes less time. false: the mesh is numbered tile by tile along a curve
                                (sched/tiles/numbering.h); a solver that visits the triangles in order then runs about
                                twice as fast. With by_block a sink gets pieces of the mesh instead of tiles, and the
                                mesh is never swept */
    const struct tri_sink *sink; /* receives the finished mesh tile by tile (ptriangle/tiles.h); NULL: the caller keeps
                                    the mesh */
    const struct tri_pslg *figure; /* the mesh's input, from which the coordinates of its points are handed out
                                      unchanged; NULL: they are handed out as stored in the mesh, where values below
                                      2^-216 units are 0 */
    bool region_column;      /* each triangle is handed out with the attribute of its region, even if the mesh has no
                                attribute columns */
    int64_t memory;          /* bytes of memory that the process may use; 0: no bound. A mesh that goes to a sink and
                                would not fit is swept from left to right, with a few columns in memory at a time. *mesh
                                is then no valid mesh after the call and may only be freed. If it cannot be swept, it is
                                kept in files in `scratch` (sched/tiles/park.h). The tiles are the same for any bound.
                                Without a sink, see `park`. On several ranks each rank has a bound of its own and keeps
                                it by files */
    const char *scratch;     /* directory for these files. NULL: with a sink, a mesh that does not fit can only be
                                swept; if that is impossible, the call returns TRI_TOO_LARGE */
    struct par_park **park;  /* without a sink: receives the files in `scratch` that hold the mesh if it does not fit in
                                `memory`. The mesh stays usable. Free the mesh first, then close *park. Receives NULL if
                                `memory` is 0. If `park` is NULL, a mesh that does not fit is TRI_NO_MEMORY */
    struct par_checkpoint *checkpoint; /* directory for the states of the run, from which it can be resumed
                                          (sched/checkpoint/state.h); NULL: no checkpoints */
    bool count_remaining;    /* if the mesh is handed out: counts the triangles that still violate the bounds, by
                                reason */
    bool sweep;              /* for tests: sweeps the mesh even if it fits in memory */
    struct par_carrier *carrier; /* not NULL: this process is one of several ranks. All ranks make this call with the
                                    same mesh, bounds and cells; each gets its own tiles (sched/ranks/ranks.h), with the
                                    numbers that one process would give them. If there is no schedule, each rank refines
                                    the whole mesh and rank 0 hands out all tiles. The caller must call par_agree
                                    afterwards. NULL: one process */
    unsigned shuffle;        /* for tests: not 0: blocks start in an order drawn from this seed */
    void (*on_step)(void *user, int from, int to); /* for tests: called at each step from one enum par_next to another;
                                                   NULL: not called */
    void *on_step_user;         /* passed to on_step */
    int32_t tight_room;      /* for tests: not 0: blocks get room for this many triangles at a time, and therefore pause
                                often */
    void (*progress)(void *user, const struct par_place *place); /* called on the calling thread only; NULL: not
                                                                    called */
    void *progress_user; /* passed to progress */
};

enum { PAR_SHARINGS = 7 }; /* one entry for each power of two of shares up to TRI_MOST_SHARES */

enum par_way { /* how the mesh was stored during the run */
    PAR_IN_MEMORY,
    PAR_SWEPT,  /* column by column; finished tiles were removed from memory */
    PAR_PARKED  /* the whole mesh, in files mapped into memory */
};

struct par_block_report {
    int32_t schedule;            /* number of the schedule, from 0, in the order in which schedules began. A
                                    pre-refinement that is itself a schedule has a lower number than the schedule that
                                    it prepares */
    int32_t round, phase, block; /* round and phase, from 0; the block, as column * n_rows + row */
    int64_t worklist, inserted, deferred; /* entries of its worklist; points inserted; triangles deferred by the
                                             fence */
    double seconds;              /* wall time of the block */
};

struct par_report {
    struct tri_refine_report total; /* counts of all blocks and calls */
    int threads;                 /* number of threads used */
    int rounds;                  /* rounds of four phases, on all levels */
    int levels;                  /* number of meshes that phases refined: the requested one, its pre-refinement, and so
                                    on; 0: no schedule */
    int32_t schedule;            /* the first schedule of the whole mesh: its number in struct par_block_report */
    int32_t columns, rows;       /* of blocks in the first round. These and the members below, up to prerefined,
                                    describe the first schedule of the whole mesh; there are two if sizes and angles
                                    have one each */
    struct par_partition partition; /* blocks of the first round, in the mesh's units; empty if the call was sequential.
                                       Owned by the report */
    double radius_lemma7, radius_theory; /* upper bounds on the circumradius after pre-refinement: the paper's and the
                                            tight one; 0 if there is no bound on areas or angles */
    double radius_measured;      /* largest circumradius of a bad triangle when the first phase began */
    int64_t prerefined;          /* triangles when the first phase began */
    int64_t deferred, left_over; /* triangles deferred by fences, over all phases; bad triangles that were left for
                                    sequential calls */
    enum par_way way;            /* how the mesh was stored */
    int64_t most_live;           /* largest number of triangles in the mesh at any time, including unused room of
                                    blocks */
    int64_t remain[TRI_EXCUSES]; /* triangles that still violate the bounds, by reason */
    bool remain_known;           /* `remain` has been counted, which needs a mesh that was handed out */
    int64_t parked;              /* largest number of bytes in `scratch` files at any time; 0: the mesh stayed in
                                    memory */
    int64_t pauses;              /* number of times that a block paused for lack of room */
    /* wall time of: the coarse mesh; estimates and cells; room; collecting results and closing gaps; sequential calls;
     * the whole call */
    double seconds_prerefine, seconds_partition, seconds_room, seconds_merge, seconds_last, seconds_total;
    double seconds_find;         /* finding bad triangles and the block of each */
    double seconds_deal;         /* dealing bad triangles to blocks */
    double seconds_number;       /* numbering the mesh (par_number); nearly all of it in equal shares */
    double seconds_shared[PAR_SHARINGS]; /* of all seconds except those of number and refine: entry k is the time spent
                                            in 2^k to 2^(k + 1) - 1 equal shares */
    double seconds_refine;       /* wall time of the parallel parts of all phases */
    double phase_seconds[4];     /* seconds_refine by phase, over all rounds */
    struct par_block_report *blocks; /* [n_blocks] one entry for each block that ran, in canonical order; owned by the
                                        report */
    int32_t n_blocks, block_capacity; /* number of entries; allocated entries */
};

/* Returns the default options: all members 0 or NULL. */
struct par_options par_defaults(void);

/* Refines as tri_refine does, with several threads.
 *
 * The call is sequential if the mesh is small or if the options rule out a schedule: max_steiner, a gate or fence of
 * the caller's, or a size test that must not run in parallel. A size function that must not run in parallel makes the
 * call use one thread.
 *
 * Size function and size test are also called for temporary triangles that do not appear in the mesh, to estimate the
 * work in each part of the plane. In a child process forked after a call only the calling thread exists, and the next
 * call starts new threads.
 *
 * Existing vertices keep their ids. Unless by_block, the ids of existing triangles and subsegments may change. Safe to
 * call from several threads on different meshes, and inside a parallel region. Errors as tri_refine. */
enum tri_status par_refine(struct tri_mesh *mesh, const struct tri_quality *quality,
                           const struct par_options *options, struct par_report *report, struct tri_error *error);

/* Returns the block (column * n_rows + row) of the first round whose fence owns triangle t, and its phase, 0 to 3, in
 * *phase. If several phases have such a block, the earliest one counts. Returns TRI_NONE, and -1 in *phase, if no fence
 * owns t. Used for pictures. */
int32_t par_block_of(const struct par_report *report, const struct tri_mesh *mesh, tri_triangle_id t, int *phase);

/* Frees the arrays that the report owns. */
void par_report_free(struct par_report *report);

#endif
