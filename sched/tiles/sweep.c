/* Columns in turn: refine, look for what is left behind, hand out. */
#include "sched/tiles/sweep.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/state.h"
#include "sched/tiles/park.h"
#include "triangle/base/clock.h"
#include "triangle/refine/census.h"

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the worklists of a sweep");
}

struct par_tiles par_tiles_of(const struct par_run *state, const struct par_partition *partition)
{
    return (struct par_tiles){.mesh = state->mesh, .partition = partition, .executor = &state->executor,
                              .n_kept = state->n_kept, .sink = state->options->sink,
                              .figure = state->options->figure, .region_column = state->options->region_column,
                              .n_threads = state->report->threads};
}

/* Something that no block could do lies left of x, where every block has had its turn. */
static bool is_left_behind(const struct par_run *state, double x)
{
    const struct tri_mesh *mesh = state->mesh;
    for (int32_t i = 0; i < state->worklist.n; i++) {
        const struct tri_triangle *t = &mesh->tri[state->worklist.item[i]];
        if (tri_is_live(t) && mesh->xy[t->v[0]].x < x && mesh->xy[t->v[1]].x < x && mesh->xy[t->v[2]].x < x)
            return true;
    }
    return false;
}

/* What is final goes: the tiles of a column, once the even column of blocks behind it is through. */
static enum tri_status finish_column(struct par_run *state, struct par_tiles *tiles, int32_t column, bool *left,
                                     struct tri_error *error)
{
    double began = tri_seconds(), end = par_fence(tiles->partition, column, 0).x_max;
    *left = is_left_behind(state, end);
    enum tri_status status = *left ? TRI_OK : par_park_expect(state->park, state->mesh, par_tiles_bytes(tiles), error);
    if (!status && !*left && state->counts_remaining)
        par_remain_count(state, end);
    if (!status && !*left)
        status = par_tiles_column(tiles, column, &state->spare, error);
    state->gone = tiles->n_triangles;
    state->report->seconds_number += tri_seconds() - began;
    return status;
}

static enum tri_status refine_column(struct par_run *state, struct par_tiles *tiles, int32_t column,
                                     struct tri_error *error)
{
    struct par_checkpoint *checkpoint = state->options->checkpoint;
    return checkpoint ? par_state_phase(checkpoint, state, tiles->partition, tiles, column, error)
                      : par_phase(state, tiles->partition, state->phase, column, error);
}

/* The odd column of blocks that is the state's. */
static int32_t odd_column(const struct par_run *state) { return 2 * state->column - 1; }

/* The blocks of an odd column, and those of the even one behind it, from state->phase on. */
static enum tri_status refine_columns(struct par_run *state, struct par_tiles *tiles, struct tri_error *error)
{
    const int32_t odd = odd_column(state);
    enum tri_status status = TRI_OK;
    for (; !status && state->phase < PAR_PHASES; state->phase += !status) {
        int32_t column = state->phase < 2 ? odd : odd - 1;
        par_tell(state, state->phase + 1);
        if (column < tiles->partition->n_columns)
            status = refine_column(state, tiles, column, error);
    }
    return status;
}

/* A column from its beginning, or from where the state is amid it. */
static enum tri_status go_through(struct par_run *state, struct par_tiles *tiles, const struct par_ahead *ahead,
                                  struct tri_error *error)
{
    if (state->next != PAR_COLUMN_PHASE && !par_ahead_give(ahead, state, odd_column(state)))
        return no_memory(error);
    state->next = PAR_COLUMN_PHASE;
    enum tri_status status = refine_columns(state, tiles, error);
    if (status)
        return status;
    state->next = PAR_COLUMN;
    state->phase = 0;
    return TRI_OK;
}

/* Nobody is stopped any more, but the tiles' taker may have failed. */
static enum tri_status end_tiles(struct par_run *state, struct par_tiles *tiles, struct tri_error *error)
{
    struct par_checkpoint *checkpoint = state->options->checkpoint;
    enum tri_status status = par_tiles_end(tiles, error);
    return status || !checkpoint || !checkpoint->spool.failed ? status
                                                              : par_state_border(checkpoint, state, tiles, true, error);
}

/* From the state's column on, until something is left behind. */
static enum tri_status sweep_columns(struct par_run *state, struct par_tiles *tiles, const struct par_ahead *ahead,
                                     bool *left, struct tri_error *error)
{
    struct par_checkpoint *checkpoint = state->options->checkpoint;
    enum tri_status status = TRI_OK;
    while (!status && !*left && odd_column(state) <= tiles->partition->n_columns) {
        status = go_through(state, tiles, ahead, error);
        if (!status && state->column > 1)
            status = finish_column(state, tiles, odd_column(state) - 2, left, error);
        if (status || *left)
            break;
        state->column++;
        if (checkpoint && state->column > 2)
            status = par_state_border(checkpoint, state, tiles, false, error);
    }
    return status || *left ? status : end_tiles(state, tiles, error);
}

