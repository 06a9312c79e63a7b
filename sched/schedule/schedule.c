/* The schedule: pre-refinement, rounds of four phases, what is left over.
 *
 * Levels. The pre-refinement of a large mesh is itself large; it is then refined by the same schedule, with a coarser
 * one before it, and so on until a level is small enough for one sequential call. */
#include "sched/schedule/schedule.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/checkpoint/state.h"
#include "sched/ranks/ranks.h"
#include "sched/schedule/by_tile.h"
#include "sched/schedule/cells.h"
#include "sched/schedule/phase.h"
#include "sched/schedule/prerefine.h"
#include "sched/schedule/theory.h"
#include "sched/schedule/threads.h"
#include "sched/tiles/numbering.h"
#include "sched/tiles/park.h"
#include "sched/tiles/sweep.h"
#include "sched/tunables.h"
#include "triangle/base/clock.h"
#include "triangle/base/size_text.h"
#include "triangle/mesh/surface.h"
#include "triangle/refine/census.h"
#include "triangle/size/estimate.h"

struct par_options par_defaults(void) { return (struct par_options){0}; }

static enum tri_status refine_level(struct par_run *state, const struct tri_quality *quality, int level,
                                    struct tri_error *error);

static enum tri_status prerefine_uniform(struct par_run *state, const struct tri_quality *quality,
                                         double cell, int level, struct tri_error *error)
{
    struct tri_quality coarse = par_coarse_bounds(quality, cell);
    bool is_told = level == 0 && !state->report->partition.x; /* of the first schedule, see report_schedule */
    if (is_told && coarse.min_angle > 0 && quality->max_area > 0) {
        double area = quality->max_area * coarse.area_scale;
        state->report->radius_lemma7 = par_radius_lemma7(area, par_rho(coarse.min_angle));
        state->report->radius_theory = par_radius_tight(area, coarse.min_angle);
    }
    return refine_level(state, &coarse, level + 1, error);
}

/* Ranks keep states of their own. */
static struct par_checkpoint *checkpoint_of(const struct par_run *state)
{
    return state->options->carrier ? NULL : state->options->checkpoint;
}

/* One sequential call of the same loop, for what the worklist holds (all: for the whole mesh). */
static enum tri_status refine_rest(struct par_run *state, const struct tri_quality *quality, bool all,
                                   struct tri_error *error)
{
    struct tri_refine_hooks hooks = par_hooks(state);
    struct tri_refine_report report = {0};
    struct tri_refiner *refiner = NULL;
    if (!all) {
        hooks.worklist = state->worklist.item;
        hooks.n_worklist = state->worklist.n;
        if (state->worklist.n == 0)
            return TRI_OK;
    }
    enum tri_status status = tri_refiner_new(&refiner, state->mesh, quality, &hooks, &report, error);
    status = status ? status : tri_refiner_run(refiner, error);
    tri_refiner_free(refiner);
    assert(tri_mesh_is_sound(state->mesh));
    par_add_up(&state->report->total, &report);
    return status;
}

/* How long stages work in shares: the executor of a struct par_run. */
struct timed {
    struct tri_executor executor;
    double *seconds; /* [PAR_SHARINGS] */
};

_Static_assert(1 << (PAR_SHARINGS - 1) == TRI_MOST_SHARES, "the last ones have most shares");

static void run_timed(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context)
{
    const struct timed *timed = self;
    double began = tri_seconds();
    int sharing = 0;
    while (sharing + 1 < PAR_SHARINGS && n_tasks >> (sharing + 1) > 0)
        sharing++;
    timed->executor.run(timed->executor.self, n_tasks, task, context);
    timed->seconds[sharing] += tri_seconds() - began;
}

