/* The four-phase schedule (Chernikov and Chrisochoides, ICS 2004), for any PSLG.
 *
 * ALGORITHM. Make a coarse mesh (section 2.3.3), and cut cells from it (2.3.4). Then run rounds of four phases; each
 * phase refines disjoint blocks of cells concurrently, and each round has blocks four times as large. One sequential
 * call treats what remains. If the coarse mesh is itself large, it is made by the same schedule, one level up. If
 * angles are expensive, all of this is done for sizes first, then for all bounds. next.h lists the steps.
 *
 * INVARIANT. Between phases the mesh is a constrained Delaunay triangulation, apart from unused places (loop invariant
 * 1 of the paper, section 2.3.1), and the worklist holds each bad triangle that has not been given up. */
#include "sched/schedule/schedule.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/checkpoint/state.h"
#include "sched/ranks/ranks.h"
#include "sched/schedule/phase.h"
#include "sched/schedule/prerefine.h"
#include "sched/schedule/smoothing.h"
#include "sched/schedule/threads.h"
#include "sched/tiles/numbering.h"
#include "sched/tiles/park.h"
#include "sched/tiles/sweep.h"
#include "sched/tunables.h"
#include "triangle/base/system.h"
#include "triangle/base/size_text.h"
#include "triangle/mesh/surface.h"
#include "triangle/refine/census.h"
#include "triangle/refine/smooth.h"
#include "triangle/size/estimate.h"

struct par_options par_defaults(void) { return (struct par_options){0}; }

static enum tri_status refine_level(struct par_run *run, const struct tri_quality *quality, int level,
                                    struct tri_error *error);

static enum tri_status prerefine_uniform(struct par_run *run, const struct tri_quality *quality,
                                         double cell, int level, struct tri_error *error)
{
    struct tri_quality coarse = par_coarse_bounds(quality, cell);
    bool is_reported = level == 0 && !run->report->partition.x; /* true for the first schedule, as in report_schedule */
    if (is_reported && coarse.min_angle > 0 && quality->max_area > 0) {
        double area = quality->max_area * coarse.area_scale;
        run->report->radius_lemma7 = par_radius_lemma7(area, par_rho(coarse.min_angle));
        run->report->radius_theory = par_radius_tight(area, coarse.min_angle);
    }
    return refine_level(run, &coarse, level + 1, error);
}

/* Returns the checkpoint of the run; NULL on ranks, whose states are written by sched/ranks/keep.c. */
static struct par_checkpoint *checkpoint_of(const struct par_run *run)
{
    return run->asked.options->carrier ? NULL : run->asked.options->checkpoint;
}

enum tri_status par_refine_rest(struct par_run *run, const struct tri_refine_hooks *hooks,
                                enum tri_status (*more)(void *user, struct tri_error *error), void *user,
                                struct tri_error *error)
{
    struct tri_refine_report report = {0};
    struct tri_refiner *refiner = NULL;
    enum tri_status status = tri_refiner_new(&refiner, run->mesh, &run->bounds, hooks, &report, error);
    if (!status)
        status = tri_refiner_run(refiner, error);
    while (status == TRI_NO_ROOM && more) {
        status = more(user, error);
        status = status ? status : tri_refiner_run(refiner, error);
    }
    tri_refiner_free(refiner);
    par_add_up(&run->report->total, &report);
    return status;
}

/* Refines the whole mesh by one sequential call. */
static enum tri_status refine_at_once(struct par_run *run, const struct tri_quality *quality, struct tri_error *error)
{
    const struct tri_refine_hooks hooks = par_hooks(run);
    run->bounds = *quality;
    enum tri_status status = par_refine_rest(run, &hooks, NULL, NULL, error);
    assert(tri_mesh_is_sound(run->mesh));
    return status;
}

