/* Collects the results of a phase in canonical order: the triangles that its blocks deferred, given-up triangles,
 * deleted items, unused room and counts. It also holds the functions that add up reports. */
#include <assert.h>
#include <stdlib.h>

#include "sched/schedule/phase_tasks.h"
#include "triangle/base/grow.h"

/* --- reports */

void par_report_free(struct par_report *report)
{
    par_partition_free(&report->partition);
    free(report->blocks);
    report->blocks = NULL;
    report->n_blocks = report->block_capacity = 0;
}

int32_t par_block_of(const struct par_report *report, const struct tri_mesh *mesh, tri_triangle_id t, int *phase)
{
    for (*phase = 0; report->partition.x && *phase < PAR_PHASES; ++*phase) {
        int32_t block = par_owner_of(&report->partition, *phase, mesh, t);
        if (block != TRI_NONE)
            return block;
    }
    *phase = -1;
    return TRI_NONE;
}

void par_add_points(struct tri_refine_report *sum, const struct tri_refine_report *add)
{
    sum->inserted_free += add->inserted_free;
    sum->inserted_on_segments += add->inserted_on_segments;
}

void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add)
{
    par_add_points(sum, add);
    sum->gated += add->gated;
    sum->fenced += add->fenced;
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum->given_up[k] += add->given_up[k];
    sum->hit_limit |= add->hit_limit;
}

void par_forget_deferred(struct par_report *report) { report->total.gated = report->total.fenced = 0; }

/* --- worklists */

/* Merging the triangles that tasks have deferred. */
struct leftovers {
    const struct par_phase_run *p; /* the phase */
    _Atomic(uint64_t) *seen;       /* [n_triangles / 64 + 1] one bit for each triangle that has been met */
    int32_t *before;               /* [n_tasks + 1] number of triangles that all tasks before this one have left */
    int32_t *item;                 /* [before[n_tasks]] the triangles that all tasks have left, in canonical order */
    uint64_t *key;                 /* [before[n_tasks]] their keys */
};

/* Marks a triangle, and returns whether it was unmarked. Safe to call from several threads. */
static bool mark_seen(const struct leftovers *left, tri_triangle_id triangle)
{
    const uint64_t bit = (uint64_t)1 << triangle % 64;
    return !(atomic_fetch_or_explicit(&left->seen[triangle / 64], bit, memory_order_relaxed) & bit);
}

/* A task: removes duplicates from the list of one task. Without this, a triangle that was deferred at three encroached
 * subsegments would be listed three times, and nine times after the next phase. Two blocks never leave the same
 * triangle, since each leaves only triangles with two corners in its box, and boxes of one phase are disjoint. So the
 * result does not depend on the order in which these tasks run. */
static void drop_duplicates(void *context, size_t index)
{
    const struct leftovers *left = context;
    struct par_ids *own = &left->p->tasks[index].left;
    int32_t n = 0;
    for (int32_t k = 0; k < own->n; k++)
        if (mark_seen(left, own->item[k]))
            own->item[n++] = own->item[k];
    own->n = n;
}

/* A task: copies the list of one task to its place, and gives each triangle its key. */
static void copy_left(void *context, size_t index)
{
    const struct leftovers *left = context;
    const struct par_phase_run *p = left->p;
    const struct par_ids *own = &p->tasks[index].left;
    /* Keys depend on the block alone, not on the thread that ran it. */
    const uint64_t key = par_key_of(p->partition, p->run->place.round, p->phase, p->tasks[index].block);
    for (int32_t k = 0, at = left->before[index]; k < own->n; k++, at++) {
        left->item[at] = own->item[k];
        left->key[at] = key | (uint32_t)k;
    }
}

/* Removes duplicates from the lists of all tasks and joins the lists in canonical order. False: no memory, now or while
 * a task ran. */
static bool gather_left(struct leftovers *left)
{
    const struct par_phase_run *p = left->p;
    const size_t n = (size_t)p->n_tasks;
    bool memory = true;
    left->seen = calloc((size_t)p->run->mesh->n_triangles / 64 + 1, sizeof *left->seen);
    left->before = malloc((n + 1) * sizeof *left->before);
    if (!left->seen || !left->before)
        return false;
    /* First remove duplicates, then compute where each list begins, then copy. */
    tri_execute(&p->run->asked.executor, n, drop_duplicates, left);
    left->before[0] = 0;
    for (size_t i = 0; i < n; i++) {
        memory = memory && !p->tasks[i].lost;
        left->before[i + 1] = left->before[i] + p->tasks[i].left.n;
    }
    left->item = malloc(((size_t)left->before[n] + 1) * sizeof *left->item);
    left->key = malloc(((size_t)left->before[n] + 1) * sizeof *left->key);
    memory = memory && left->item && left->key;
    if (memory)
        tri_execute(&p->run->asked.executor, n, copy_left, left);
    return memory;
}