/* Numbers that depend on the mesh alone; what is free in its arrays is gone then. */
static enum tri_status number_mesh(struct par_run *state, struct tri_error *error)
{
    const struct timed *timed = state->executor.self; /* what it does in shares is told as numbering */
    double began = tri_seconds();
    par_tell(state, PAR_NUMBERING);
    enum tri_status status = par_park_expect(state->park, state->mesh, par_number_bytes(state->mesh), error);
    status = status ? status : par_number(state->mesh, &state->cells, state->n_kept, &timed->executor, error);
    assert(status || (state->mesh->n_vertices >= state->n_kept && tri_mesh_is_sound(state->mesh)));
    state->end = PAR_NUMBERED;
    state->report->seconds_number += tri_seconds() - began;
    return status;
}

/* Closes the gaps that blocks have left unused, by numbering if it is due now. Triangles move. */
static enum tri_status leave_no_gaps(struct par_run *state, bool numbering, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    double began = tri_seconds();
    if (numbering) {
        par_room_mark(&state->spare, state->mesh, &state->executor);
        state->report->seconds_merge += tri_seconds() - began;
        status = number_mesh(state, error);
        if (!status) {
            par_room_free(&state->spare);
            return status;
        }
        began = tri_seconds();
    }
    par_room_close(&state->spare, state->mesh, &state->executor);
    assert(tri_mesh_is_sound(state->mesh));
    state->report->seconds_merge += tri_seconds() - began;
    return status;
}

/* Between two steps of what cannot be undone: a state may be kept here. */
static enum tri_status come_to_border(struct par_run *state, struct tri_error *error)
{
    struct par_checkpoint *checkpoint = checkpoint_of(state);
    return checkpoint ? par_state_border(checkpoint, state, NULL, false, error) : TRI_OK;
}

/* What comes now may be stopped, though not all that has been done is in a state. */
static void let_stop(struct par_run *state)
{
    if (checkpoint_of(state))
        par_state_let_stop(checkpoint_of(state), state);
}

/* Of the whole mesh a state may be kept between any two blocks. */
static enum tri_status run_phase(struct par_run *state, const struct par_partition *partition,
                                 struct tri_error *error)
{
    struct par_checkpoint *checkpoint = par_is_phase(state->next) ? checkpoint_of(state) : NULL;
    return checkpoint ? par_state_phase(checkpoint, state, partition, NULL, TRI_NONE, error)
                      : par_phase(state, partition, state->phase, TRI_NONE, error);
}

static enum tri_status run_phases(struct par_run *state, const struct par_partition *partition,
                                  struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (; !status && state->phase < PAR_PHASES && state->worklist.n > 0; state->phase++) {
        status = par_is_phase(state->next) ? come_to_border(state, error) : TRI_OK;
        par_tell(state, state->phase + 1);
        status = status ? status : run_phase(state, partition, error);
    }
    return status;
}

/* Rounds of four phases, from state->round and phase on, until nothing is left to do, each round on blocks four times
 * as large. */
static enum tri_status run_rounds(struct par_run *state, struct par_partition *partition, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    assert(par_cells(partition) >= 4);
    for (; !status && state->round < PAR_MOST_ROUNDS; state->round++) {
        status = run_phases(state, partition, error);
        state->phase = 0;
        state->report->rounds++;
        if (state->worklist.n == 0 || !par_can_coarsen(partition))
            break;
        par_partition_coarsen(partition);
    }
    state->report->deferred += state->report->total.fenced; /* finish_schedule clears it in the total */
    return status;
}

static enum tri_status refine_on_ranks(struct par_run *state, const struct par_partition *partition,
                                       struct tri_error *error)
{
    struct par_tiles tiles = par_tiles_of(state, partition);
    enum tri_status status = par_refine_on_ranks(state, partition, &tiles, error);
    state->end = PAR_DELIVERED;
    par_tiles_free(&tiles);
    return status;
}

/* Would the whole mesh be too large for memory, or for one mesh? */
static bool is_too_much(const struct par_run *state, double triangles)
{
    const struct par_options *options = state->options;
    return options->sink && !options->carrier &&
           (options->sweep || triangles > PAR_SURELY_ONE_MESH * TRI_MAX_TRIANGLES ||
            (options->memory > 0 && triangles * PAR_BYTES_IN_MEMORY > (double)options->memory));
}

