/* Runs a phase.
 *
 *   1. assign_share   finds the block of each worklist entry, and its estimated work; in parallel
 *   2. deal_worklists deals the entries to blocks by a counting sort, and makes a task for each block with entries
 *   3. deal_room      gives ranges of the shared arrays to the tasks; sequential, in canonical order
 *   4. run_tasks      runs the tasks on all threads; a task ends, pauses for lack of room, or is stopped
 *   5. repeat 3 and 4 until no task waits
 *   6. par_collect    (collect.c) returns unused room, and merges the deferred triangles into the worklist
 *
 * Steps 1, 2, 3 and 6 depend only on the mesh and the worklist, and the blocks of step 4 change disjoint parts of the
 * mesh. So the result does not depend on the number of threads. */
#include "sched/schedule/phase.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/phase_tasks.h"
#include "sched/schedule/deal.h"
#include "sched/tunables.h"
#include "triangle/base/system.h"
#include "triangle/base/grow.h"
#include "triangle/size/estimate.h"

enum { GONE = -2 }; /* in par_phase_run.block_of: the triangle no longer exists */

/* --- callbacks of the loop, called on the thread that runs the task. Each appends to a list of the task. If memory
 * runs out, `lost` is set, and par_collect reports the error. */

static void note_deferred(void *user, tri_triangle_id triangle)
{
    struct par_task *task = user;
    task->lost |= !par_ids_add(&task->left, triangle);
}

static void note_given_up(void *user, tri_triangle_id triangle)
{
    struct par_task *task = user;
    task->lost |= !par_ids_add(&task->given_up, triangle);
}

static void note_erased(void *user, tri_vertex_id v, const tri_triangle_id triangle[2])
{
    struct par_task *task = user;
    const int32_t gone[3] = {v, triangle[0], triangle[1]};
    task->lost |= !par_ids_add_all(&task->erased, gone, 3);
}

static void note_changes(void *user, const tri_triangle_id *triangle, int32_t n)
{
    struct par_task *task = user;
    task->lost |= !par_ids_add_all(&task->changed, triangle, n);
}

static void note_asked_edge(void *user, const tri_vertex_id edge[2])
{
    struct par_task *task = user;
    task->lost |= !par_ids_add_all(&task->asked, edge, 2);
}

/* Returns the block of this phase that owns triangle t and runs in this call; TRI_NONE if there is none, or if it is
 * another rank's, of another column, or has ended before a halt. */
static int32_t owner_now(const struct par_phase_run *p, struct par_locator *locator, tri_triangle_id t)
{
    int32_t block = par_locate_owner(locator, p->partition, p->phase, p->run->mesh, t);
    if (block != TRI_NONE && p->is_done[block])
        return TRI_NONE;
    if (p->share) /* on ranks, each rank runs its own blocks */
        return block == TRI_NONE || p->share->is_mine[block] ? block : TRI_NONE;
    bool mine = p->only == TRI_NONE || block == TRI_NONE || block / p->partition->n_rows == p->only;
    return mine ? block : TRI_NONE;
}

/* A task: finds the block of each worklist entry of one share, and estimates its work. Entries whose triangle no longer
 * exists are marked GONE. */
static void assign_share(void *context, size_t share)
{
    const struct par_phase_run *p = context;
    const struct tri_mesh *mesh = p->run->mesh;
    const struct tri_range range = tri_share_of(share, TRI_MOST_SHARES, p->run->worklist.n);
    struct par_locator locator = PAR_LOST;
    for (int32_t i = range.first; i < range.last; i++) {
        tri_triangle_id t = p->run->worklist.item[i];
        p->block_of[i] = tri_is_live(&mesh->tri[t]) ? owner_now(p, &locator, t) : GONE;
        p->work[i] = p->block_of[i] >= 0 ? tri_work_of(mesh, &p->run->bounds, t) : 0;
    }
}

/* Estimates the number of triangles that a block makes in this phase, from the total work of its entries. The estimate
 * is a little low on purpose, because a pause costs less than unused room. */