/* The executor of a run: also measures the time that stages spend in parallel, by their number of shares. */
struct timed {
    struct tri_executor executor; /* the team's, which runs the tasks */
    double *seconds;              /* [PAR_SHARINGS] seconds_shared of the report */
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

/* Numbers the mesh independently of the ids that blocks gave, and removes unused places from its arrays. */
static enum tri_status number_mesh(struct par_run *run, struct tri_error *error)
{
    const struct timed *timed = run->asked.executor.self; /* use the inner executor: numbering is measured separately */
    struct tri_mesh *mesh = run->mesh;
    const double began = tri_seconds(), bytes = par_number_bytes(mesh->n_triangles, mesh->n_vertices, mesh->n_subs);
    par_report_phase(run, PAR_NUMBERING);
    enum tri_status status = par_park_expect(run->park, mesh, (size_t)bytes, error);
    status = status ? status : par_number(mesh, &run->cells, run->asked.n_kept, &timed->executor, error);
    assert(status || (mesh->n_vertices >= run->asked.n_kept && tri_mesh_is_sound(mesh)));
    run->report->seconds_number += tri_seconds() - began;
    return status;
}

/* Closes the gaps that blocks left in the arrays, by numbering if it is due now. Ids of triangles change. */
static enum tri_status close_gaps(struct par_run *run, bool numbering, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    double began = tri_seconds();
    if (numbering) {
        par_room_mark(&run->spare, run->mesh, &run->asked.executor);
        run->report->seconds_merge += tri_seconds() - began;
        status = number_mesh(run, error);
        if (!status) {
            par_room_free(&run->spare);
            return status;
        }
        began = tri_seconds();
    }
    par_room_close(&run->spare, run->mesh, &run->asked.executor);
    assert(tri_mesh_is_sound(run->mesh));
    run->report->seconds_merge += tri_seconds() - began;
    return status;
}

/* Offers to write a state between two steps. Does nothing if there is a state of a sweep: a resumed run repeats the
 * steps before the sweep, and must not overwrite that state. */
static enum tri_status offer_checkpoint(struct par_run *run, bool surely, struct tri_error *error)
{
    struct par_checkpoint *checkpoint = checkpoint_of(run);
    const bool is_kept = checkpoint && !par_checkpoint_has_sweep(checkpoint);
    return is_kept ? par_state_border(checkpoint, run, NULL, surely, error) : TRI_OK;
}

/* Allows steps to be stopped at any point from now on. Work since the last state is then lost. */
static void allow_stop_in_steps(struct par_run *run)
{
    if (checkpoint_of(run))
        run->mesh->stop = checkpoint_of(run)->stop;
}

static void update_most_live(struct par_run *run)
{
    struct par_report *report = run->report;
    report->most_live = run->mesh->n_triangles > report->most_live ? run->mesh->n_triangles : report->most_live;
}

/* --- rounds of phases */

/* A par_steps.run_phase in memory. For the whole mesh a state may be written between any two blocks. */
static enum tri_status run_phase(void *self, struct tri_error *error)
{
    struct par_schedule *s = self;
    struct par_run *run = s->run;
    struct par_checkpoint *checkpoint = s->is_whole ? checkpoint_of(run) : NULL;
    const struct par_turn turn = {.partition = &s->partition, .only = TRI_NONE};
    if (run->worklist.n == 0) {
        run->place.phase = PAR_PHASES;
        return TRI_OK;
    }
    enum tri_status status = s->is_whole ? offer_checkpoint(run, false, error) : TRI_OK;
    par_report_phase(run, run->place.phase + 1);
    if (!status)
        status = checkpoint ? par_state_phase(checkpoint, run, turn, NULL, error) : par_phase(run, &turn, error);
    run->place.phase++;
    return status;
}

static enum tri_status end_round(void *self, bool *again, struct tri_error *error)
{
    struct par_schedule *s = self;
    (void)error;
    s->left = s->run->worklist.n;
    *again = par_next_round(s);
    update_most_live(s->run);
    return TRI_OK;
}

/* Returns whether a mesh of this many triangles is too large for the memory limit or for 32-bit ids. */
static bool exceeds_memory(const struct par_run *run, double triangles)
{
    const struct par_options *options = run->asked.options;
    return options->sink && !options->carrier &&
           (options->sweep || triangles > PAR_SURELY_ONE_MESH * TRI_MAX_TRIANGLES ||
            (options->memory > 0 && triangles * par_whole_bytes_each() > (double)options->memory));
}

/* A copy of the run's data from before a sweep, to undo a sweep that must be given up. */
struct before {
    struct tri_mesh mesh;     /* the coarse mesh */
    struct par_ids worklist;  /* its worklist */
    struct par_report report; /* the report so far */
};

static enum tri_status save_before_sweep(const struct par_run *run, struct before *before, struct tri_error *error)
{
    *before = (struct before){.report = *run->report};
    if (!par_ids_add_all(&before->worklist, run->worklist.item, run->worklist.n))
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a copy of the worklist");
    return tri_mesh_copy(&before->mesh, run->mesh, error);
}

/* Restores mesh, worklist and report. The sink drops the tiles that it has received when its stream begins again. */
static void undo_sweep(struct par_run *run, struct before *before)
{
    struct par_ids worklist = run->worklist;
    struct par_report *report = run->report;
    int64_t live = report->most_live;
    tri_mesh_swap(run->mesh, &before->mesh);
    run->worklist = before->worklist;
    before->worklist = worklist;
    run->key.n = 0;
    run->gone = 0;
    par_room_free(&run->spare);
    before->report.blocks = report->blocks; /* the array may have moved */
    before->report.block_capacity = report->block_capacity;
    *report = before->report;
    report->most_live = live;
}

/* Sweeps the mesh. *done: the mesh has been handed out and removed. Otherwise the run is as before. */
static enum tri_status try_to_sweep(struct par_run *run, const struct par_partition *partition, bool *done,
                                    struct tri_error *error)
{
    struct before before;
    enum tri_status status = save_before_sweep(run, &before, error);
    run->n_schedules++;
    run->place.round = 0;
    status = status ? status : par_sweep(run, partition, done, error);
    update_most_live(run);
    if (!status && !*done) {
        undo_sweep(run, &before);
        run->n_schedules--;
    }
    free(before.worklist.item);
    tri_mesh_drop(&before.mesh);
    return status;
}

static enum tri_status fail_without_scratch(const struct par_run *run, double triangles, struct tri_error *error)
{
    return tri_fail(error, TRI_TOO_LARGE, NULL, 0,
                    "the mesh needs about %s of memory, and the bound is %s: set a scratch directory for it",
                    tri_size_text(par_whole_bytes_each() * triangles).text,
                    tri_size_text((double)run->asked.options->memory).text);
}

/* Called if the whole mesh does not fit in memory. Sweeps it if no step follows this schedule and the sink can begin
 * again. If the sweep is impossible, or leaves work, the mesh is moved to files as it grows. */
static enum tri_status sweep_or_park(struct par_run *run, const struct par_partition *partition,
                                    struct tri_error *error)
{
    const struct par_options *options = run->asked.options;
    enum tri_status status = TRI_OK;
    const bool is_last = run->place.next == PAR_BOUNDS && !options->by_block &&
                         !tri_wants_smoothing(run->asked.quality);
    bool swept = false;
    if (is_last && (options->sink->begin || !options->scratch))
        status = try_to_sweep(run, partition, &swept, error);
    if (swept)
        run->report->way = PAR_SWEPT;
    if (status || swept)
        return status;
    if (!options->scratch)
        return fail_without_scratch(run, partition->estimate, error);
    return tri_refine_check(run->mesh, &run->bounds, &run->asked.executor, error);
}

/* Refines the rest of a mesh in memory by one call, in the order of the worklist, which does not depend on ids. */
static enum tri_status refine_worklist_rest(struct par_run *run, struct tri_error *error)
{
    struct tri_refine_hooks hooks = par_hooks(run);
    hooks.worklist = run->worklist.item;
    hooks.n_worklist = run->worklist.n;
    par_room_mark(&run->spare, run->mesh, &run->asked.executor);
    enum tri_status status = run->worklist.n > 0 ? par_refine_rest(run, &hooks, NULL, NULL, error) : TRI_OK;
    assert(tri_mesh_is_sound(run->mesh));
    return status;
}

/* Ends a schedule by a sequential call for the triangles that no block could refine. */
static enum tri_status refine_left_over(struct par_schedule *s, struct tri_error *error)
{
    struct par_run *run = s->run;
    const double began = tri_seconds();
    enum tri_status status = TRI_OK;
    if (s->is_whole && !par_is_rest(run->place.next))
        par_go(run, par_is_of_sizes(run->place.next) ? PAR_SIZES_REST : PAR_BOUNDS_REST);
    if (s->is_whole)
        status = offer_checkpoint(run, false, error);
    if (!status)
        status = run->ranks ? par_refine_rest_on_ranks(run, error) : refine_worklist_rest(run, error);
    run->report->seconds_last += tri_seconds() - began;
    return status;
}

/* Ends a schedule: frees its cells and closes the gaps in the arrays, which ranks keep until the end. */
static enum tri_status close_schedule(struct par_schedule *s, enum tri_status status, struct tri_error *error)
{
    struct par_run *run = s->run;
    par_partition_free(&s->partition);
    run->worklist.n = run->key.n = 0;
    if (run->ranks)
        return status;
    const bool is_last = s->is_whole && !par_is_of_sizes(run->place.next) && !run->asked.options->by_block;
    enum tri_status closed = close_gaps(run, !status && is_last, error);
    par_forget_deferred(run->report);
    return status ? status : closed;
}

/* Fills in the report on the first schedule of the whole mesh. */
static enum tri_status report_schedule(struct par_run *run, const struct par_partition *partition,
                                       struct tri_error *error)
{
    struct par_report *report = run->report;
    if (report->partition.x)
        return TRI_OK;
    report->schedule = run->n_schedules;
    report->columns = partition->n_columns;
    report->rows = partition->n_rows;
    report->radius_measured = run->radius * run->mesh->unit;
    report->prerefined = run->mesh->n_triangles;
    return par_partition_copy(&report->partition, partition, error);
}

/* Runs the rounds of one level from the current position on, and then the sequential call. */
static enum tri_status run_schedule(struct par_run *run, const struct tri_quality *quality,
                                    const struct par_partition *cells, bool is_whole, struct tri_error *error)
{
    static const struct par_steps in_memory = {run_phase, end_round};
    struct par_schedule s = {.run = run, .is_whole = is_whole, .left = par_is_rest(run->place.next)};
    enum tri_status status = par_partition_copy(&s.partition, cells, error);
    run->bounds = *quality;
    for (int round = 0; !status && round < run->place.round; round++)
        par_partition_coarsen(&s.partition);
    if (!status && !par_is_rest(run->place.next)) {
        status = par_run_rounds(run, run->ranks ? &par_steps_on_ranks : &in_memory, &s, error);
        run->report->left_over += is_whole && !status ? s.left : 0;
        if (!run->ranks)
            run->report->deferred += run->report->total.fenced; /* close_schedule clears it in the total */
    }
    if (!status && s.left > 0)
        status = refine_left_over(&s, error);
    return close_schedule(&s, status, error);
}

/* Moves the position to the first round of a new schedule. */
static void begin_rounds(struct par_run *run)
{
    run->n_schedules++;
    run->place.round = run->place.phase = run->place.step = 0;
}

/* Begins the schedule of the whole mesh. If necessary, sweeps it, moves it to files, or distributes it to ranks. */
static enum tri_status begin_schedule(struct par_run *run, const struct tri_quality *quality,
                                      const struct par_partition *partition, struct tri_error *error)
{
    const struct par_options *options = run->asked.options;
    enum tri_status status = report_schedule(run, partition, error);
    const bool is_of_sizes = par_is_of_sizes(run->place.next);
    run->bounds = *quality;
    if (!status && partition != &run->cells) {
        par_partition_free(&run->cells);
        status = par_partition_copy(&run->cells, partition, error);
    }
    if (!status && run->place.next != PAR_BOUNDS_WHOLE && exceeds_memory(run, partition->estimate))
        status = sweep_or_park(run, partition, error);
    if (status || run->place.next == PAR_END)
        return status;
    par_go(run, is_of_sizes ? PAR_SIZES_PHASE : PAR_BOUNDS_PHASE);
    begin_rounds(run);
    const bool spreads = options->sink && options->carrier && !options->by_block && !run->ranks &&
                         !tri_wants_smoothing(run->asked.quality);
    return spreads ? par_ranks_begin(run, error) : TRI_OK;
}

/* Runs the schedule of the whole mesh, unless begin_schedule has swept it or resumed ranks at a later step. */
static enum tri_status run_whole_schedule(struct par_run *run, const struct tri_quality *quality,
                                          const struct par_partition *partition, struct tri_error *error)
{
    const bool is_of_sizes = par_is_of_sizes(run->place.next);
    enum tri_status status = begin_schedule(run, quality, partition, error);
    const bool is_there = par_is_of_sizes(run->place.next) == is_of_sizes &&
                          (par_is_phase(run->place.next) || par_is_rest(run->place.next));
    return status || !is_there ? status : run_schedule(run, quality, &run->cells, true, error);
}

/* Returns the number of final triangles in a cell: as requested, or the default. */
static double cell_size(const struct par_run *run, double estimate)
{
    const double asked = run->asked.options->cell_triangles;
    return asked > 0 ? asked : par_triangles_in_cell(estimate);
}

/* Runs the schedule on one level: cuts cells, makes the coarse mesh, and runs the rounds. */
static enum tri_status schedule_level(struct par_run *run, const struct tri_quality *quality, int level,
                                      double estimate, double cell, struct tri_error *error)
{
    struct par_partition partition;
    double began = tri_seconds();
    enum tri_status status = par_partition_make(&partition, run->mesh, quality, estimate, cell, &run->asked.executor,
                                                error);
    run->report->seconds_partition += tri_seconds() - began;
    if (status)
        return status;
    run->report->levels = level + 1 > run->report->levels ? level + 1 : run->report->levels;
    run->place.level = level;
    par_report_phase(run, 0);
    if (par_areas_decide(run, quality, estimate, cell)) {
        status = prerefine_uniform(run, quality, cell, level, error);
        began = tri_seconds();
        status = status ? status : par_fill_worklist(run, quality, false, error);
        run->report->seconds_find += tri_seconds() - began;
    } else {
        status = par_prerefine_graded(run, quality, &partition, error);
    }
    run->place.level = level; /* the coarse level has changed it */
    if (!status && level == 0) {
        status = run_whole_schedule(run, quality, &partition, error);
    } else if (!status) {
        begin_rounds(run);
        status = run_schedule(run, quality, &partition, false, error);
    }
    par_partition_free(&partition);
    return status;
}

static double estimate_of(struct par_run *run, const struct tri_quality *quality, double *sure)
{
    double began = tri_seconds(), estimate = tri_estimate(run->mesh, quality, &run->asked.executor, sure);
    run->report->seconds_partition += tri_seconds() - began;
    return estimate;
}

/* Runs a sequential call, limited to the points of about this many triangles. *done: no work is left. */
static enum tri_status refine_first_points(struct par_run *run, const struct tri_quality *quality,
                                       double triangles, bool *done, struct tri_error *error)
{
    struct tri_quality options = *quality;
    struct tri_refine_report report;
    double began = tri_seconds();
    options.max_steiner = (int64_t)(triangles / 2);
    const struct tri_refine_hooks hooks = par_hooks(run);
    enum tri_status status = tri_refine_with(run->mesh, &options, &hooks, &report, error);
    *done = !report.hit_limit;
    if (*done)
        par_add_up(&run->report->total, &report);
    else /* the schedule finds the remaining bad triangles again, and counts them */
        par_add_points(&run->report->total, &report);
    run->report->seconds_prerefine += tri_seconds() - began;
    return status;
}

/* Refines to these bounds, by one call if there is little work, otherwise by the schedule. `sure`, the work for areas
 * and existing triangles, is known; `estimate` also guesses the work for angles, and a few small parts of a mesh can
 * make the guess wrong by orders of magnitude. If only the guess is large, a part of the mesh is refined first. Then
 * either no work is left, or the next estimate is better. */
static enum tri_status refine_level(struct par_run *run, const struct tri_quality *quality, int level,
                                    struct tri_error *error)
{
    double sure, estimate = estimate_of(run, quality, &sure), cell = cell_size(run, estimate);
    double large = cell * (level == 0 ? PAR_FEWEST_CELLS : PAR_FEWEST_COARSE_CELLS);
    if (estimate >= large && sure < large) {
        bool done;
        enum tri_status status = refine_first_points(run, quality, large * PAR_A_LITTLE, &done, error);
        if (status || done)
            return status;
        estimate = estimate_of(run, quality, &sure);
        cell = cell_size(run, estimate);
    }
    if (estimate >= cell * (level == 0 ? PAR_FEWEST_CELLS : PAR_FEWEST_COARSE_CELLS))
        return schedule_level(run, quality, level, estimate, cell, error);
    double began = tri_seconds();
    enum tri_status status = refine_at_once(run, quality, error);
    *(level > 0 ? &run->report->seconds_prerefine : &run->report->seconds_last) += tri_seconds() - began;
    return status;
}

/* Fills the worklist of a mesh that blocks have refined, in an order independent of ids. A rank lists the triangles in
 * its own tiles only, all of which it holds. */
static enum tri_status order_work(struct par_run *run, const struct tri_quality *quality, struct tri_error *error)
{
    int32_t first = 0, end = par_blocks(&run->cells);
    if (run->ranks)
        par_ranks_own_blocks(run->ranks, &first, &end);
    par_room_mark(&run->spare, run->mesh, &run->asked.executor);
    enum tri_status status = par_fill_worklist(run, quality, false, error);
    if (!status)
        status = par_park_expect(run->park, run->mesh, par_order_bytes(&run->worklist), error);
    if (!status && !par_order_by_tile(&run->worklist, &run->key, run->mesh, &run->cells, first, end,
                                      &run->asked.executor))
        status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for %d triangles", (int)run->worklist.n);
    return status;
}

/* Runs the schedule for all bounds after the one for sizes, on the same cells. On ranks, no process holds the whole
 * mesh now, so cells cannot be cut again. Triangles are small against the cells, so no coarse mesh is needed. */
static enum tri_status refine_angles(struct par_run *run, const struct tri_quality *quality, struct tri_error *error)
{
    double began = tri_seconds(), sure;
    if (!run->ranks && !run->asked.options->scratch && run->asked.options->memory > 0) {
        double estimate = estimate_of(run, quality, &sure);
        if (exceeds_memory(run, estimate))
            return fail_without_scratch(run, estimate, error);
    }
    enum tri_status status = order_work(run, quality, error);
    run->report->seconds_find += tri_seconds() - began;
    return status ? status : run_whole_schedule(run, quality, &run->cells, error);
}

/* Refines to these bounds from the beginning, or from the current position in the schedule. */
static enum tri_status refine_to(struct par_run *run, const struct tri_quality *quality, struct tri_error *error)
{
    if (par_is_phase(run->place.next) || par_is_rest(run->place.next))
        return run_schedule(run, quality, &run->cells, true, error);
    return run->cells.x ? refine_angles(run, quality, error) : refine_level(run, quality, 0, error);
}

/* Refines for sizes alone, with an easy bound on angles; the angles follow on a mesh of nearly uniform size. In a mesh
 * refined from a coarse one in stages, triangles of different sizes meet everywhere, which makes high angle bounds
 * expensive. (On letter.poly at 33 degrees: 2% more triangles than by one sequential call, instead of 28%.) */
static enum tri_status refine_sizes_first(struct par_run *run, const struct tri_quality *quality,
                                          struct tri_error *error)
{
    struct tri_quality easy = *quality;
    easy.min_angle = TRI_SIZES_ANGLE;
    easy.lattice = tri_wants_lattice(quality); /* a lattice is built only if the bound on angles will keep it */
    enum tri_status status = refine_to(run, &easy, error);
    if (status || !par_is_of_sizes(run->place.next)) /* ranks have resumed at a later step */
        return status;
    const struct par_checkpoint *checkpoint = checkpoint_of(run);
    const bool is_kept_whole = checkpoint && checkpoint->manifest.kind == PAR_WHOLE_STATE;
    par_go(run, run->cells.x || is_kept_whole ? PAR_BOUNDS_WHOLE : PAR_BOUNDS);
    return offer_checkpoint(run, false, error);
}

/* Returns whether the bounds or options rule out a schedule. */
static bool must_be_sequential(const struct tri_quality *quality, const struct par_options *options)
{
    const bool is_tied = options->hooks && (options->hooks->gate || options->hooks->fence);
    return quality->max_steiner >= 0 || is_tied || (quality->unsuitable && !options->size_test_in_parallel);
}

/* Refines by schedules: two if angles are expensive. */
static enum tri_status refine_by_schedule(struct par_run *run, struct tri_error *error)
{
    struct tri_quality usual = *run->asked.quality;
    usual.min_angle = tri_worked_angle(&usual);
    enum tri_status status = par_is_of_sizes(run->place.next) ? refine_sizes_first(run, &usual, error) : TRI_OK;
    return status || run->place.next == PAR_HAND_OUT ? status : refine_to(run, &usual, error);
}

/* Hands out a finished mesh, tile by tile if it is numbered. */
static enum tri_status hand_out(struct par_run *run, struct tri_error *error)
{
    const struct par_options *options = run->asked.options;
    const bool is_numbered = run->cells.x && !options->by_block;
    struct par_tiles tiles = par_tiles_of(run, is_numbered ? &run->cells : NULL);
    enum tri_status status = par_park_expect(run->park, run->mesh, par_tiles_whole_bytes(&tiles), error);
    if (status)
        return status;
    tri_surface_settle(run->mesh, &run->asked.executor);
    if (options->count_remaining && !options->carrier)
        par_remain_count_all(run);
    if (options->carrier)
        return par_whole_on_ranks(options->carrier, &tiles, error);
    status = par_tiles_whole(&tiles, error);
    /* The sink failed: write a state of the finished mesh, if possible. */
    if (status && options->checkpoint && !tri_wants_smoothing(run->asked.quality))
        (void)par_state_border(options->checkpoint, run, NULL, true, NULL);
    return status;
}

/* Hands out the mesh, unless a sweep has done so. status: of the previous steps; ranks exchange their statuses. */
static enum tri_status hand_out_rest(struct par_run *run, enum tri_status status, struct tri_error *error)
{
    if (!status && run->place.next < PAR_HAND_OUT)
        par_go(run, PAR_HAND_OUT);
    if (run->ranks) {
        status = par_ranks_hand_out(run, status, error);
    } else if (!status && run->place.next != PAR_END) {
        status = offer_checkpoint(run, tri_wants_smoothing(run->asked.quality), error);
        allow_stop_in_steps(run);
        status = status ? status : par_smooth(run, error); /* the state holds the mesh before smoothing */
        status = !status && run->asked.options->sink ? hand_out(run, error) : status;
    }
    if (!status && run->place.next == PAR_HAND_OUT)
        par_go(run, PAR_END);
    return status;
}

/* Closes everything that the run has opened and frees its lists, after success and after errors. */
static void clean_up(struct par_run *run)
{
    const struct par_options *options = run->asked.options;
    struct par_report *report = run->report;
    const bool is_spread = par_ranks_end(run);
    report->parked = run->park ? par_park_bytes(run->park) : 0;
    if (report->parked > 0 && report->way == PAR_IN_MEMORY)
        report->way = PAR_PARKED;
    allow_stop_in_steps(run);
    if (options->checkpoint)
        options->checkpoint->stop = NULL; /* it may belong to the park, which is closed here */
    if (options->park)
        *options->park = run->park;
    else
        par_park_close(run->park, run->mesh);
    if (is_spread || (report->way != PAR_IN_MEMORY && !options->park))
        tri_mesh_drop(run->mesh);
    free(run->worklist.item);
    free(run->key.item);
    free(run->remain.listed.item);
    free(run->place.done.item);
    par_partition_free(&run->cells);
    par_room_free(&run->spare);
}

/* Refines by schedules or by one call, and hands the mesh to the sink. */
static enum tri_status refine_and_deliver(struct par_run *run, bool sequential, struct tri_error *error)
{
    double began = tri_seconds();
    enum tri_status status = TRI_OK;
    if (!sequential)
        status = refine_by_schedule(run, error);
    else if (run->place.next != PAR_HAND_OUT)
        status = refine_at_once(run, run->asked.quality, error);
    if (sequential)
        run->report->seconds_last += tri_seconds() - began;
    run->bounds = *run->asked.quality;
    return hand_out_rest(run, status, error);
}

/* Checks that all ranks begin with the same mesh and settings; otherwise they would wait for each other forever. */
static enum tri_status check_ranks(const struct par_run *run, enum tri_status status, struct tri_error *error)
{
    struct par_carrier *carrier = run->asked.options->carrier;
    if (!carrier)
        return status;
    return par_expect_same(carrier, status ? 0 : par_state_run(run),
                           "the ranks were given different inputs or settings", status, error);
}

enum tri_status par_refine(struct tri_mesh *mesh, const struct tri_quality *quality,
                           const struct par_options *options, struct par_report *report, struct tri_error *error)
{
    double began = tri_seconds();
    assert(tri_mesh_is_sound(mesh));
    assert(!options->park || !options->sink);
    const bool alone = tri_asks_caller(quality) && !options->size_test_in_parallel;
    struct par_team own = {.threads = alone ? 1 : par_threads(options->threads, false)};
    struct par_team *team = options->team && !alone ? options->team : &own;
    *report = (struct par_report){.threads = team->threads};
    if (options->park)
        *options->park = NULL;
    struct timed timed = {par_executor(team), report->seconds_shared};
    struct par_run run = {.asked = {quality, options, {run_timed, &timed}, mesh->n_vertices}, .mesh = mesh,
                          .report = report, .bounds = *quality};
    bool sequential = must_be_sequential(quality, options);
    bool may_be_swept = options->sink && !sequential && quality->min_angle <= TRI_EASY_ANGLE &&
                     !tri_wants_smoothing(quality);
    enum tri_status status = tri_refine_prepare(mesh, &run.asked.executor, error);
    status = status ? status : tri_ask_lengths(mesh, quality->lengths, &run.asked.executor, error);
    status = status || may_be_swept ? status : tri_refine_check(mesh, quality, &run.asked.executor, error);
    status = check_ranks(&run, status, error);
    if (!status && options->memory > 0 && (options->scratch || !options->sink)) /* otherwise a sweep limits memory */
        status = par_park_open(&run.park, mesh, options->sink || options->park ? options->scratch : NULL,
                               options->memory, error);
    if (status) {
        par_team_end(&own);
        return status;
    }
    if (run.park)
        timed.executor = par_park_executor(run.park, timed.executor);
    /* Decided on the initial mesh, so that a resumed run makes the same decision. */
    const bool sizes_first = !sequential && tri_sizes_come_first(mesh, quality, &run.asked.executor);
    run.place.next = sizes_first ? PAR_SIZES : PAR_BOUNDS;
    if (checkpoint_of(&run))
        status = par_state_begin(options->checkpoint, &run, error);
    status = status ? status : refine_and_deliver(&run, sequential, error);
    if (!options->sink)
        tri_surface_settle(mesh, &run.asked.executor);
    status = par_park_status(run.park, status, error);
    clean_up(&run);
    par_team_end(&own);
    assert(options->sink || tri_mesh_is_sound(mesh));
    report->seconds_total = tri_seconds() - began;
    return status;
}
