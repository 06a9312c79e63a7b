/* The refinement loop: removes the most urgent bad triangle from the queue, treats it (treat.c), and queues the new
 * bad triangles (feed.c).
 *
 * ORDER. Under -D, subsegments with a vertex in their diametral circle are split first (split.c). Next are triangles
 * with a corner that encroaches the opposite subsegment. While the subsegment is encroached, the corner may hide it
 * from the cavity of another point (cavity.h), and that point could be placed arbitrarily close to it. Next are
 * triangles with bad angles, those with the shortest edges first (bad_queue.h). Triangles that are only too large
 * come last.
 *
 * COST. Treating a triangle costs as much as searching its cavity: O(1) on average, but up to O(n) beside n points
 * at a wall that must not be split (-Y).
 *
 * THEOREM (termination). hopeless.c and feature_size.c bound the number of points inserted for angles. place.c and
 * split.c bound the number inserted for sizes and diametral circles, however many points the other rules insert. */
#include "triangle/refine/refiner.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/mesh/surface.h"
#include "triangle/refine/smooth.h"
#include "triangle/size/estimate.h"
#include "triangle/tunables.h"

/* Sets r->hand to the next triangle; returns false if there is none. In the first pass only triangles with short
 * edges are next, see refine_worklist. */
static bool next_entry(struct tri_refiner *r)
{
    if (r->stage == FRONT_STAGE)
        return tri_front_next(r);
    return r->step <= ALL_ANGLES ? tri_bad_queue_pop_angle(&r->queue, r->limit, r->mesh, &r->hand)
                                 : tri_bad_queue_pop(&r->queue, r->mesh, &r->hand);
}

static bool run_queue(struct tri_refiner *r)
{
    assert(r->step != NOT_BEGUN);
    for (;;) {
        if (tri_refiner_must_stop(r))
            return false;
        if (!r->is_pending && !tri_split_encroached(r)) /* after a pause, the interrupted triangle comes first */
            return false;
        if (!r->is_pending && !next_entry(r))
            return true;
        r->is_pending = true;
        if (tri_treat(r, r->hand) == FAILED)
            return false;
        r->is_pending = false;
    }
}

/* Queues the bad angles of the next chunk of the worklist. The median of the waiting entries then becomes the limit. */
static bool queue_chunk(struct tri_refiner *r)
{
    for (int32_t i = 0; i < TRI_WORKLIST_CHUNK && r->next_listed < r->n_worklist; i++, r->next_listed++) {
        tri_triangle_id triangle = tri_worklist_triangle(r, r->next_listed);
        if ((r->quality->conforming && !tri_queue_beside(r, triangle)) || !tri_queue_triangle(r, triangle, false))
            return false;
    }
    assert(r->next_listed <= r->n_worklist);
    r->limit = tri_bad_queue_median(&r->queue);
    return true;
}

/* Passes over the worklist twice. The first pass goes chunk by chunk and treats the bad angles whose shortest edges
 * are below the median. So the order by shortest edge (bad_queue.h) nearly holds for the whole mesh, and the work
 * stays in the cache if neighbours in the list are neighbours in the plane. The second pass treats the other bad
 * angles in the same order, then the triangles that are only too large, in the order of the worklist. Lattice cells
 * are made before those, when no angle is bad any more: by then the triangles beside small features are small.
 * Returns false on failure or if there is no room; call it again to resume. */
static bool refine_worklist(struct tri_refiner *r)
{
    if (r->step == NOT_BEGUN) {
        assert(!r->is_pending && r->n_encroached == 0);
        r->n_worklist = tri_worklist_length(r);
        r->next_listed = 0;
        r->step = FIRST_PASS;
    }
    while (r->step == FIRST_PASS) {
        if (!run_queue(r))
            return false;
        if (r->next_listed == r->n_worklist) {
            r->step = ALL_ANGLES;
            r->limit = tri_may_fill_lattice(r) ? TRI_BUCKETS : 0;
        } else if (!queue_chunk(r)) {
            return false;
        }
    }
    if (r->step == ALL_ANGLES) {
        if (!run_queue(r))
            return false;
        r->step = FILLING;
    }
    if (r->step == FILLING) {
        if (!tri_fill_lattice(r))
            return false;
        r->step = SECOND_PASS;
        r->next_listed = 0;
    }
    if (!run_queue(r))
        return false;
    while (tri_has_sizes(r->quality) && r->next_listed < r->n_worklist)
        if (!tri_queue_triangle(r, tri_worklist_triangle(r, r->next_listed++), true) || !run_queue(r))
            return false;
    return true;
}

/* If area bounds determine most of the mesh and the angle bound is above TRI_EASY_ANGLE, a first stage refines for
 * sizes with an easy angle bound (tri_sizes_come_first). A call with a fence or a worklist has only one stage,
 * because its list would lack the triangles that the first stage makes bad for the second. */
