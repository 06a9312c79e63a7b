/* Parallel refinement: the four-phase schedule, for any PSLG.
 *
 * The mesh that comes out depends on the mesh and the bounds that go in, never on the number of threads, the machine or
 * the order in which blocks happen to be done.
 *
 * Source: A. N. Chernikov and N. P. Chrisochoides, ICS 2004 (see sched/schedule/prerefine.h); segments, grading and
 * ownership: see triangle/refine/refine.h and sched/schedule/partition.h. */
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

enum { PAR_NUMBERING = PAR_PHASES + 1 }; /* told as a phase */

/* How far a refinement is, told when a phase begins, and after blocks of it. */
struct par_place {
    int level;                 /* 0: the mesh that is asked for; else what prepares it, and so on */
    bool sizes;                /* the schedule for sizes, which one for angles follows */
    int32_t column, n_columns; /* of a sweep, the first from 1; 0: it is none */
    int round, phase;          /* the second 0: pre-refinement, then 1 to 4, at last PAR_NUMBERING */
    double done;               /* the share of the phase's work that is done, whatever thread did it */
    int64_t triangles;         /* so far, to the order */
};

struct par_options {
    int threads;             /* as par_threads takes them: 0: OMP_NUM_THREADS, else all cores */
    struct par_team *team;   /* the caller's, whose threads work instead; NULL: a team of its own */
    double cell_triangles;  /* final triangles in a cell, to the order; 0: the default. Part of the decomposition */
    bool size_test_in_parallel; /* size function and size test may be called by several threads at once. Else with
                                   a size function one thread does all, and makes the same mesh; with a size test the
                                   mesh is refined sequentially */
    const struct tri_refine_hooks *hooks; /* gate, fence and told alone, of sequential calls: with a gate or a fence
                                             there is no schedule; NULL: none */
    bool by_block;           /* new vertices and triangles are numbered as blocks made them: quicker. Else what the
                                schedule made is numbered tile by tile, along a curve (sched/tiles/numbering.h): a
                                solver that goes through the triangles runs twice as fast then. By block, a sink gets
                                no tiles but pieces of the mesh, and it is never swept */
    const struct tri_sink *sink; /* takes the finished mesh, tile by tile (ptriangle/tiles.h); NULL: nobody */
    const struct tri_pslg *figure; /* the mesh's input: its points are handed out bit by bit as they came; NULL: as they
                                      are in the mesh, where what is smaller than 2^-216 units is 0 */
    bool region_column;      /* the attribute of its region is handed out with a triangle, also where the mesh has no
                                columns */
    int64_t memory;          /* bytes that the process may have in memory; 0: no bound. Where a sink takes the mesh and
                                it would not fit, it is swept from left to right: few columns are there at a time, and
                                *mesh is not a mesh afterwards, to be freed and no more. What does not fit then, lies in
                                files in `scratch` (sched/tiles/park.h). The tiles are the same for any bound. Without a
                                sink, see `park`. On ranks each has a bound of its own, and keeps it by files */
    const char *scratch;     /* directory for these files; NULL: with a sink, the bound decides on the sweep alone, and
                                a mesh that cannot be swept is TRI_TOO_LARGE */
    struct par_park **park;  /* without a sink: receives the files in `scratch` that the mesh, which stays a mesh, lies
                                in from where it does not fit in `memory`; to be closed once nobody needs it, after
                                the mesh is freed, which holds on to it. NULL is received where there is no bound.
                                NULL: a mesh that does not fit is TRI_NO_MEMORY */
    struct par_checkpoint *checkpoint; /* where the state of the run is kept, and taken from (sched/checkpoint/state.h);
                                          NULL: nowhere */
    bool count_remaining;    /* of a mesh that is handed out those triangles that stay below the bounds, by reason */
    bool sweep;              /* for tests: whatever memory there is */
    struct par_carrier *carrier; /* not NULL: this is one of several ranks, which all make this call with the same mesh,
                                bounds and cells, and each gets tiles of its own (sched/ranks/ranks.h), in the numbers
                                of one process. What is no schedule, or has one call behind it, each rank does as a
                                whole, and rank 0 gets all tiles. Whoever makes the call ends with par_agree */
    unsigned shuffle;        /* for tests: not 0: blocks are started in an order drawn from this number */
    void (*went)(void *user, int from, int to); /* for tests: told of each step from one enum par_next to another; NULL:
                                nobody */
    void *went_user;
    int32_t tight_room;      /* for tests: not 0: blocks get room for so many triangles at a time, and pause often */
    void (*progress)(void *user, const struct par_place *place); /* told by the calling thread */
    void *progress_user;
};

