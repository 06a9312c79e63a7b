/* One phase: its blocks are refined concurrently, each on its own view of the mesh. The data that one phase of a run
 * passes to the next is declared here, too:
 *
 *   par_share   how several ranks divide the blocks of a phase among them
 *   par_run     the run: the caller's request, the current position (next.h), and the work left to do
 *   par_phase   runs a phase, of all blocks or of one column
 *   par_steps   the two steps of a round that depend on how the mesh is stored
 *
 * THEOREM (triangle/refine/refine.h, serialisation; docs/theory.md, cells and phases). The fences of a phase are
 * disjoint, so its result is the same as if its blocks had run one after the other, in any order. Each block refines
 * its triangles in an order that depends only on its own worklist, so the mesh does not depend on the number of
 * threads. */
#ifndef SCHED_SCHEDULE_PHASE_H
#define SCHED_SCHEDULE_PHASE_H

#include <stdatomic.h>

#include "sched/schedule/next.h"
#include "sched/schedule/partition.h"
#include "sched/schedule/room.h"
#include "sched/schedule/schedule.h"
#include "sched/schedule/worklist.h"

struct par_park;
struct par_ranks;
struct par_run;

/* Returns the number of triangles of the run so far, including those that have been handed out. */
int64_t par_triangles(const struct par_run *run);

/* Calls the progress callback for the phase that begins. phase: as in struct par_place. Called on the calling
 * thread. */
void par_report_phase(const struct par_run *run, int phase);

/* Sets the counts of deferred triangles (gated, fenced) in the report's total to 0. Called after a schedule, when each
 * deferred triangle has been refined. */
void par_forget_deferred(struct par_report *report);

/* par_add_points adds only the points that a call inserted. par_add_up also adds the triangles that it deferred or gave
 * up. */
void par_add_points(struct tri_refine_report *sum, const struct tri_refine_report *add);
void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add);

/* How several ranks share the blocks of a phase (sched/ranks/ranks.h). */
struct par_share {
    const bool *is_mine;    /* [blocks] this rank refines the block */
    const bool *is_border;  /* [blocks] other ranks hold a part of the block; across the border a link is TRI_BEYOND */
    struct par_ids changed; /* triangles made by border blocks; may contain duplicates */
    /* Fetches from other ranks the triangles around these vertices, for which blocks wait. Called on the calling thread
     * while no block runs. */
    enum tri_status (*more)(void *user, const struct par_ids *asked, struct tri_error *error);
    void *user; /* passed to more */
};

/* The caller's request. Constant during the run. */
struct par_asked {
    const struct tri_quality *quality; /* the caller's bounds */
    const struct par_options *options; /* the caller's options */
    struct tri_executor executor; /* runs tasks on the number of threads that the options request */
    int32_t n_kept;               /* number of vertices before refinement; they keep their ids */
};

/* Counts of bad triangles, made when their tiles are handed out (sched/tiles/sweep.h). */
struct par_remain {
    bool is_on;            /* false: bad triangles are not counted, and the other members stay empty */
    struct par_ids listed; /* triangles given up so far and not counted yet */
    int64_t counted[TRI_EXCUSES + 1]; /* by reason, in the layout of tri_count_bad_among */
};

/* A run: the request, the current position, and the work. Only the calling thread changes it; tasks read it while a
 * phase runs, and update only `reached`. */
struct par_run {
    const struct par_asked asked; /* the caller's request */
    struct par_position place;    /* the current position */
    struct tri_mesh *mesh;        /* the caller's mesh */
    struct par_report *report;    /* the caller's report */
    struct tri_quality bounds;    /* bounds of the current schedule */
    struct par_ids worklist;      /* triangles that may be bad, in canonical order; some entries may name triangles that
                                     no longer exist */
    struct par_keys key;          /* [worklist.n] ascending; n == 0: no block has deferred a triangle yet, so the
                                     positions in the worklist are the keys */
    struct par_room spare;        /* unused ranges of the mesh's arrays */
    struct par_partition cells;   /* of the last schedule of the whole mesh; the mesh is numbered by their tiles. x
                                     NULL: no schedule yet */
    struct par_remain remain;     /* counts of bad triangles of a mesh that is handed out during the run */
    int64_t gone;                 /* number of triangles that have been handed out and removed from the mesh */
    int32_t n_schedules;          /* number of schedules begun so far, including the current one */
    double radius;                /* largest circumradius in the worklist when it was last filled, in the mesh's
                                     internal unit */
    double share_done;            /* approximate share of the current phase done by blocks that ended before a halt, 0
                                     to 1 */
    _Atomic(int64_t) reached;     /* number of triangles while a phase runs, updated as blocks end */
    struct par_park *park;        /* files that bound the memory of the mesh; NULL: there is no bound */
    struct par_ranks *ranks;      /* not NULL: each rank holds its part of the mesh (sched/ranks/ranks.h); NULL: this
                                     process holds all of it */
};