/* The key of entry i of the worklist; without keys, its position. */
static uint64_t key_of(const struct par_run *run, int32_t i)
{
    return run->key.n > 0 ? run->key.item[i] : (uint64_t)i;
}

bool par_merge_worklist(struct par_run *run, const int32_t *item, const uint64_t *key, int32_t n)
{
    struct par_ids *list = &run->worklist;
    int32_t most = list->n + n, at = 0, *items = malloc(((size_t)most + 1) * sizeof *items);
    uint64_t *keys = malloc(((size_t)most + 1) * sizeof *keys);
    if (!items || !keys) {
        free(items);
        free(keys);
        return false;
    }
    assert(run->key.n == 0 || run->key.n == list->n);
    /* Merge the lists. If both have an entry, it is taken from the old list and skipped in the new one. */
    for (int32_t i = 0, k = 0; i < list->n || k < n; at++) {
        bool old = k == n || (i < list->n && key_of(run, i) <= key[k]);
        items[at] = old ? list->item[i] : item[k];
        keys[at] = old ? key_of(run, i) : key[k];
        assert(at == 0 || keys[at - 1] < keys[at]);
        i += old;
        k += k < n && keys[at] == key[k];
    }
    free(run->worklist.item);
    free(run->key.item);
    run->worklist = (struct par_ids){items, at, most};
    run->key = (struct par_keys){keys, at, most};
    return true;
}

/* Appends the tasks' lists of changed triangles (on ranks) and of given-up triangles to those of the run. False: no
 * memory. */
static bool gather_lists(const struct par_phase_run *p)
{
    struct par_run *run = p->run;
    bool memory = true;
    for (const struct par_task *task = p->tasks; memory && task < p->tasks + p->n_tasks; task++)
        memory = (!p->share || par_ids_add_all(&p->share->changed, task->changed.item, task->changed.n)) &&
                 par_ids_add_all(&run->remain.listed, task->given_up.item, task->given_up.n);
    return memory;
}

/* Merges what the tasks have left into the worklist, and gathers the other lists. False: no memory. */
static bool merge_left(struct par_phase_run *p)
{
    struct leftovers left = {.p = p};
    bool memory = gather_left(&left) &&
                  par_merge_worklist(p->run, left.item, left.key, left.before[p->n_tasks]) && gather_lists(p);
    free(left.seen);
    free(left.before);
    free(left.item);
    free(left.key);
    return memory;
}

/* Returns whether the task has failed. A pause for room or a requested end is not a failure. */
static bool has_failed(const struct par_task *task)
{
    return task->status && task->status != TRI_NO_ROOM && task->status != TRI_STOPPED;
}

/* Adds an entry for the task to the report's list of blocks. False: no memory. */
static bool report_block(const struct par_phase_run *p, const struct par_task *task)
{
    struct par_report *report = p->run->report;
    if (!tri_grow(&report->blocks, &report->block_capacity, report->n_blocks + 1, sizeof *report->blocks))
        return false;
    report->blocks[report->n_blocks++] = (struct par_block_report){
        p->run->n_schedules - 1, p->run->place.round, p->phase, task->block, task->hooks.n_worklist,
        par_inserted_by(task), task->report.fenced, task->seconds};
    return true;
}

/* Adds the places of deleted vertices and triangles to the spare room. Not on ranks for vertices, because all ranks may
 * hold them, nor for the triangles of border blocks, which must return the parts that they borrowed first. False: no
 * memory. */
static bool release_erased(const struct par_phase_run *p, const struct par_task *task)
{
    struct par_run *run = p->run;
    bool memory = true;
    for (int32_t i = 0; memory && i < task->erased.n; i++) {
        const enum par_kind kind = i % 3 == 0 ? PAR_VERTICES : PAR_TRIANGLES;
        if (kind == PAR_VERTICES ? !run->ranks : !task->hooks.part)
            memory = par_room_release(&run->spare, kind, task->erased.item[i]);
    }
    return memory;
}

enum tri_status par_collect(struct par_phase_run *p, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    bool memory = merge_left(p);
    for (int32_t i = 0; i < p->n_tasks; i++) {
        struct par_task *task = &p->tasks[i];
        /* The first failure in canonical order counts, so errors do not depend on timing. */
        if (!status && has_failed(task)) {
            status = task->status;
            tri_fail(error, status, task->error.file, task->error.line, "%s", task->error.text);
        }
        par_add_up(&p->run->report->total, &task->report);
        /* A task that was stopped or has not begun is not reported. */
        memory = memory && (task->progress == PAR_READY || report_block(p, task));
        /* This cannot fail, and happens after errors, too: no range is lost. */
        par_room_return(&task->view.room, &p->run->spare);
        memory = release_erased(p, task) && memory;
        free(task->erased.item);
        free(task->left.item);
        free(task->given_up.item);
        free(task->changed.item);
        free(task->asked.item);
        tri_refiner_free(task->refiner);
    }
    return status || memory ? status : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for bad triangles");
}
