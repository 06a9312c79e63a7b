/* Internal to a phase. phase.c deals the worklist to blocks and runs them; collect.c collects their results. */
#ifndef SCHED_SCHEDULE_PHASE_TASKS_H
#define SCHED_SCHEDULE_PHASE_TASKS_H

#include <stdatomic.h>

#include "sched/schedule/phase.h"
#include "triangle/mesh/fence.h"
#include "triangle/refine/refine.h"

enum par_progress {
    PAR_NEW,   /* has not received room yet */
    PAR_READY, /* has room, and has not begun or has been stopped */
    PAR_FULL,  /* has paused: waits for more room, or for triangles that other ranks hold */
    PAR_ENDED  /* has refined all that it could */
};

/* A task: one block of the phase. While the phase runs, only the thread that runs the task accesses these fields. The
 * calling thread accesses them before and after, and during pauses. */
struct par_task {
    int32_t block;                 /* column * n_rows + row */
    int32_t expected;              /* estimated number of triangles that it will make */
    struct tri_fence fence;        /* the box of the block */
    struct par_view view;          /* the mesh as the block sees it, and its room */
    struct tri_owners owners;      /* debug builds: marks of the triangles that the block changes */
    struct tri_refine_hooks hooks; /* its worklist is a part of the phase's */
    struct tri_refine_report report; /* counts of inserted, deferred and given-up items */
    struct tri_refiner *refiner;   /* the state of the loop between pauses; NULL: not begun, or ended */
    struct par_ids left;           /* triangles that the fence deferred; may contain duplicates */
    struct par_ids given_up;       /* triangles that were given up; empty if they are not counted */
    struct par_ids erased;         /* items that the loop deleted: for each deletion one vertex, then two triangles */
    struct par_ids changed, asked; /* of a border block on ranks: triangles that it made, and pairs of vertices (edges)
                                      whose surroundings it waits for */
    bool lost;                     /* memory ran out for one of these lists */
    struct tri_part part;          /* callbacks of a border block on ranks */
    enum par_progress progress;    /* state of the task */
    int32_t pauses;                /* number of pauses so far for lack of triangles */
    enum tri_status status;        /* result of the last run */
    struct tri_error error;        /* details, if status is not TRI_OK */
    double seconds;                /* wall time of all its runs */
};

/* A phase that is running, or is prepared or collected. */
struct par_phase_run {
    struct par_run *run;         /* the run */
    const struct par_partition *partition; /* the blocks */
    int phase;                   /* 0 to 3 */
    int32_t only;                /* run only blocks of this column; TRI_NONE: of all */
    struct par_share *share;     /* as in struct par_turn */
    const struct tri_stop *halt; /* as in struct par_turn */
    bool *is_done;               /* [blocks] the block ended in an earlier call, before a halt */
    struct par_ids given;        /* the worklist before it was dealt to blocks; put back after a halt */
    struct par_keys given_key;   /* its keys */
    int32_t *block_of;           /* [given.n] the block that gets each triangle; TRI_NONE: none in this phase, GONE: the
                                    triangle no longer exists */
    double *work;                /* [given.n] estimated number of triangles that each will become */
    tri_triangle_id *worklist;   /* [given.n] the entries dealt to blocks, block by block */
    struct par_task *tasks;      /* [n_tasks] one for each block with work, in canonical order */
    int32_t n_tasks;             /* number of tasks */
    int32_t *order;              /* [n_tasks] indices of the tasks, in the order in which they start */
    int64_t expected;            /* estimated number of triangles that all tasks will make */
    _Atomic(int64_t) done;       /* the part of `expected` whose tasks have ended; updated by all threads */
    const void *caller;          /* address of the calling thread's variable `here`, by which tasks recognise that they
                                    run on it */
    int32_t *mark;               /* [n_marks] debug builds: the block, plus 1, that changed each triangle
                                    (triangle/mesh/fence.h); NULL: not checked */
    size_t n_marks;              /* allocated marks */
};

/* Number of points that the task has inserted. */
static inline int64_t par_inserted_by(const struct par_task *task)
{
    return task->report.inserted_free + task->report.inserted_on_segments;
}

/* Collects the results of all tasks in canonical order: returns their room to the spare room, merges the triangles that
 * they left into the worklist, and adds up their reports. Frees the tasks' lists. Called on the calling thread after
 * all blocks have stopped. Returns the status of the first failed task, if any. */
enum tri_status par_collect(struct par_phase_run *p, struct tri_error *error);

#endif