static void note_size(struct par_run *state)
{
    struct par_report *report = state->report;
    report->most_live = state->mesh->n_triangles > report->most_live ? state->mesh->n_triangles : report->most_live;
}

/* What a sweep that cannot go on has to be undone with. */
struct before {
    struct tri_mesh mesh;
    struct par_ids worklist;
    struct par_report report;
};

static enum tri_status remember(const struct par_run *state, struct before *before, struct tri_error *error)
{
    *before = (struct before){.report = *state->report};
    if (!par_ids_add_all(&before->worklist, state->worklist.item, state->worklist.n))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the worklist");
    return tri_mesh_copy(&before->mesh, state->mesh, error);
}

/* The mesh as it was, and the worklist. What the sink has taken it forgets when it is told of the beginning again. */
static void go_back(struct par_run *state, struct before *before)
{
    struct par_ids worklist = state->worklist;
    struct par_report *report = state->report;
    int64_t live = report->most_live;
    tri_mesh_swap(state->mesh, &before->mesh);
    state->worklist = before->worklist;
    before->worklist = worklist;
    state->key.n = 0;
    state->gone = 0;
    par_room_free(&state->spare);
    before->report.blocks = report->blocks; /* they may have moved */
    before->report.block_capacity = report->block_capacity;
    *report = before->report;
    report->most_live = live;
}

/* *done: the mesh has been handed out, and is gone. Else everything is as before. */
static enum tri_status try_to_sweep(struct par_run *state, const struct par_partition *partition, bool *done,
                                    struct tri_error *error)
{
    struct before before;
    enum tri_status status = remember(state, &before, error);
    state->n_schedules++;
    state->round = 0;
    status = status ? status : par_sweep(state, partition, done, error);
    note_size(state);
    if (!status && !*done) {
        go_back(state, &before);
        state->n_schedules--;
    }
    free(before.worklist.item);
    tri_mesh_drop(&before.mesh);
    return status;
}

static enum tri_status fail_without_scratch(const struct par_run *state, double triangles, struct tri_error *error)
{
    return tri_fail(error, TRI_TOO_LARGE, NULL, 0,
                    "about %s are asked for and there are %s: a mesh like this needs a scratch directory",
                    tri_size_text(PAR_BYTES_IN_MEMORY * triangles).text,
                    tri_size_text((double)state->options->memory).text);
}

/* The whole mesh does not fit in memory: it is swept where nothing comes after this schedule and the sink can begin
 * again. If that leaves something over, or cannot be, it moves to files as it grows. */
static enum tri_status leave_memory(struct par_run *state, const struct par_partition *partition,
                                    struct tri_error *error)
{
    const struct par_options *options = state->options;
    enum tri_status status = TRI_OK;
    bool can_sweep = state->may_number && (options->sink->begin || !options->scratch);
    bool swept = false;
    state->stays = true;
    if (can_sweep)
        status = try_to_sweep(state, partition, &swept, error);
    if (swept) {
        state->report->way = PAR_SWEPT;
        state->end = PAR_DELIVERED;
    }
    if (status || swept)
        return status;
    if (!options->scratch)
        return fail_without_scratch(state, partition->estimate, error);
    return tri_refine_check(state->mesh, state->quality, &state->executor, error);
}

/* What no block could do, and what blocks have left unused. */
static enum tri_status finish_schedule(struct par_run *state, const struct tri_quality *quality, bool top,
                                       enum tri_status status, struct tri_error *error)
{
    double last = tri_seconds();
    if (!status && state->worklist.n > 0) { /* in the order of the worklist, which ids do not show in */
        if (top)
            state->next = state->next < PAR_BOUNDS ? PAR_SIZES_REST : PAR_BOUNDS_REST;
        status = top ? come_to_border(state, error) : TRI_OK;
        par_room_mark(&state->spare, state->mesh, &state->executor);
        status = status ? status : refine_rest(state, quality, false, error);
    }
    state->worklist.n = state->key.n = 0;
    state->report->seconds_last += tri_seconds() - last;
    enum tri_status closed = leave_no_gaps(state, !status && top && state->may_number, error);
    par_forget_deferred(state->report);
    return status ? status : closed;
}