static int32_t estimate_triangles_made(int phase, double work)
{
    static const double share[PAR_PHASES] = PAR_DONE_IN_PHASES;
    double expected = share[phase] * work + 128;
    return expected < 1e7 ? (int32_t)expected : 10000000;
}

/* Deals the worklist to blocks by a counting sort. Bin 0 is for entries that no block of this phase gets; they stay in
 * the worklist. Bin k + 1 is for block k. Entries marked GONE are dropped. */
struct dealing {
    struct par_phase_run *p; /* the phase */
    struct par_deal deal;    /* counts and places, for shares and bins */
    double *work;            /* [shares][bins] work of the entries, in the layout of the counts */
    int32_t *kept;           /* [entries of bin 0] the entries that stay in the worklist */
    uint64_t *key;           /* their keys; NULL if the worklist has no keys */
};

/* Returns a share's row of `work`, one item for each bin. */
static double *work_at(const struct dealing *d, size_t share) { return d->work + share * (size_t)d->deal.n_tiles; }

/* A task: counts the entries of one share by bin, and sums their work. */
static void count_share(void *context, size_t share)
{
    const struct dealing *d = context;
    const struct par_phase_run *p = d->p;
    int32_t *count = par_deal_at(&d->deal, share);
    double *work = work_at(d, share);
    const struct tri_range range = par_deal_share(&d->deal, share);
    for (int32_t i = range.first; i < range.last; i++)
        if (p->block_of[i] != GONE) {
            count[p->block_of[i] + 1]++;
            work[p->block_of[i] + 1] += p->work[i];
        }
}

/* A task: writes each entry of one share to its place, in p->worklist or in `kept`. Shares write to disjoint places. */
static void deal_share(void *context, size_t share)
{
    const struct dealing *d = context;
    const struct par_phase_run *p = d->p;
    const struct par_keys *key = &p->run->key;
    int32_t *at = par_deal_at(&d->deal, share);
    const struct tri_range range = par_deal_share(&d->deal, share);
    for (int32_t i = range.first; i < range.last; i++) {
        if (p->block_of[i] == GONE)
            continue;
        int32_t to = at[p->block_of[i] + 1]++;
        if (p->block_of[i] != TRI_NONE) {
            p->worklist[to - d->deal.start[1]] = p->run->worklist.item[i];
            continue;
        }
        d->kept[to] = p->run->worklist.item[i];
        if (key->n > 0)
            d->key[to] = key->item[i];
    }
}

/* Makes a task for each block that got an entry, in the order of block numbers. Work is summed share by share, in a
 * fixed order, so that estimates do not depend on the number of threads. False: no memory. */
static bool make_tasks(const struct dealing *d)
{
    struct par_phase_run *p = d->p;
    const int32_t *start = d->deal.start;
    size_t used = 0;
    for (int32_t bin = 1; bin < d->deal.n_tiles; bin++)
        used += start[bin + 1] > start[bin];
    p->tasks = calloc(used + 1, sizeof *p->tasks);
    for (int32_t bin = 1; p->tasks && bin < d->deal.n_tiles; bin++) {
        double work = 0;
        for (size_t share = 0; share < d->deal.shares; share++)
            work += work_at(d, share)[bin];
        if (start[bin + 1] > start[bin])
            p->tasks[p->n_tasks++] = (struct par_task){
                .block = bin - 1, .expected = estimate_triangles_made(p->phase, work),
                .hooks = {.worklist = p->worklist + start[bin] - start[1], .n_worklist = start[bin + 1] - start[bin]}};
    }
    return p->tasks;
}

/* Counts, deals and makes the tasks. If it succeeds, the remaining entries become the run's worklist, and `given` keeps
 * the old one. False: no memory; the run's worklist is unchanged. */