static void begin_stages(struct tri_refiner *r)
{
    bool easy = !r->hooks->fence && !r->hooks->worklist && tri_sizes_come_first(r->mesh, r->quality, NULL);
    const bool front = r->quality->lengths && r->quality->front && !r->hooks->urgent;
    r->stage = front ? FRONT_STAGE : easy ? EASY_STAGE : USUAL_STAGE;
    r->criterion.bounds = tri_bounds_of(r->quality, easy ? TRI_SIZES_ANGLE : tri_worked_angle(r->quality));
}

/* Runs all stages. Resumable like refine_worklist. */
static bool refine_in_stages(struct tri_refiner *r)
{
    for (; r->stage != LAST_STAGE; r->stage = r->stage == USUAL_STAGE ? LAST_STAGE : USUAL_STAGE) {
        if (r->stage == FRONT_STAGE ? !tri_front_begin(r) || !run_queue(r) : !refine_worklist(r))
            return false;
        r->step = NOT_BEGUN;
        r->criterion.bounds = tri_bounds_of(r->quality, tri_worked_angle(r->quality));
    }
    return true;
}

/* Checks that the mesh can hold the triangles which the sizes require. Calls for part of the work are not checked
 * again. */
static enum tri_status check_sizes(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                   const struct tri_refine_hooks *hooks, struct tri_error *error)
{
    struct tri_quality known = *quality;
    known.edge_length = hooks->worklist ? NULL : quality->edge_length;
    return hooks->fence || hooks->part ? TRI_OK : tri_refine_check(mesh, &known, NULL, error);
}

enum tri_status tri_refiner_new(struct tri_refiner **refiner, struct tri_mesh *mesh,
                                const struct tri_quality *quality, const struct tri_refine_hooks *hooks,
                                struct tri_refine_report *report, struct tri_error *error)
{
    struct tri_refiner *r = NULL;
    *refiner = NULL;
    *report = (struct tri_refine_report){0};
    enum tri_status status = check_sizes(mesh, quality, hooks, error);
    if (status)
        return status;
    r = calloc(1, sizeof *r);
    if (!r || !tri_bad_queue_init(&r->queue)) {
        free(r);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for refinement");
    }
    *refiner = r;
    assert(mesh->n_triangles == 0 || mesh->incidence.n_vertices > 0); /* tri_refine_prepare has been called */
    r->mesh = mesh;
    r->quality = quality;
    r->hooks = hooks;
    r->criterion = tri_criterion_for(mesh, quality);
    r->report = report;
    r->lattice = tri_wants_lattice(quality);
    r->edge = tri_lattice_length(quality);
    begin_stages(r);
    frexp(mesh->limits.shortest2, &r->least_exponent);
    r->cavity.fence = hooks->fence;
    r->cavity.owners = hooks->owners;
    return TRI_OK;
}

enum tri_status tri_refiner_run(struct tri_refiner *r, struct tri_error *error)
{
    r->error = (struct tri_error){.status = TRI_OK}; /* without a failure, the caller's error stays unchanged */
    if (refine_in_stages(r)) {
        assert(!r->is_pending && r->n_encroached == 0);
        return TRI_OK;
    }
    if (r->error.status == TRI_OK)
        tri_fail(&r->error, TRI_NO_MEMORY, NULL, 0, "out of memory while refining");
    if (error)
        *error = r->error;
    return r->error.status;
}

void tri_refiner_free(struct tri_refiner *r)
{
    if (!r)
        return;
    tri_fill_free(r);
    tri_cavity_free(&r->cavity);
    tri_bad_queue_free(&r->queue);
    tri_front_free(&r->front);
    free(r->encroached);
    free(r);
}

enum tri_status tri_refine_with(struct tri_mesh *mesh, const struct tri_quality *quality,
                                const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                struct tri_error *error)
{
    struct tri_refiner *refiner = NULL;
    enum tri_status status = tri_refine_prepare(mesh, NULL, error);
    status = status ? status : tri_ask_lengths(mesh, quality->lengths, NULL, error);
    status = status ? status : tri_refiner_new(&refiner, mesh, quality, hooks, report, error);
    status = status ? status : tri_refiner_run(refiner, error);
    tri_refiner_free(refiner);
    assert(hooks->more_room || tri_mesh_is_sound(mesh)); /* the counts of a view are not those of the mesh */
    return status;
}

enum tri_status tri_refine_whole(struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_refine_hooks *hooks, struct tri_refine_report *report,
                                 struct tri_error *error)
{
    enum tri_status status = tri_refine_with(mesh, quality, hooks, report, error);
    if (!status && tri_wants_smoothing(quality))
        status = tri_smooth_all(mesh, quality, error);
    tri_surface_settle(mesh, NULL);
    return status;
}

enum tri_status tri_refine(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_refine_report *report,
                           struct tri_error *error)
{
    return tri_refine_whole(mesh, quality, &(struct tri_refine_hooks){0}, report, error);
}