/* Moves the run to its next step (next.h), and reports the step to the test hook. */
static inline void par_go(struct par_run *run, enum par_next to)
{
    const struct par_options *options = run->asked.options;
    if (options->on_step)
        options->on_step(options->on_step_user, run->place.next, to);
    run->place.next = to;
}

/* Returns the caller's hooks for a sequential call; empty if there are none. */
static inline struct tri_refine_hooks par_hooks(const struct par_run *run)
{
    return run->asked.options->hooks ? *run->asked.options->hooks : (struct tri_refine_hooks){0};
}

/* Which blocks of a phase run, and when they must not start. */
struct par_turn {
    const struct par_partition *partition; /* the blocks */
    int32_t only;                /* run only blocks of this column; TRI_NONE: of all columns */
    struct par_share *share;     /* NULL: this process runs all blocks and holds every triangle that they read */
    const struct tri_stop *halt; /* checked before each block begins: if it returns true, the block does not run; NULL:
                                    the phase is never halted */
};

/* Refines the blocks of phase place.phase. The worklist entries of these blocks leave the worklist, and the triangles
 * that the blocks defer are merged into it. Called on the calling thread; the blocks run as tasks of the executor.
 *
 * THEOREM (order of columns). A call with only = TRI_NONE has the same result as one call for each column of this
 * phase, in any order. Over a round, the two phases of odd columns may run column by column, and those of an even
 * column as soon as both its neighbours have ended. The mesh and the triangles left are the same, except for their ids.
 * Proof: a block changes only triangles inside its fence, and the fences of two columns can intersect only if the
 * columns are neighbours. A block finds its part of the worklist in the same order in either case, the order of the
 * keys: by round, then by column, phase and row of the block that left the triangle, then by the order in which it left
 * them. Only blocks of the same or a neighbouring column leave triangles for it.
 *
 * Returns TRI_STOPPED in two cases. If mesh->stop asks for it, blocks end between any two points, and the phase stays
 * unfinished. If turn->halt asks for it, blocks that had begun have ended and are listed in place.done; the next call
 * runs the other blocks.
 *
 * THEOREM (a phase that is halted). It makes the same mesh and leaves the same triangles, except for their ids. Proof:
 * it amounts to two phases, one of some blocks and one of the others. A triangle left by one block belongs to no other
 * block of the same phase, because two of its corners lie in the first block's fence. */
enum tri_status par_phase(struct par_run *run, const struct par_turn *turn, struct tri_error *error);

/* The two steps of a round that depend on how the mesh is stored. There are three implementations: in memory
 * (schedule.c); for a swept mesh, in which each round is one column (sched/tiles/sweep.c); and on ranks
 * (sched/ranks/ranks.c). */
struct par_steps {
    /* Runs phase place.phase, writes the checkpoint states that are due, and advances place.phase. */
    enum tri_status (*run_phase)(void *self, struct tri_error *error);
    /* Called after the last phase. *again: another round follows, and run->place is its beginning. */
    enum tri_status (*end_round)(void *self, bool *again, struct tri_error *error);
};

/* Runs rounds of phases from run->place on, until end_round reports that no other round follows. */
enum tri_status par_run_rounds(struct par_run *run, const struct par_steps *steps, void *self, struct tri_error *error);

/* The current schedule. The steps in memory and on ranks get it as `self`. */
struct par_schedule {
    struct par_run *run; /* the run */
    struct par_partition partition; /* of the current round */
    bool is_whole;       /* true: it refines the requested mesh (level 0); false: a coarser mesh that prepares it */
    int64_t left;        /* entries of the worklist after the last round, summed over all ranks */
};

/* Moves run->place to the next round, whose blocks are four times as large. Returns false if no work is left or if the
 * blocks cannot grow further. */
bool par_next_round(struct par_schedule *schedule);

/* Refines by one sequential call of the same loop, and adds its report to the run's. more: fetches the triangles for
 * which the call waits (TRI_NO_ROOM); NULL: this process holds all triangles. */
enum tri_status par_refine_rest(struct par_run *run, const struct tri_refine_hooks *hooks,
                                enum tri_status (*more)(void *user, struct tri_error *error), void *user,
                                struct tri_error *error);

/* Merges n triangles into the worklist by their keys, which must ascend. An entry whose key is already in the worklist
 * is dropped. Returns false if memory runs out; the worklist is then unchanged. */
bool par_merge_worklist(struct par_run *run, const int32_t *item, const uint64_t *key, int32_t n);

#endif