static bool deal_all(struct dealing *d)
{
    struct par_run *run = d->p->run;
    tri_execute(&run->asked.executor, d->deal.shares, count_share, d);
    par_deal_add_up(&d->deal);
    const int32_t n_kept = d->deal.start[1];
    d->kept = malloc(((size_t)n_kept + 1) * sizeof *d->kept);
    d->key = run->key.n > 0 ? malloc(((size_t)n_kept + 1) * sizeof *d->key) : NULL;
    if (!d->kept || (run->key.n > 0 && !d->key))
        return false;
    /* The counts have become places, so each share can write its entries independently of the others. */
    tri_execute(&run->asked.executor, d->deal.shares, deal_share, d);
    if (!make_tasks(d))
        return false;
    /* Nothing can fail any more: swap the lists. */
    d->p->given = run->worklist;
    d->p->given_key = run->key;
    run->worklist = (struct par_ids){d->kept, n_kept, n_kept};
    run->key = (struct par_keys){d->key, d->key ? n_kept : 0, d->key ? n_kept : 0};
    d->kept = NULL;
    d->key = NULL;
    return true;
}

/* Deals the worklist to the blocks of the phase. False: no memory. */
static bool deal_worklists(struct par_phase_run *p)
{
    struct dealing d = {.p = p};
    bool memory = par_deal_reserve(&d.deal, p->run->worklist.n, par_blocks(p->partition) + 1);
    d.work = calloc(d.deal.shares * (size_t)d.deal.n_tiles, sizeof *d.work);
    memory = memory && d.work && deal_all(&d);
    par_deal_free(&d.deal);
    free(d.work);
    free(d.kept);
    free(d.key);
    return memory;
}

/* Prepares a task: its fence, and the hooks by which the loop reports to it. Its part of the worklist has been set by
 * make_tasks. */
static void set_up_task(struct par_phase_run *p, struct par_task *task)
{
    const struct par_run *run = p->run;
    task->fence = par_fence(p->partition, task->block / p->partition->n_rows, task->block % p->partition->n_rows);
    task->part = (struct tri_part){note_changes, note_asked_edge, task};
    task->hooks = (struct tri_refine_hooks){
        .fence = &task->fence,
        .part = p->share && p->share->is_border[task->block] ? &task->part : NULL,
        .worklist = task->hooks.worklist,
        .n_worklist = task->hooks.n_worklist,
        .deferred = note_deferred,
        .deferred_user = task,
        .given_up = run->remain.is_on ? note_given_up : NULL,
        .given_up_user = task,
        .erased = note_erased,
        .erased_user = task,
        .more_room = par_view_more_room,
        .more_room_user = &task->view,
    };
}

/* Returns how many more triangles a paused task gets room for. A pause costs the contents of the cache, and all paused
 * blocks wait for the slowest block. If areas decide, the first estimate is about right, so a sixteenth of it is
 * enough; otherwise it is a guess, and a quarter is given. The amount doubles at each pause, but is at most as much as
 * the task has made so far. Room that stays unused serves later phases. */
static int32_t triangles_to_add(const struct par_task *task, const struct tri_quality *quality)
{
    double inserted = (double)(task->report.inserted_free + task->report.inserted_on_segments);
    bool areas = quality->max_area > 0 || quality->region_areas;
    double more = ldexp(fmax(task->expected, 2 * inserted) / (areas ? 16 : 4), task->pauses) + 256;
    return (int32_t)fmin(more, 2 * inserted + 256);
}

/* Sums the estimates of all tasks and grows the shared arrays once. */
static void reserve_room(struct par_phase_run *p)
{
    p->expected = 0;
    for (int32_t i = 0; i < p->n_tasks; i++)
        p->expected += p->tasks[i].expected;
    par_room_reserve(&p->run->spare, p->run->mesh, p->expected);
}

/* Returns for how many triangles a paused task must have room; the result is passed to par_room_extend. If only room
 * for subsegments has run out, as happens along a coast line, more triangles would stay unused. In this case the number
 * of unused triangles is returned, and the task gets only the subsegments that belong to them. */
