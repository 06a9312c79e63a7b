/* One phase: its blocks, refined at once on views of the mesh. What the phases of a run hand on is here, too:
 *
 *   par_share   how several ranks divide the blocks of a phase
 *   par_run     the run: what is asked, the place that it has reached (next.h), the work
 *   par_phase   runs a phase, of all blocks or of one column
 *   par_steps   rounds of phases, and where they differ
 *
 * THEOREM (triangle/refine/refine.h, serialisation; docs/theory.md, cells and phases). The fences of a phase are
 * disjoint, so its result is that of running its blocks one after the other, in any order. Each block does its work in
 * an order of its own, so the mesh does not depend on the number of threads. */
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

/* The number of triangles, with those that have been handed out. */
int64_t par_triangles(const struct par_run *run);

/* Tells of the phase that begins. */
void par_tell(const struct par_run *run, int phase);

/* Every triangle that gates and fences have kept back has had its turn: the report's total forgets them. */
void par_forget_deferred(struct par_report *report);

/* Adds the points that a call inserted. par_add_up also adds what it left undone. */
void par_add_points(struct tri_refine_report *sum, const struct tri_refine_report *add);
void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add);

/* How ranks share the blocks of a phase (sched/ranks/ranks.h). */
struct par_share {
    const bool *is_mine;   /* [blocks] */
    const bool *is_border; /* [blocks] others hold a part of the block, which is TRI_BEYOND here */
    struct par_ids changed; /* triangles made by such blocks, some of them several times */
    /* Brings the triangles around these vertices, for which blocks wait. */
    enum tri_status (*more)(void *user, const struct par_ids *asked, struct tri_error *error);
    void *user;
};

/* What is asked; nothing changes it while the run lasts. */
struct par_asked {
    const struct tri_quality *quality; /* by the caller */
    const struct par_options *options;
    struct tri_executor executor;      /* on as many threads as the options say */
    int32_t n_kept;                    /* vertices that there were before refinement */
};

/* Bad triangles counted as they leave (sched/tiles/sweep.h). */
struct par_remain {
    bool is_on;             /* false: nobody counts, and the others are empty */
    struct par_ids listed;  /* given up so far, and not counted yet */
    int64_t counted[TRI_EXCUSES + 1]; /* as tri_count_bad_among has it */
};

/* A run: what is asked, its place, and the work. */
struct par_run {
    const struct par_asked asked;
    struct par_position place;
    struct tri_mesh *mesh;      /* the caller's */
    struct par_report *report;  /* the caller's */
    struct tri_quality bounds;  /* that the schedule at work refines to */
    struct par_ids worklist;    /* triangles that may be bad, in canonical order; some may have gone since */
    struct par_keys key;        /* [worklist.n] ascending; n == 0: no block has had any */
    struct par_room spare;      /* unused ranges of the mesh's arrays */
    struct par_partition cells; /* of the last schedule of the whole mesh, whose tiles number it; x NULL: none yet */
    struct par_remain remain;
    int64_t gone;               /* triangles that have been handed out, and are no more */
    int32_t n_schedules;        /* begun so far; the last is the one that works */
    double radius;              /* largest circumradius in the worklist when it was last filled, in the mesh's units */
    double share_done;          /* of the phase at work, by blocks that were done when it was halted, to the order */
    _Atomic(int64_t) reached;   /* triangles, while a phase runs, as far as blocks have ended */
    struct par_park *park;      /* bounds the memory of the mesh; NULL: it is not bounded */
    struct par_ranks *ranks;    /* each rank has its part of the mesh (sched/ranks/ranks.h); NULL: all of it is here */
};

/* Goes on to another step, see next.h. */
static inline void par_go(struct par_run *run, enum par_next to)
{
    const struct par_options *options = run->asked.options;
    if (options->went)
        options->went(options->went_user, run->place.next, to);
    run->place.next = to;
}

/* Those of the caller, for a sequential call. */
static inline struct tri_refine_hooks par_hooks(const struct par_run *run)
{
    return run->asked.options->hooks ? *run->asked.options->hooks : (struct tri_refine_hooks){0};
}

/* Which blocks of a phase have their turn, and what they heed. */
struct par_turn {
    const struct par_partition *partition;
    int32_t only;                /* blocks of this column; TRI_NONE: of all columns */
    struct par_share *share;     /* NULL: all blocks are done here, with all that they may look at */
    const struct tri_stop *halt; /* asked by blocks before they begin; NULL: nobody */
};

/* Refines blocks of the phase at place.phase; takes from the worklist what they can take and puts back what they leave.
 *
 * THEOREM (order of columns). A call with TRI_NONE is one for each column of this phase, in any order; and the phases
 * of odd columns may run column by column, an even one between them once both its neighbours are through. The mesh and
 * what is left are the same, up to ids. For blocks change only what lies in their fences, and fences of two columns
 * meet only if the columns are neighbours or the same; and a block finds its share of the worklist in the same order,
 * that of the keys: by round, by the column of who left it, by phase, by row, and as they were left. Only a column or
 * its neighbours leave something for it.
 *
 * TRI_STOPPED: somebody asks for the end, between any two points, and the phase ends as it is; or for a halt, and then
 * blocks that have begun have ended, and are `done`. The next call is for all others.
 *
 * THEOREM (a phase that is halted). It makes the same mesh, and leaves the same, up to ids. For it is two phases, of
 * some of the blocks and of the others; and what a block leaves no other of its phase takes, since two corners lie in
 * its own fence. */
enum tri_status par_phase(struct par_run *run, const struct par_turn *turn, struct tri_error *error);

/* The two steps of a round that differ: in memory (schedule.c), of a mesh that is swept (sched/tiles/sweep.c), where a
 * round is a column, and on ranks (sched/ranks/ranks.c). */
struct par_steps {
    /* The phase at place.phase, with the states that are kept on the way. Then the place is that of the next phase. */
    enum tri_status (*run_phase)(void *self, struct tri_error *error);
    /* After the last phase. *again: another round follows, and is the place. */
    enum tri_status (*end_round)(void *self, bool *again, struct tri_error *error);
};

/* Rounds of phases, from the place on. */
enum tri_status par_run_rounds(struct par_run *run, const struct par_steps *steps, void *self, struct tri_error *error);

/* A schedule at work, which is what steps in memory and on ranks have as `self`. */
struct par_schedule {
    struct par_run *run;
    struct par_partition partition; /* of the round at work */
    bool is_whole;                  /* the mesh is the one that is asked for, not what comes before its schedule */
    int64_t left;                   /* entries of the worklist after the last round, of all ranks */
};

/* The place is that of the next round, on blocks four times as large; false: nothing is left, or they cannot be. */
bool par_next_round(struct par_schedule *schedule);

/* One sequential call of the same loop. more: brings the triangles for which it waits (TRI_NO_ROOM); NULL: all are
 * here. */
enum tri_status par_refine_rest(struct par_run *run, const struct tri_refine_hooks *hooks,
                                enum tri_status (*more)(void *user, struct tri_error *error), void *user,
                                struct tri_error *error);

/* Adds triangles to the worklist, by their keys, which ascend; whose key is there already is there. False: no memory,
 * and the worklist is as before. */
bool par_merge_worklist(struct par_run *run, const int32_t *item, const uint64_t *key, int32_t n);

#endif
