/* One phase: its blocks, refined at once on views of the mesh. What the phases of a run hand on is here, too:
 *
 *   par_keys    who left each triangle of the worklist, which decides on the order
 *   par_share   how several ranks divide the blocks of a phase
 *   par_run     the run: the mesh, the worklist, the place that the run has reached, what has been counted
 *   par_phase   runs a phase, of all blocks or of one column
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
struct par_run;

/* The number of triangles, with those that have been handed out. */
int64_t par_triangles(const struct par_run *state);

/* Tells of the phase that begins. */
void par_tell(const struct par_run *state, int phase);

/* Every triangle that gates and fences have kept back has had its turn: the report's total forgets them. */
void par_forget_deferred(struct par_report *report);

/* Adds the points that a call inserted. par_add_up also adds what it left undone. */
void par_add_points(struct tri_refine_report *sum, const struct tri_refine_report *add);
void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add);

/* Who left each triangle of a worklist, and when: round + 1 (8 bits), place of the block in the order of all, by
 * column, phase and row, + 1 (24 bits), how many triangles it had left before (32 bits). A triangle that no block has
 * had has the key PAR_NO_ROUND, its tile (block of the first phase) and its place in the tile's list
 * (sched/schedule/by_tile.h); or only its place in the list of all. So keys do not depend on who else was at work. */
struct par_keys {
    uint64_t *item;
    int32_t n, capacity;
};

/* How ranks share the blocks of a phase (sched/ranks/ranks.h). */
struct par_share {
    const bool *is_mine;   /* [blocks] */
    const bool *is_border; /* [blocks] others hold a part of the block, which is TRI_BEYOND here */
    struct par_ids changed; /* triangles made by such blocks, some of them several times */
    /* Brings the triangles around these vertices, for which blocks wait. */
    enum tri_status (*more)(void *user, const struct par_ids *asked, struct tri_error *error);
    void *user;
};

/* How near a mesh is to its end. */
enum par_end {
    PAR_UNFINISHED, /* it is being refined, or is as blocks have left it */
    PAR_NUMBERED,   /* its vertices and triangles have the numbers by which they are handed out */
    PAR_DELIVERED   /* it has been handed out */
};

/* What the phases of a schedule hand on. */
struct par_run {
    struct tri_mesh *mesh;
    const struct tri_quality *quality;
    const struct par_options *options;
    struct tri_executor executor;
    struct par_ids worklist; /* triangles that may be bad, in canonical order; some may have gone since */
    struct par_keys key;     /* [worklist.n] ascending; n == 0: no block has had any */
    struct par_ids remaining; /* where bad triangles are counted as they leave (sched/tiles/sweep.h) */
    bool counts_remaining;   /* such triangles are counted now */
    int64_t remained[TRI_EXCUSES + 1]; /* bad triangles that have left (tri_count_bad_among) */
    struct par_room spare;   /* unused ranges of the arrays */
    double radius;           /* largest circumradius in the worklist when it was last filled */
    struct par_report *report;
    int32_t n_schedules;     /* begun so far; the last is the one that works */
    enum par_next next;
    int level;               /* of the schedule or the call at work */
    int round, phase;        /* of the schedule; the phase from 0 */
    int32_t step;            /* of the phase, on ranks */
    int32_t column, n_columns; /* of a sweep, odd ones alone, from 1; 0: it is none */
    struct par_ids done;     /* blocks of phase `phase` that have ended, where it has been halted */
    double done_share;       /* of that phase, to the order */
    _Atomic(int64_t) reached; /* triangles, while a phase runs, as far as blocks have ended */
    const struct tri_stop *halt; /* asked by the blocks of a phase before they begin; NULL: nobody */
    struct par_share *share; /* NULL: all blocks are done here, with all that they may look at */
    int32_t n_kept;          /* vertices that there were before refinement */
    bool sizes_first;        /* a schedule for sizes comes before the one for all bounds (tri_sizes_come_first) */
    const struct tri_quality *then; /* what is asked for behind this schedule, on its cells, before the mesh is
                                numbered; NULL: nothing, or something else */
    bool may_number;         /* nothing is refined after this schedule, and what it makes is to be numbered */
    struct par_partition cells; /* of the last schedule of the whole mesh, and the tiles by which it is numbered */
    enum par_end end;
    int64_t gone;            /* triangles that have been handed out, and are no more */
    bool stays;              /* the mesh is not swept, or no longer swept, though it does not fit in memory */
    struct par_park *park;   /* bounds the memory of the mesh; NULL: nobody does */
};

/* Those of the caller, for a sequential call. */
static inline struct tri_refine_hooks par_hooks(const struct par_run *state)
{
    return state->options->hooks ? *state->options->hooks : (struct tri_refine_hooks){0};
}

enum { PAR_NO_ROUND = -1 };

/* The key of the first triangle that a block leaves in a phase of a round. */
uint64_t par_key_of(const struct par_partition *partition, int round, int phase, int32_t block);

/* Refines the blocks of one phase; takes from the worklist what they can take and puts back what they leave. only: the
 * column whose blocks have their turn, or TRI_NONE: all of them.
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
enum tri_status par_phase(struct par_run *state, const struct par_partition *partition, int phase, int32_t only,
                          struct tri_error *error);

/* Adds triangles to the worklist, by their keys, which ascend; whose key is there already is there. False: no memory,
 * and the worklist is as before. */
bool par_merge_worklist(struct par_run *state, const int32_t *item, const uint64_t *key, int32_t n);

#endif