enum { PAR_SHARINGS = 7 }; /* no stage has more than TRI_MOST_SHARES shares */

enum par_way { /* how a mesh was carried through */
    PAR_IN_MEMORY,
    PAR_SWEPT,  /* column by column; what is finished went */
    PAR_PARKED  /* it stayed, in files */
};

struct par_block_report {
    int32_t schedule; /* which of the meshes that the phases refined, in the order in which that was begun: from 0;
                         pre-refinement that is itself a schedule comes before what it is for */
    int32_t round, phase, block;
    int64_t worklist, inserted, deferred;
    double seconds;
};

struct par_report {
    struct tri_refine_report total;
    int threads;
    int rounds;                   /* of four phases, of all levels */
    int levels;                   /* meshes that the phases refined: this one, its pre-refinement, ..; 0: none */
    int32_t schedule;             /* the first of the whole mesh: its number in struct par_block_report */
    int32_t columns, rows;        /* of blocks in the first round; this and what follows of the first phase is told of
                                     the first schedule of the whole mesh, where sizes and angles have one each */
    struct par_partition partition; /* blocks of the first round, in the mesh's units; none where the call was
                                       sequential. Owned by the report */
    double radius_lemma7, radius_theory; /* the paper's bound and the tight one for what pre-refinement asks for; 0
                                            where it lacks a bound */
    double radius_measured;       /* largest circumradius of a bad triangle when the first phase began */
    int64_t prerefined;           /* triangles when the first phase began */
    int64_t deferred, left_over;  /* refused by fences in all phases; bad triangles that sequential calls got at last */
    enum par_way way;
    int64_t most_live;            /* triangles in the mesh at a time, with the room that blocks have been dealt */
    int64_t remain[TRI_EXCUSES];  /* triangles that stay below the bounds, by reason */
    bool remain_known;            /* where they have been counted: of a mesh that was handed out */
    int64_t parked;               /* most bytes of files in `scratch` at a time; 0: all was in memory */
    int64_t pauses;               /* times a block waited for room */
    double seconds_prerefine, seconds_partition, seconds_room, seconds_merge, seconds_last, seconds_total;
    double seconds_find;          /* bad triangles, and the block of each */
    double seconds_deal;         /* dealing them to blocks */
    double seconds_number;        /* par_number, after all others; nearly all in equal shares */
    double seconds_shared[PAR_SHARINGS]; /* of all these but number and refine: what ran in 2^k or more equal shares,
                                            but less than 2^(k + 1) */
    double seconds_refine;        /* wall time of the phases' parallel parts */
    double phase_seconds[4];      /* refine, by phase, over all rounds */
    struct par_block_report *blocks; /* [n_blocks] in canonical order; owned by the report */
    int32_t n_blocks, block_capacity;
};

struct par_options par_defaults(void);

/* Refines as tri_refine does, with several threads. Where the options do not allow a schedule (max_steiner; a
 * gate or a fence of the caller's; a size function or size test that must not run in parallel) or the mesh is small it
 * is one sequential call. These functions are also asked about smaller triangles that will never be, to find out how
 * much work there is where. In a child that was forked after a call there is one thread. Vertices that are
 * there keep their ids; unless by_block, those of triangles and subsegments may change. Safe to call from several
 * threads on different meshes, and inside a parallel region. Errors as tri_refine. */
enum tri_status par_refine(struct tri_mesh *mesh, const struct tri_quality *quality,
                           const struct par_options *options, struct par_report *report, struct tri_error *error);

/* The block (column * n_rows + row) whose fence owns triangle t in the first phase that owns it, 0 to 3, which *phase
 * receives; TRI_NONE and -1 where no fence of the first round does. For pictures. */
int32_t par_block_of(const struct par_report *report, const struct tri_mesh *mesh, tri_triangle_id t, int *phase);

void par_report_free(struct par_report *report);

#endif