/* What is told of the first schedule of the whole mesh. */
static enum tri_status report_schedule(struct par_run *state, const struct par_partition *partition,
                                       struct tri_error *error)
{
    struct par_report *report = state->report;
    if (report->partition.x)
        return TRI_OK;
    report->schedule = state->n_schedules;
    report->columns = partition->n_columns;
    report->rows = partition->n_rows;
    report->radius_measured = state->radius * state->mesh->unit;
    report->prerefined = state->mesh->n_triangles;
    return par_partition_copy(&report->partition, partition, error);
}

/* top: the mesh is the whole one, not what comes before its schedule. */
static enum tri_status run_and_finish(struct par_run *state, const struct tri_quality *quality,
                                      struct par_partition *partition, bool top, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (!par_is_rest(state->next)) {
        status = run_rounds(state, partition, error);
        note_size(state);
        if (top)
            state->report->left_over += state->worklist.n;
    }
    return finish_schedule(state, quality, top, status, error);
}

/* The phases of one level, on a mesh that has been pre-refined, and what is bad in it. */
static enum tri_status run_schedule(struct par_run *state, const struct tri_quality *quality,
                                    struct par_partition *partition, bool top, struct tri_error *error)
{
    enum tri_status status = top ? report_schedule(state, partition, error) : TRI_OK;
    state->quality = quality;
    if (!status && top) {
        par_partition_free(&state->cells);
        status = par_partition_copy(&state->cells, partition, error);
    }
    if (!status && top && (state->may_number || state->then) && state->options->sink && state->options->carrier)
        status = refine_on_ranks(state, partition, error);
    else if (!status && top && !state->stays && is_too_much(state, partition->estimate))
        status = leave_memory(state, partition, error);
    if (status || state->end == PAR_DELIVERED)
        return status;
    state->n_schedules++;
    state->round = state->phase = 0;
    if (top)
        state->next = state->next < PAR_BOUNDS ? PAR_SIZES_PHASE : PAR_BOUNDS_PHASE;
    return run_and_finish(state, quality, partition, top, error);
}

/* From where a checkpoint's state is, in the phases of a schedule. */
static enum tri_status go_on(struct par_run *state, const struct tri_quality *quality,
                             struct tri_error *error)
{
    struct par_partition partition;
    enum tri_status status = par_partition_copy(&partition, &state->cells, error);
    if (status)
        return status;
    for (int round = 0; round < state->round; round++)
        par_partition_coarsen(&partition);
    state->quality = quality;
    status = run_and_finish(state, quality, &partition, true, error);
    par_partition_free(&partition);
    return status;
}

static double cell_size(const struct par_run *state, double estimate)
{
    return state->options->cell_triangles > 0 ? state->options->cell_triangles : par_triangles_in_cell(estimate);
}

/* The schedule on one level, after a pre-refinement. */
static enum tri_status schedule_level(struct par_run *state, const struct tri_quality *quality, int level,
                                      double estimate, double cell, struct tri_error *error)
{
    struct par_partition partition;
    double began = tri_seconds();
    enum tri_status status = par_partition_make(&partition, state->mesh, quality, estimate, cell, &state->executor,
                                                error);
    state->report->seconds_partition += tri_seconds() - began;
    if (status)
        return status;
    state->report->levels = level + 1 > state->report->levels ? level + 1 : state->report->levels;
    state->level = level;
    par_tell(state, 0);
    if (par_areas_decide(state, quality, estimate, cell)) {
        status = prerefine_uniform(state, quality, cell, level, error);
        began = tri_seconds();
        status = status ? status : par_fill_worklist(state, quality, false, error);
        state->report->seconds_find += tri_seconds() - began;
    } else {
        status = par_prerefine_graded(state, quality, &partition, error);
    }
    state->level = level; /* again */
    if (!status)
        status = run_schedule(state, quality, &partition, level == 0, error);
    par_partition_free(&partition);
    return status;
}