static int32_t triangles_needed(struct par_task *task, const struct tri_quality *quality)
{
    const int64_t on_segments = task->report.inserted_on_segments, all = task->report.inserted_free + on_segments;
    const int32_t more = triangles_to_add(task, quality), left = par_room_left(&task->view.room, PAR_TRIANGLES);
    task->view.room.on_segments = all > 0 ? (double)on_segments / (double)all : 0;
    if (left >= more / 4)
        return left;
    task->pauses++;
    return more;
}

/* Gives a task its first room, or more room if it has paused. A task that asked for several points at once gets room
 * for at least these. */
static enum tri_status extend_room(struct par_phase_run *p, struct par_task *task, struct tri_error *error)
{
    int32_t more = task->progress == PAR_NEW ? task->expected : triangles_needed(task, &p->run->bounds);
    if (p->run->asked.options->tight_room > 0)
        more = p->run->asked.options->tight_room;
    if (more < 2 * task->view.points)
        more = 2 * task->view.points;
    p->run->report->pauses += task->progress == PAR_FULL;
    return par_room_extend(&task->view.room, &p->run->spare, p->run->mesh, more, error);
}

/* Gives room to all tasks that wait for it, in canonical order, and makes them ready. Tasks that wait for triangles of
 * other ranks have enough room. Called on the calling thread while no task runs. */
static enum tri_status deal_room(struct par_phase_run *p, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int32_t i = 0; !status && i < p->n_tasks; i++) {
        struct par_task *task = &p->tasks[i];
        if (task->progress == PAR_ENDED || task->progress == PAR_READY)
            continue;
        if (task->asked.n == 0)
            status = extend_room(p, task, error);
        task->progress = PAR_READY;
    }
    return status;
}

/* Fetches from other ranks, all at once, the triangles for which border blocks wait. Tasks that wait only for room are
 * not affected. */
static enum tri_status fetch_more(struct par_phase_run *p, struct tri_error *error)
{
    struct par_ids asked = {0};
    bool memory = true;
    for (int32_t i = 0; i < p->n_tasks; i++) {
        struct par_task *task = &p->tasks[i];
        memory = memory && !task->lost && par_ids_add_all(&asked, task->asked.item, task->asked.n);
    }
    enum tri_status status = memory ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a phase");
    if (!status && asked.n > 0)
        status = p->share->more(p->share->user, &asked, error);
    free(asked.item);
    return status;
}

/* In debug builds every block marks the triangles that it changes, and an assertion in cavity.c fails if two blocks
 * change the same one. Extends the marks to the capacity of the arrays. False: no memory. */
static bool extend_owner_marks(struct par_phase_run *p)
{
#ifdef NDEBUG
    (void)p;
#else
    size_t n = (size_t)p->run->mesh->triangle_capacity + 1;
    if (!tri_resize(&p->mark, n, sizeof *p->mark))
        return false;
    for (size_t i = p->n_marks; i < n; i++)
        p->mark[i] = 0;
    p->n_marks = n;
#endif
    return true;
}

/* Runs a task from its beginning or from its last pause until it ends, pauses, or is stopped. Called on any thread of
 * the team. No other thread accesses the task meanwhile, and the shared arrays do not move. */
static void run_task(struct par_phase_run *p, struct par_task *task)
{
    double began = tri_seconds();
    assert(task->progress == PAR_READY);
    task->owners = (struct tri_owners){p->mark, task->block + 1};
    task->hooks.owners = p->mark ? &task->owners : NULL;
    par_view_begin(&task->view, p->run->mesh);
    /* The triangles that it asked for before the pause have been fetched. */
    task->asked.n = 0;
    task->status = TRI_OK;
    /* The refiner keeps the queue of the block across pauses. */
    if (!task->refiner)
        task->status = tri_refiner_new(&task->refiner, &task->view.mesh, &p->run->bounds, &task->hooks,
                                       &task->report, &task->error);
    if (!task->status)
        task->status = tri_refiner_run(task->refiner, &task->error);
    par_view_end(&task->view);
    task->progress = task->status == TRI_NO_ROOM ? PAR_FULL : task->status == TRI_STOPPED ? PAR_READY : PAR_ENDED;
    if (task->progress == PAR_ENDED) {
        tri_refiner_free(task->refiner);
        task->refiner = NULL;
    }
    task->seconds += tri_seconds() - began;
}