/* The state is of its first column, for which the worklist is empty; or as a checkpoint has it. */
static enum tri_status begin_sweep(struct par_run *state, struct par_tiles *tiles, struct par_ahead *ahead,
                                   struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    state->column = 0; /* unless there is a state */
    state->n_columns = (tiles->partition->n_columns + 1) / 2;
    if (!par_ahead_make(ahead, state, tiles->partition))
        status = no_memory(error);
    else if (state->options->checkpoint)
        status = par_state_begin_sweep(state->options->checkpoint, state, tiles, error);
    else
        status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    state->counts_remaining = state->options->count_remaining && (state->column == 0 || state->counts_remaining);
    if (status || state->column > 0)
        return status;
    state->next = PAR_COLUMN;
    state->column = 1;
    state->phase = state->worklist.n = 0;
    return state->counts_remaining && !par_remain_begin(state) ? no_memory(error) : TRI_OK;
}

enum tri_status par_sweep(struct par_run *state, const struct par_partition *partition, bool *done,
                          struct tri_error *error)
{
    struct par_tiles tiles = par_tiles_of(state, partition);
    struct par_ahead ahead;
    bool left = false;
    enum tri_status status = begin_sweep(state, &tiles, &ahead, error);
    status = status ? status : sweep_columns(state, &tiles, &ahead, &left, error);
    if (!status && state->counts_remaining)
        par_remain_settle(state);
    state->counts_remaining = false;
    state->next = PAR_BOUNDS;
    state->column = state->n_columns = 0;
    par_ahead_free(&ahead);
    if (!status && left && state->options->checkpoint)
        status = par_state_give_up_sweep(state->options->checkpoint, state, error);
    *done = !status && !left;
    state->report->rounds++;
    state->report->deferred += state->report->total.fenced;
    par_forget_deferred(state->report);
    par_tiles_free(&tiles);
    return status;
}

/* --- A counting sort by column. */

/* The number of the first odd column that reaches beyond x: column 2 i + 1. */
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

static double right_end(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    double a = mesh->xy[v[0]].x, b = mesh->xy[v[1]].x, c = mesh->xy[v[2]].x;
    double most = a > b ? a : b;
    return most > c ? most : c;
}

bool par_ahead_make(struct par_ahead *ahead, const struct par_run *state, const struct par_partition *partition)
{
    const struct par_ids *list = &state->worklist;
    int32_t n_odd = (partition->n_columns - 1) / 2;
    size_t n = (size_t)list->n + 1;
    assert(state->key.n == 0);
    *ahead = (struct par_ahead){malloc(n * sizeof *ahead->item), malloc(n * sizeof *ahead->key),
                                calloc((size_t)n_odd + 2, sizeof *ahead->start), n_odd};
    int32_t *column = malloc(n * sizeof *column), *start = ahead->start;
    bool memory = ahead->item && ahead->key && start && column;
    for (int32_t i = 0; memory && i < list->n; i++) {
        column[i] = column_beyond(partition, right_end(state->mesh, list->item[i]), n_odd);
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

void par_ahead_free(struct par_ahead *ahead)
{
    free(ahead->item);
    free(ahead->key);
    free(ahead->start);
    *ahead = (struct par_ahead){0};
}

bool par_ahead_give(const struct par_ahead *ahead, struct par_run *state, int32_t odd)
{
    int32_t i = odd / 2;
    if (i >= ahead->n_odd)
        return true;
    int32_t first = ahead->start[i];
    return par_merge_worklist(state, ahead->item + first, ahead->key + first, ahead->start[i + 1] - first);
}

/* --- A list of triangles that have been given up, looked through once for each column. */

/* Reasons that name the schedule: nothing is deferred where no block leaves anything. */
static struct tri_refine_report report_of(const struct par_run *state)
{
    struct tri_refine_report report = state->report->total;
    report.gated = report.fenced = 0;
    return report;
}

bool par_remain_begin(struct par_run *state)
{
    struct par_ids *list = &state->remaining;
    tri_triangle_id *found = malloc(((size_t)state->mesh->n_triangles + 1) * sizeof *found);
    const int32_t n = found ? tri_find_hopeless(state->mesh, state->quality, found) : 0;
    list->n = 0;
    bool memory = found && par_ids_add_all(list, found, n);
    free(found);
    memset(state->remained, 0, sizeof state->remained);
    return memory;
}

static bool has_corner_left_of(const struct tri_mesh *mesh, tri_triangle_id t, double x)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    return mesh->xy[v[0]].x < x || mesh->xy[v[1]].x < x || mesh->xy[v[2]].x < x;
}

/* Those to come stay in front, those to count go behind them, and are counted by one call. */
void par_remain_count(struct par_run *state, double x)
{
    const struct tri_mesh *mesh = state->mesh;
    const struct tri_refine_report report = report_of(state);
    struct par_ids *list = &state->remaining;
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
    tri_count_bad_among(mesh, state->quality, &report, list->item + kept, live - kept, state->remained);
    list->n = kept;
}

void par_remain_settle(struct par_run *state)
{
    const struct tri_refine_report report = report_of(state);
    tri_settle_counts(&report, state->remained, state->report->remain);
    state->report->remain_known = true;
}

void par_remain_count_all(struct par_run *state)
{
    const struct tri_refine_report report = report_of(state);
    tri_count_bad(state->mesh, state->quality, &report, &state->executor, state->report->remain);
    state->report->remain_known = true;
}
