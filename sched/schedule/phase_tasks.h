/* What the files of a phase share: phase.c (dealing and running its blocks), collect.c (what they leave). */
#ifndef SCHED_SCHEDULE_PHASE_TASKS_H
#define SCHED_SCHEDULE_PHASE_TASKS_H

#include <stdatomic.h>

#include "sched/schedule/phase.h"
#include "triangle/mesh/fence.h"
#include "triangle/refine/refine.h"

enum par_progress {
    PAR_NEW,   /* waits for its first room */
    PAR_READY, /* has room, and has not begun, or has been stopped */
    PAR_FULL,  /* waits for more room, or for what others hold */
    PAR_ENDED
};

/* A block at work. Every field is its own while the phase runs; others read it before and after. */
struct par_task {
    int32_t block;
    int32_t expected;       /* triangles, to the order */
    struct tri_fence fence;
    struct par_view view;
    struct tri_owners owners;
    struct tri_refine_hooks hooks; /* its worklist is part of the phase's */
    struct tri_refine_report report;
    struct tri_refiner *refiner;
    struct par_ids left;  /* what gate and fence left */
    struct par_ids given_up;
    struct par_ids erased; /* a vertex and two triangles each */
    struct par_ids changed, asked; /* where others hold a part of the block: made by it, waited for */
    bool lost;              /* no memory for one of these lists */
    struct tri_part part;
    enum par_progress progress;
    int32_t pauses;         /* so far, for triangles */
    enum tri_status status;
    struct tri_error error;
    double seconds;
};

struct par_phase_run {
    struct par_run *run;
    const struct par_partition *partition;
    int phase;
    int32_t only;       /* column, or TRI_NONE */
    struct par_share *share;     /* as struct par_turn has it */
    const struct tri_stop *halt; /* likewise */
    bool *is_done;      /* [blocks] in an earlier call */
    struct par_ids given; /* the worklist as it was, */
    struct par_keys given_key;
    int32_t *block_of;  /* [given.n] who takes each */
    double *work;       /* [worklist.n] triangles that each will become, to the order */
    tri_triangle_id *worklist; /* [worklist.n] by block */
    struct par_task *tasks;
    int32_t n_tasks;
    int32_t *order;     /* [n_tasks] in which tasks are started */
    int64_t expected;   /* triangles of all tasks, to the order */
    _Atomic(int64_t) done; /* of these, in tasks that have ended */
    const void *caller; /* address of the own one's `here` */
    int32_t *mark;      /* [n_marks] debug builds: which block changed each triangle, see triangle/mesh/fence.h */
    size_t n_marks;
};

static inline int64_t par_inserted_by(const struct par_task *task)
{
    return task->report.inserted_free + task->report.inserted_on_segments;
}

/* In canonical order: room and left triangles of each task go back, and its report is added up. Returns what the first
 * one that has failed says. */
enum tri_status par_collect(struct par_phase_run *p, struct tri_error *error);

#endif