static double estimate_of(struct par_run *state, const struct tri_quality *quality, double *sure)
{
    double began = tri_seconds(), estimate = tri_estimate(state->mesh, quality, &state->executor, sure);
    state->report->seconds_partition += tri_seconds() - began;
    return estimate;
}

/* The first points of a sequential call, as many as would make this many triangles; *done: they were enough. */
static enum tri_status refine_a_little(struct par_run *state, const struct tri_quality *quality,
                                       double triangles, bool *done, struct tri_error *error)
{
    struct tri_quality options = *quality;
    struct tri_refine_report report;
    double began = tri_seconds();
    options.max_steiner = (int64_t)(triangles / 2);
    const struct tri_refine_hooks hooks = par_hooks(state);
    enum tri_status status = tri_refine_with(state->mesh, &options, &hooks, &report, error);
    *done = !report.hit_limit;
    if (*done)
        par_add_up(&state->report->total, &report);
    else /* the schedule meets the triangles again that the limit left */
        par_add_points(&state->report->total, &report);
    state->report->seconds_prerefine += tri_seconds() - began;
    return status;
}

/* Refines to these bounds: sequentially if the work is little, else by the schedule. What areas and the triangles that
 * there are ask for is known; what angles ask for is a guess, which small parts of a mesh may spoil by orders of
 * magnitude. Where the guess alone says that there is much work, a little of it is done first: that may be all, and
 * what then remains is guessed better. */
static enum tri_status refine_level(struct par_run *state, const struct tri_quality *quality, int level,
                                    struct tri_error *error)
{
    double sure, estimate = estimate_of(state, quality, &sure), cell = cell_size(state, estimate);
    double large = cell * (level == 0 ? PAR_FEWEST_CELLS : PAR_FEWEST_COARSE_CELLS);
    if (estimate >= large && sure < large) {
        bool done;
        enum tri_status status = refine_a_little(state, quality, large * PAR_A_LITTLE, &done, error);
        if (status || done)
            return status;
        estimate = estimate_of(state, quality, &sure);
        cell = cell_size(state, estimate);
    }
    if (estimate >= cell * (level == 0 ? PAR_FEWEST_CELLS : PAR_FEWEST_COARSE_CELLS))
        return schedule_level(state, quality, level, estimate, cell, error);
    double began = tri_seconds();
    enum tri_status status = refine_rest(state, quality, true, error);
    *(level > 0 ? &state->report->seconds_prerefine : &state->report->seconds_last) += tri_seconds() - began;
    return status;
}

/* The schedule behind that for sizes, on its cells: on ranks each has its part of the mesh by now, and nobody could cut
 * the whole of it anew. Triangles hardly larger than a share of a cell need no coarse mesh before. */
static enum tri_status refine_again(struct par_run *state, const struct tri_quality *quality,
                                    struct tri_error *error)
{
    struct par_partition partition;
    double began = tri_seconds(), sure;
    if (!state->stays && !state->options->scratch && state->options->memory > 0) {
        double estimate = estimate_of(state, quality, &sure);
        if (is_too_much(state, estimate))
            return fail_without_scratch(state, estimate, error);
    }
    enum tri_status status = par_partition_copy(&partition, &state->cells, error);
    if (status)
        return status;
    status = par_fill_worklist(state, quality, false, error);
    if (!status)
        status = par_park_expect(state->park, state->mesh, par_order_bytes(&state->worklist), error);
    if (!status && !par_order_by_tile(state, &partition, 0, par_blocks(&partition)))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)state->worklist.n);
    state->report->seconds_find += tri_seconds() - began;
    if (!status)
        status = run_schedule(state, quality, &partition, true, error);
    par_partition_free(&partition);
    return status;
}

