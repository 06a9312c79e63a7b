/* Processes one column after the other: refines it, checks that its blocks left over no work, and hands it out. */
#include "sched/tiles/sweep.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/state.h"
#include "sched/tiles/park.h"
#include "triangle/base/system.h"
#include "triangle/refine/census.h"

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the worklists of a sweep");
}

/* --- Work for later columns is kept out of the worklist until its column is reached, so that a scan of the worklist
 * costs no more than the work of a few columns.
 *
 * THEOREM. The result does not change. A triangle waits for the first odd column of blocks whose right end lies right
 * of all its corners. A block removes from the worklist, and changes, only triangles with all corners in its fence.
 * Fences of earlier columns end further left, so no block needs the triangle before its column is reached. It is then
 * merged into the worklist by its key. */

struct ahead {
    int32_t *item;  /* [start[n_odd]] triangles, by odd column, in each column in the order of the worklist */
    uint64_t *key;  /* [start[n_odd]] key of each triangle: its index in the original worklist */
    int32_t *start; /* [n_odd + 1] index in `item` of the first triangle of each odd column */
    int32_t n_odd;  /* number of odd columns */
};

/* Returns i if column 2 i + 1 is the first odd column whose right end lies right of x. */
static int32_t column_beyond(const struct par_partition *p, double x, int32_t n_odd)
{
    int32_t low = 0, high = n_odd - 1; /* the last one reaches to infinity */
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (x < par_fence(p, 2 * middle + 1, 0).x_max)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

/* Returns the largest x coordinate of the corners. */
static double right_end(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    double a = mesh->xy[v[0]].x, b = mesh->xy[v[1]].x, c = mesh->xy[v[2]].x;
    double most = a > b ? a : b;
    return most > c ? most : c;
}

/* Lists the triangles of the worklist by odd column, before any block has run. A counting sort. Does not change the
 * run. False: no memory. Call free_ahead in any case. */
static bool list_ahead(struct ahead *ahead, const struct par_run *run, const struct par_partition *partition)
{
    const struct par_ids *list = &run->worklist;
    int32_t n_odd = (partition->n_columns - 1) / 2;
    size_t n = (size_t)list->n + 1;
    assert(run->key.n == 0);
    *ahead = (struct ahead){malloc(n * sizeof *ahead->item), malloc(n * sizeof *ahead->key),
                                calloc((size_t)n_odd + 2, sizeof *ahead->start), n_odd};
    int32_t *column = malloc(n * sizeof *column), *start = ahead->start;
    bool memory = ahead->item && ahead->key && start && column;
    for (int32_t i = 0; memory && i < list->n; i++) {
        column[i] = column_beyond(partition, right_end(run->mesh, list->item[i]), n_odd);
        start[column[i] + 2]++;
    }
    for (int32_t i = 0; memory && i < n_odd; i++)
        start[i + 2] += start[i + 1];
    for (int32_t i = 0; memory && i < list->n; i++) {
        int32_t at = start[column[i] + 1]++;
        ahead->item[at] = list->item[i];
        ahead->key[at] = (uint64_t)i;
    }
    free(column);
    return memory;
}

static void free_ahead(struct ahead *ahead)
{
    free(ahead->item);
    free(ahead->key);
    free(ahead->start);
    *ahead = (struct ahead){0};
}

/* Merges the triangles that wait for an odd column into the worklist. False: no memory. */
static bool merge_ahead(const struct ahead *ahead, struct par_run *run, int32_t odd)
{
    int32_t i = odd / 2;
    if (i >= ahead->n_odd)
        return true;
    int32_t first = ahead->start[i];
    return par_merge_worklist(run, ahead->item + first, ahead->key + first, ahead->start[i + 1] - first);
}

/* --- Counts the triangles that still violate the bounds, by reason, although the mesh is handed out during refinement.
 *
 * THEOREM. Each bad triangle that remains is in run->remain.listed. A block that makes a bad triangle treats it until
 * the triangle is gone, or gives it up and lists it. Bad triangles of the initial mesh are in the worklist if they can
 * be improved, and are listed at the beginning otherwise. A listed triangle may have disappeared, and its id may belong
 * to another triangle. Listed triangles are therefore judged again as soon as they can no longer change. */

/* Returns the report of the run without the counts of deferred triangles: in a finished mesh, deferral is no reason. */
static struct tri_refine_report report_of(const struct par_run *run)
{
    struct tri_refine_report report = run->report->total;
    report.gated = report.fenced = 0;
    return report;
}

/* Lists the bad triangles that cannot be improved. The worklist has been filled. False: no memory. */
static bool begin_remain(struct par_run *run)
{
    struct par_ids *list = &run->remain.listed;
    tri_triangle_id *found = malloc(((size_t)run->mesh->n_triangles + 1) * sizeof *found);
    const int32_t n = found ? tri_find_hopeless(run->mesh, &run->bounds, found) : 0;
    list->n = 0;
    bool memory = found && par_ids_add_all(list, found, n);
    free(found);
    memset(run->remain.counted, 0, sizeof run->remain.counted);
    return memory;
}

static bool has_corner_left_of(const struct tri_mesh *mesh, tri_triangle_id t, double x)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    return mesh->xy[v[0]].x < x || mesh->xy[v[1]].x < x || mesh->xy[v[2]].x < x;
}