int64_t par_triangles(const struct par_run *run)
{
    return run->gone + run->mesh->n_triangles - par_ranges_unused(&run->spare.ranges[PAR_TRIANGLES]);
}

/* Its address identifies the thread. */
static _Thread_local char here;

/* Calls the caller's progress callback. Called on the calling thread only. */
static void report_progress(const struct par_run *run, int phase, double done, int64_t triangles)
{
    const struct par_options *options = run->asked.options;
    const struct par_place place = {.level = run->place.level, .sizes = par_is_of_sizes(run->place.next),
                                    .column = run->place.column,
                                    .n_columns = run->place.column > 0 ? (run->cells.n_columns + 1) / 2 : 0,
                                    .round = run->place.round,
                                    .phase = phase, .done = done, .triangles = triangles};
    if (options->progress)
        options->progress(options->progress_user, &place);
}

void par_report_phase(const struct par_run *run, int phase) { report_progress(run, phase, 0, par_triangles(run)); }

/* Returns the least number of triangles that a task has made. A free point makes two triangles; a point on a segment
 * makes two or, on the boundary, one. */
static int64_t least_made_by(const struct par_task *task) { return par_inserted_by(task) + task->report.inserted_free; }

/* Called on the thread that ran the task, when the task has ended. Adds the task to the progress of all threads; if
 * this is the calling thread, also reports the progress. The number of triangles counts only triangles that have
 * certainly been made, so it never decreases. */
static void report_task_end(struct par_phase_run *p, const struct par_task *task)
{
    const int64_t made = least_made_by(task);
    const int64_t all = atomic_fetch_add_explicit(&p->run->reached, made, memory_order_relaxed) + made;
    const int64_t done = atomic_fetch_add_explicit(&p->done, task->expected, memory_order_relaxed) + task->expected;
    const double before = p->run->share_done, share = (double)done / (double)p->expected;
    if (p->caller == &here)
        report_progress(p->run, p->phase + 1, before + (1 - before) * share, all);
}

/* Runs the task at position index of the starting order, unless it is not ready, the end is requested, or the phase is
 * halted before the task has begun. A task that has begun continues in spite of a halt. */
static void run_queued_task(void *context, size_t index)
{
    struct par_phase_run *p = context;
    struct par_task *task = &p->tasks[p->order[index]];
    if (task->progress != PAR_READY || tri_stop_is_asked(p->run->mesh->stop))
        return;
    if (!task->refiner && tri_stop_is_asked(p->halt))
        return;
    run_task(p, task);
    if (task->progress == PAR_ENDED)
        report_task_end(p, task);
}

/* Runs all tasks that are ready, until each has ended, has paused, or is stopped. After a halt is requested no new task
 * begins. */
static void run_tasks(struct par_phase_run *p)
{
    double began = tri_seconds();
    struct par_report *report = p->run->report;
    double shared[PAR_SHARINGS]; /* blocks are not equal shares: undo below what run_timed adds */
    memcpy(shared, report->seconds_shared, sizeof shared);
    /* Tasks compare this with the address on their own thread. */
    p->caller = &here;
    tri_execute(&p->run->asked.executor, (size_t)p->n_tasks, run_queued_task, p);
    memcpy(report->seconds_shared, shared, sizeof shared);
    double seconds = tri_seconds() - began;
    report->seconds_refine += seconds;
    report->phase_seconds[p->phase] += seconds;
}

/* Returns whether any task is in this state. */
static bool is_any_task(const struct par_phase_run *p, enum par_progress progress)
{
    for (int32_t i = 0; i < p->n_tasks; i++)
        if (p->tasks[i].progress == progress)
            return true;
    return false;
}

/* A task in the starting order. */
struct queued {
    int32_t expected, task; /* sorting key; index of the task */
};

/* Larger keys first; equal ones in canonical order. */
static int by_expected(const void *left, const void *right)
{
    const struct queued *a = left, *b = right;
    if (a->expected != b->expected)
        return a->expected > b->expected ? -1 : 1;
    return (a->task > b->task) - (a->task < b->task);
}