/* From its beginning, or from where the state is in its schedule. */
static enum tri_status refine_to(struct par_run *state, const struct tri_quality *quality,
                                 struct tri_error *error)
{
    if (par_is_phase(state->next) || par_is_rest(state->next))
        return go_on(state, quality, error);
    return state->cells.x ? refine_again(state, quality, error) : refine_level(state, quality, 0, error);
}

/* Triangles of different sizes meet everywhere in a mesh that comes out of a coarse one by stages. So where areas
 * decide on sizes these are brought about first, with an easy bound, and then the angles on a mesh of one size.
 * (Measured on letter.poly, 33 degrees: 2% more triangles than by one sequential call, instead of 28%.) */
static enum tri_status refine_sizes_first(struct par_run *state, const struct tri_quality *quality,
                                          struct tri_error *error)
{
    struct tri_quality easy = *quality;
    easy.min_angle = TRI_SIZES_ANGLE;
    enum tri_status status = refine_to(state, &easy, error);
    state->next = PAR_BOUNDS;
    return status || state->end == PAR_DELIVERED ? status : come_to_border(state, error);
}

/* What a schedule cannot do, one call does. */
static bool must_be_sequential(const struct tri_quality *quality, const struct par_options *options)
{
    const bool is_tied = options->hooks && (options->hooks->gate || options->hooks->fence);
    return quality->max_steiner >= 0 || is_tied || (quality->unsuitable && !options->size_test_in_parallel);
}

/* Refines by schedules: two where angles are dear. */
static enum tri_status refine_by_schedule(struct par_run *state, const struct tri_quality *quality,
                                          struct tri_error *error)
{
    struct tri_quality usual = *quality;
    usual.min_angle = tri_worked_angle(quality);
    if (!state->sizes_first && state->next == PAR_SIZES)
        state->next = PAR_BOUNDS;
    const bool may_number = !state->options->by_block;
    state->then = may_number ? &usual : NULL;
    enum tri_status status = state->next < PAR_BOUNDS ? refine_sizes_first(state, &usual, error) : TRI_OK;
    state->then = NULL;
    state->may_number = may_number;
    if (!status && state->end != PAR_DELIVERED && state->next != PAR_HAND_OUT)
        status = refine_to(state, &usual, error);
    return status;
}

/* Hands out a mesh that is finished, tile by tile if it is numbered. */
static enum tri_status hand_out(struct par_run *state, struct tri_error *error)
{
    struct par_tiles tiles = par_tiles_of(state, state->end == PAR_NUMBERED ? &state->cells : NULL);
    enum tri_status status = par_park_expect(state->park, state->mesh, par_tiles_whole_bytes(&tiles), error);
    if (status)
        return status;
    tri_surface_settle(state->mesh, &state->executor);
    if (state->options->count_remaining && !state->options->carrier)
        par_remain_count_all(state);
    if (state->options->carrier)
        return par_whole_on_ranks(state->options->carrier, &tiles, error);
    status = par_tiles_whole(&tiles, error);
    if (status && state->options->checkpoint) /* what there is of the mesh is kept, whether that can be or not */
        (void)par_state_border(state->options->checkpoint, state, NULL, true, NULL);
    return status;
}

/* Numbers, and hands out, what has not gone yet. */
static enum tri_status deliver(struct par_run *state, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    if (state->end == PAR_DELIVERED)
        return TRI_OK;
    if (state->report->levels > 0 && !state->options->by_block && state->end != PAR_NUMBERED)
        status = number_mesh(state, error);
    state->next = PAR_HAND_OUT;
    status = status ? status : come_to_border(state, error);
    let_stop(state);
    return !status && state->options->sink ? hand_out(state, error) : status;
}

/* A bound on memory that somebody keeps: a sink without a scratch directory gets a sweep and no more. */
static bool is_bounded(const struct par_options *options)
{
    return options->memory > 0 && (options->scratch || !options->sink);
}