/* Counts the listed bad triangles with a corner left of x, and removes them from the list. They can no longer change,
 * and their neighbours are still in the mesh. Triangles with a corner left of the previous x were counted before. */
static void count_remain(struct par_run *run, double x)
{
    const struct tri_mesh *mesh = run->mesh;
    const struct tri_refine_report report = report_of(run);
    struct par_ids *list = &run->remain.listed;
    int32_t n = par_sort_unique(list->item, list->n), live = 0, kept = 0;
    for (int32_t i = 0; i < n; i++) {
        const tri_triangle_id t = list->item[i];
        if (!tri_is_live(&mesh->tri[t]))
            continue;
        list->item[live++] = t;
        if (!has_corner_left_of(mesh, t, x)) {
            list->item[live - 1] = list->item[kept];
            list->item[kept++] = t;
        }
    }
    tri_count_bad_among(mesh, &run->bounds, &report, list->item + kept, live - kept, run->remain.counted);
    list->n = kept;
}

/* Writes the counts to the report. */
static void report_remain(struct par_run *run)
{
    const struct tri_refine_report report = report_of(run);
    tri_settle_counts(&report, run->remain.counted, run->report->remain);
    run->report->remain_known = true;
}

void par_remain_count_all(struct par_run *run)
{
    const struct tri_refine_report report = report_of(run);
    tri_count_bad(run->mesh, &run->bounds, &report, &run->asked.executor, run->report->remain);
    run->report->remain_known = true;
}

/* --- processing the columns */

struct par_tiles par_tiles_of(const struct par_run *run, const struct par_partition *partition)
{
    return (struct par_tiles){.mesh = run->mesh, .partition = partition, .executor = &run->asked.executor,
                              .n_kept = run->asked.n_kept, .sink = run->asked.options->sink,
                              .figure = run->asked.options->figure, .region_column = run->asked.options->region_column,
                              .n_threads = run->report->threads};
}

/* Returns whether the worklist has a bad triangle left of x, where all blocks have run. Entries of the worklist are
 * judged again, because the id of a triangle may meanwhile belong to a good one. */
static bool is_work_left(const struct par_run *run, double x)
{
    const struct tri_mesh *mesh = run->mesh;
    const struct tri_criterion criterion = tri_criterion_for(mesh, &run->bounds);
    for (int32_t i = 0; i < run->worklist.n; i++) {
        const struct tri_triangle *t = &mesh->tri[run->worklist.item[i]];
        if (!tri_is_live(t) || mesh->xy[t->v[0]].x >= x || mesh->xy[t->v[1]].x >= x || mesh->xy[t->v[2]].x >= x)
            continue;
        const struct tri_shape shape = tri_shape_of(mesh->xy, t->v);
        if (tri_judge(&criterion, t, &shape) != TRI_GOOD)
            return true;
    }
    return false;
}

/* Hands out the tiles of an odd column. The even column of blocks to its right has been refined, so they are final. If
 * blocks left over work (*left), hands out nothing. */
static enum tri_status finish_column(struct par_run *run, struct par_tiles *tiles, int32_t column, bool *left,
                                     struct tri_error *error)
{
    double began = tri_seconds(), end = par_fence(tiles->partition, column, 0).x_max;
    *left = is_work_left(run, end);
    enum tri_status status = *left ? TRI_OK : par_park_expect(run->park, run->mesh, par_tiles_bytes(tiles), error);
    if (!status && !*left && run->remain.is_on)
        count_remain(run, end);
    if (!status && !*left)
        status = par_tiles_column(tiles, column, &run->spare, error);
    run->gone = tiles->n_triangles;
    run->report->seconds_number += tri_seconds() - began;
    return status;
}

/* The state of a sweep. */
struct sweep {
    struct par_run *run;    /* the run */
    struct par_tiles tiles; /* the tiles, and how many of them have been handed out */
    struct ahead ahead;     /* work for later columns */
    bool left;              /* blocks left over work, so the sweep must be abandoned */
};