/* Fixes the order in which tasks start: the largest estimate first, so that small tasks run at the end and all threads
 * finish at about the same time. For tests: a random order. False: no memory. */
static bool order_tasks(struct par_phase_run *p)
{
    unsigned draw = p->run->asked.options->shuffle;
    struct queued *queue = malloc(((size_t)p->n_tasks + 1) * sizeof *queue);
    p->order = malloc(((size_t)p->n_tasks + 1) * sizeof *p->order);
    if (queue && p->order) {
        for (int32_t i = 0; i < p->n_tasks; i++) {
            /* Draw the next random number, for tests. Otherwise the key is the estimate. */
            draw = draw * 1664525u + 1013904223u;
            queue[i] = (struct queued){p->run->asked.options->shuffle ? (int32_t)(draw >> 8) : p->tasks[i].expected, i};
        }
        qsort(queue, (size_t)p->n_tasks, sizeof *queue, by_expected);
        for (int32_t i = 0; i < p->n_tasks; i++)
            p->order[i] = queue[i].task;
    }
    bool done = queue && p->order;
    free(queue);
    return done;
}

/* Deals the worklist and prepares the tasks. */
static enum tri_status begin_tasks(struct par_phase_run *p, struct tri_error *error)
{
    struct par_report *report = p->run->report;
    double began = tri_seconds();
    tri_execute(&p->run->asked.executor, TRI_MOST_SHARES, assign_share, p); /* many shares: each entry is expensive */
    double assigned = tri_seconds();
    bool memory = deal_worklists(p);
    for (int32_t i = 0; memory && i < p->n_tasks; i++)
        set_up_task(p, &p->tasks[i]);
    if (!memory)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the blocks of a phase");
    report->seconds_find += assigned - began;
    report->seconds_deal += tri_seconds() - assigned;
    return TRI_OK;
}

/* Gives room to the tasks that wait for it, after all others have stopped. So the room that a task gets does not depend
 * on when others stopped. */
static enum tri_status prepare_run(struct par_phase_run *p, struct tri_error *error)
{
    double dealing = tri_seconds();
    enum tri_status status = deal_room(p, error);
    if (!status && !extend_owner_marks(p))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the owners of triangles");
    p->run->report->seconds_room += tri_seconds() - dealing;
    return status;
}

/* Alternates between giving room and running tasks until no task waits. TRI_STOPPED: some tasks have not ended; after a
 * halt these have not begun. */
static enum tri_status run_to_end(struct par_phase_run *p, struct tri_error *error)
{
    double reserving = tri_seconds();
    enum tri_status status;
    reserve_room(p);
    p->run->report->seconds_room += tri_seconds() - reserving;
    do {
        /* All tasks have stopped here, so the arrays may move. */
        status = prepare_run(p, error);
        if (status)
            break;
        run_tasks(p);
        /* A task that is still ready was stopped or, after a halt, has not begun. Tasks that have begun run to their
         * end in spite of a halt, so the loop goes on while some of them wait. */
        status = is_any_task(p, PAR_READY) && !p->halt ? tri_fail_stopped(error) : fetch_more(p, error);
    } while (!status && is_any_task(p, PAR_FULL));
    free(p->mark);
    p->mark = NULL;
    return !status && is_any_task(p, PAR_READY) ? tri_fail_stopped(error) : status;
}

/* After a halt: lists the blocks that have ended in run->place.done, and adds their share of the work to
 * run->share_done. False: no memory. */
static bool list_done_blocks(struct par_phase_run *p)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < p->n_tasks; i++)
        if (p->tasks[i].progress == PAR_ENDED) {
            memory = par_ids_add(&p->run->place.done, p->tasks[i].block);
            p->is_done[p->tasks[i].block] = true;
        }
    p->run->share_done += (1 - p->run->share_done) * (double)p->done / (double)p->expected;
    return memory;
}