static void clean_up(struct par_run *state)
{
    struct par_report *report = state->report;
    report->parked = state->park ? par_park_bytes(state->park) : 0;
    if (report->parked > 0 && report->way == PAR_IN_MEMORY)
        report->way = PAR_PARKED;
    let_stop(state);
    if (state->options->park)
        *state->options->park = state->park;
    else
        par_park_close(state->park, state->mesh);
    if (state->end == PAR_DELIVERED || (report->way != PAR_IN_MEMORY && !state->options->park))
        tri_mesh_drop(state->mesh);
    free(state->worklist.item);
    free(state->key.item);
    free(state->remaining.item);
    free(state->done.item);
    par_partition_free(&state->cells);
    par_room_free(&state->spare);
}

/* By a schedule or by one call; and to the sink. */
static enum tri_status refine_and_deliver(struct par_run *state, const struct tri_quality *quality,
                                          bool sequential, struct tri_error *error)
{
    double began = tri_seconds();
    enum tri_status status = TRI_OK;
    if (!sequential)
        status = refine_by_schedule(state, quality, error);
    else if (state->next != PAR_HAND_OUT)
        status = refine_rest(state, quality, true, error);
    if (sequential)
        state->report->seconds_last += tri_seconds() - began;
    state->quality = quality; /* all that was asked for */
    return status ? status : deliver(state, error);
}

/* On several ranks: they would wait for each other where they do not make the same mesh. */
static enum tri_status check_ranks(const struct par_run *state, enum tri_status status, struct tri_error *error)
{
    struct par_carrier *carrier = state->options->carrier;
    if (!carrier)
        return status;
    return par_expect_same(carrier, status ? 0 : par_state_run(state),
                           "the ranks do not begin with the same figure and settings", status, error);
}

enum tri_status par_refine(struct tri_mesh *mesh, const struct tri_quality *quality,
                           const struct par_options *options, struct par_report *report, struct tri_error *error)
{
    double began = tri_seconds();
    assert(tri_mesh_is_sound(mesh));
    assert(!options->park || !options->sink);
    const bool alone = tri_asks_caller(quality) && !options->size_test_in_parallel;
    *report = (struct par_report){.threads = par_threads(alone ? 1 : options->threads, false)};
    if (options->park)
        *options->park = NULL;
    struct timed timed = {par_executor(&report->threads), report->seconds_shared};
    struct par_run state = {.mesh = mesh, .quality = quality, .options = options, .report = report,
                              .executor = {run_timed, &timed},
                              .n_kept = mesh->n_vertices};
    bool sequential = must_be_sequential(quality, options);
    bool can_sweep = options->sink && !sequential && quality->min_angle <= TRI_EASY_ANGLE;
    enum tri_status status = tri_refine_prepare(mesh, &state.executor, error);
    status = status || can_sweep ? status : tri_refine_check(mesh, quality, &state.executor, error);
    status = check_ranks(&state, status, error);
    if (!status && is_bounded(options))
        status = par_park_open(&state.park, mesh, options->sink || options->park ? options->scratch : NULL,
                               options->memory, error);
    if (status)
        return status;
    if (state.park)
        timed.executor = par_park_executor(state.park, timed.executor);
    /* Of the mesh as it came: a run that goes on from a checkpoint decides the same. */
    state.sizes_first = !sequential && tri_sizes_come_first(mesh, quality, &state.executor);
    if (checkpoint_of(&state))
        status = par_state_begin(options->checkpoint, &state, error);
    status = status ? status : refine_and_deliver(&state, quality, sequential, error);
    if (!options->sink)
        tri_surface_settle(mesh, &state.executor);
    status = par_park_status(state.park, status, error);
    clean_up(&state);
    assert(options->sink || tri_mesh_is_sound(mesh));
    report->seconds_total = tri_seconds() - began;
    return status;
}