/* Returns the odd column of blocks at the current position. */
static int32_t odd_column(const struct par_run *run) { return 2 * run->place.column - 1; }

/* Refines the blocks of an odd column (phases 0 and 1) or of the even column to its left (phases 2 and 3). */
static enum tri_status refine_column(void *self, struct tri_error *error)
{
    struct sweep *s = self;
    struct par_run *run = s->run;
    struct par_checkpoint *checkpoint = run->asked.options->checkpoint;
    const int32_t odd = odd_column(run);
    const struct par_turn turn = {.partition = s->tiles.partition, .only = run->place.phase < 2 ? odd : odd - 1};
    enum tri_status status = TRI_OK;
    if (run->place.next == PAR_COLUMN) {
        if (!merge_ahead(&s->ahead, run, odd))
            return no_memory(error);
        par_go(run, PAR_COLUMN_PHASE);
    }
    par_report_phase(run, run->place.phase + 1);
    if (turn.only < turn.partition->n_columns)
        status = checkpoint ? par_state_phase(checkpoint, run, turn, &s->tiles, error) : par_phase(run, &turn, error);
    run->place.phase += !status;
    return status;
}

/* Hands out the tiles of the previous odd column. *again: there is another column, and no work was left over. */
static enum tri_status end_column(void *self, bool *again, struct tri_error *error)
{
    struct sweep *s = self;
    struct par_run *run = s->run;
    struct par_checkpoint *checkpoint = run->asked.options->checkpoint;
    enum tri_status status = TRI_OK;
    *again = false;
    par_go(run, PAR_COLUMN);
    run->place.phase = 0;
    if (run->place.column > 1)
        status = finish_column(run, &s->tiles, odd_column(run) - 2, &s->left, error);
    if (status || s->left)
        return status;
    run->place.column++;
    *again = odd_column(run) <= s->tiles.partition->n_columns;
    return checkpoint && run->place.column > 2 ? par_state_border(checkpoint, run, &s->tiles, false, error) : TRI_OK;
}

/* Ends the stream of tiles. If the receiver of the tiles has failed, writes a state and returns its error. */
static enum tri_status end_tiles(struct par_run *run, struct par_tiles *tiles, struct tri_error *error)
{
    struct par_checkpoint *checkpoint = run->asked.options->checkpoint;
    enum tri_status status = par_tiles_end(tiles, error);
    return status || !checkpoint || !checkpoint->spool.failed ? status
                                                              : par_state_border(checkpoint, run, tiles, true, error);
}

/* Starts the stream of tiles. Sets the position to the first column, with an empty worklist, or restores position and
 * worklist from a checkpoint. */
static enum tri_status begin_sweep(struct par_run *run, struct par_tiles *tiles, struct ahead *ahead,
                                   struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    run->place.column = 0; /* stays 0 if there is no state */
    par_go(run, PAR_COLUMN);
    if (!list_ahead(ahead, run, tiles->partition))
        status = no_memory(error);
    else if (run->asked.options->checkpoint)
        status = par_state_begin_sweep(run->asked.options->checkpoint, run, tiles, error);
    else
        status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    run->remain.is_on = run->asked.options->count_remaining && (run->place.column == 0 || run->remain.is_on);
    if (status || run->place.column > 0)
        return status;
    run->place.column = 1;
    run->place.phase = run->worklist.n = 0;
    return run->remain.is_on && !begin_remain(run) ? no_memory(error) : TRI_OK;
}

enum tri_status par_sweep(struct par_run *run, const struct par_partition *partition, bool *done,
                          struct tri_error *error)
{
    static const struct par_steps steps = {refine_column, end_column};
    struct sweep s = {.run = run, .tiles = par_tiles_of(run, partition)};
    enum tri_status status = begin_sweep(run, &s.tiles, &s.ahead, error);
    if (!status && odd_column(run) <= partition->n_columns) /* false: resumed after the last column */
        status = par_run_rounds(run, &steps, &s, error);
    if (!status && !s.left)
        status = end_tiles(run, &s.tiles, error);
    if (!status && run->remain.is_on)
        report_remain(run);
    run->remain.is_on = false;
    run->place.column = 0;
    free_ahead(&s.ahead);
    if (!status && s.left && run->asked.options->checkpoint)
        status = par_state_give_up_sweep(run->asked.options->checkpoint, run, error);
    *done = !status && !s.left;
    if (!status)
        par_go(run, s.left ? PAR_BOUNDS_WHOLE : PAR_END);
    run->report->rounds++;
    run->report->deferred += run->report->total.fenced;
    par_forget_deferred(run->report);
    par_tiles_free(&s.tiles);
    return status;
}