/* After a halt: restores the worklist as it was before it was dealt, without the entries whose triangle no longer
 * exists and those of blocks that have ended. */
static void restore_worklist(struct par_phase_run *p)
{
    struct par_ids *list = &p->given;
    struct par_keys *key = &p->given_key;
    int32_t n = 0;
    for (int32_t i = 0; i < list->n; i++)
        if (p->block_of[i] == TRI_NONE || (p->block_of[i] != GONE && !p->is_done[p->block_of[i]])) {
            if (key->n > 0)
                key->item[n] = key->item[i];
            list->item[n++] = list->item[i];
        }
    list->n = n;
    key->n = key->n > 0 ? n : 0;
    free(p->run->worklist.item);
    free(p->run->key.item);
    p->run->worklist = *list;
    p->run->key = *key;
    *list = (struct par_ids){0};
    *key = (struct par_keys){0};
}

/* Runs the phase, or its remaining blocks after a halt, and then collects the results of its tasks. Results are
 * collected after errors, too, so that the room of all tasks returns to the spare room. */
static enum tri_status run_phase(struct par_phase_run *p, struct tri_error *error)
{
    enum tri_status status = begin_tasks(p, error);
    if (status)
        return status;
    if (!order_tasks(p))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the order of blocks");
    status = status ? status : run_to_end(p, error);
    if (status == TRI_STOPPED && p->halt) {
        if (!list_done_blocks(p))
            status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the blocks that are done");
        restore_worklist(p);
    }
    double merging = tri_seconds();
    enum tri_status collected = par_collect(p, error);
    p->run->report->seconds_merge += tri_seconds() - merging;
    return collected ? collected : status; /* a failed block counts more than a stop */
}

enum tri_status par_phase(struct par_run *run, const struct par_turn *turn, struct tri_error *error)
{
    size_t n = (size_t)run->worklist.n + 1;
    struct par_phase_run p = {.run = run, .partition = turn->partition, .phase = run->place.phase, .only = turn->only,
                              .share = turn->share, .halt = turn->halt};
    atomic_store(&run->reached, par_triangles(run));
    assert(p.phase >= 0 && p.phase < PAR_PHASES && (p.only == TRI_NONE || p.only % 2 == 1 - p.phase / 2));
    p.block_of = malloc(n * sizeof *p.block_of);
    p.work = malloc(n * sizeof *p.work);
    p.worklist = malloc(n * sizeof *p.worklist);
    /* Blocks that ended before a halt do not run again. */
    p.is_done = calloc((size_t)par_blocks(p.partition), sizeof *p.is_done);
    for (int32_t i = 0; p.is_done && i < run->place.done.n; i++)
        p.is_done[run->place.done.item[i]] = true;
    enum tri_status status = TRI_OK;
    if (tri_stop_is_asked(run->mesh->stop))
        status = tri_fail_stopped(error);
    else if (!p.block_of || !p.work || !p.worklist || !p.is_done)
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the worklists of a phase");
    else
        status = run_phase(&p, error);
    /* The list of ended blocks is needed only if the phase is continued after a halt. */
    if (status != TRI_STOPPED) {
        run->place.done.n = 0;
        run->share_done = 0;
    }
    free(p.block_of);
    free(p.work);
    free(p.worklist);
    free(p.is_done);
    free(p.given.item);
    free(p.given_key.item);
    free(p.tasks);
    free(p.order);
    return status;
}

/* --- rounds */

enum tri_status par_run_rounds(struct par_run *run, const struct par_steps *steps, void *self, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    bool again = true;
    while (!status && again) {
        while (!status && run->place.phase < PAR_PHASES)
            status = steps->run_phase(self, error);
        status = status ? status : steps->end_round(self, &again, error);
    }
    return status;
}

bool par_next_round(struct par_schedule *s)
{
    struct par_position *place = &s->run->place;
    s->run->report->rounds++;
    if (s->left == 0 || !par_can_coarsen(&s->partition))
        return false;
    par_partition_coarsen(&s->partition);
    place->round++;
    place->phase = 0;
    return true;
}
