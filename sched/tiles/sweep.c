/* Columns in turn: refine, look for what is left behind, hand out. */
#include "sched/tiles/sweep.h"

#include "sched/checkpoint/state.h"
#include "sched/tiles/ahead.h"
#include "sched/tiles/park.h"
#include "sched/tiles/remain.h"
#include "triangle/base/system.h"

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
