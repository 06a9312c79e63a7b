/* Checkpoints of a run on ranks, between two steps: each rank writes what it owns, rank 0 how far all are; then the
 * manifest. */
#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/state.h"
#include "sched/ranks/pieces.h"
#include "sched/schedule/room.h"
#include "triangle/base/clock.h"

/* What a rank has written. */
struct writer {
    int64_t end;   /* its tiles begin where those of the rank before it end */
    uint64_t hash; /* of its file */
};

/* The state's file. */
struct kept {
    int32_t next, round, phase, step; /* as in struct par_run */
    int64_t left_over;
    int64_t rounds; /* that are over, of both schedules */
    int64_t done[PAR_DONE];
    int64_t n_ranks;
    struct writer writer[]; /* [n_ranks] */
};

static size_t size_of(int64_t n_ranks) { return sizeof(struct kept) + (size_t)n_ranks * sizeof(struct writer); }

static enum tri_status carry(struct par_state_file *file, void *user, struct tri_error *error)
{
    struct kept *kept = user;
    (void)error;
    par_carry(file, kept, size_of(kept->n_ranks));
    return TRI_OK;
}

/* --- going on */

/* The mesh is empty but for the vertices that all ranks have: what follows tells of all others. */
static void forget_all(struct par_run *run, int32_t n_common)
{
    run->mesh->n_vertices = n_common;
    run->mesh->n_triangles = run->mesh->n_subs = 0;
    run->worklist.n = run->key.n = 0;
    par_room_free(&run->spare);
}

static bool find_straddlers(struct par_ranks *r)
{
    bool memory = true;
    for (tri_triangle_id t = 0; memory && t < r->run->mesh->n_triangles; t++)
        memory = par_own_corners(r, t) == 3 || par_ids_add(&r->straddlers, t);
    return memory;
}

static enum tri_status read_pieces(struct par_ranks *r, const struct par_manifest *m, const struct writer *writer,
                                   struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    forget_all(r->run, r->n_common);
    if (!par_index_straddlers(r))
        return par_ranks_no_memory(error);
    for (int p = 0; !status && p < m->n_ranks; p++) {
        const struct par_piece_file file = {m->which, p, p > 0 ? (int32_t)writer[p - 1].end : 0,
                                            (int32_t)writer[p].end, writer[p].hash};
        status = par_pieces_read(r, &file, error);
    }
    return status || find_straddlers(r) ? status : par_ranks_no_memory(error);
}

/* Rank 0 counts what has been done for all. */
static void go_on_from(struct par_ranks *r, const struct kept *c)
{
    r->run->place.next = (enum par_next)c->next;
    r->run->place.round = c->round;
    r->run->place.phase = c->phase;
    r->run->place.step = c->step;
    r->run->report->rounds += (int)c->rounds;
    r->run->report->left_over += c->left_over;
    if (r->carrier->rank == 0)
        par_add_done(r, c->done);
}

static enum tri_status take_up(struct par_ranks *r, const struct par_manifest *m, struct tri_error *error)
{
    struct kept *kept = calloc(1, size_of(m->n_ranks));
    enum tri_status status = kept ? TRI_OK : par_ranks_no_memory(error);
    if (!status && r->carrier->rank == 0) {
        kept->n_ranks = m->n_ranks;
        status = par_checkpoint_read(r->run->asked.options->checkpoint, carry, kept, error);
    }
    status = par_spread(r->carrier, PAR_MOVE_INPUT, kept, size_of(m->n_ranks), status, error);
    status = status ? status : read_pieces(r, m, kept->writer, error);
    if (!status)
        go_on_from(r, kept);
    free(kept);
    return status;
}

/* Rank 0 has read it. */
static enum tri_status check_manifest(struct par_ranks *r, struct par_manifest *m, struct tri_error *error)
{
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    enum tri_status status = TRI_OK;
    if (par_checkpoint_has_state(c) && !par_checkpoint_has_ranks(c))
        status = tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "is the checkpoint of one task");
    else if (r->carrier->rank == 0)
        status = par_checkpoint_take(c, r->of_run, error);
    *m = c->manifest;
    return par_spread(r->carrier, PAR_MOVE_INPUT, m, sizeof *m, status, error);
}

enum tri_status par_take_up(struct par_ranks *r, bool *again, struct tri_error *error)
{
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    struct par_manifest m;
    *again = false;
    if (!c)
        return TRI_OK;
    c->stop = r->run->mesh->stop;
    c->last = c->looked = tri_seconds();
    enum tri_status status = check_manifest(r, &m, error);
    if (status || m.state_bytes == 0)
        return status;
    *again = true;
    r->run->mesh->stop = NULL; /* there is something to lose */
    return take_up(r, &m, error);
}

/* --- keeping */

/* Those whose first corner is an own one: of all ranks together each once. */
static int64_t count_triangles(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->run->mesh;
    int64_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        n += tri_is_live(&mesh->tri[t]) && par_is_own(&r->territory, mesh->xy[mesh->tri[t].v[0]]);
    return n;
}

/* Rank 0: what all have told of themselves becomes the state, and counts. */
static enum tri_status put(struct par_ranks *r, const int64_t *told, const int64_t done[PAR_DONE],
                           struct tri_error *error)
{
    const int n_ranks = r->carrier->n_ranks;
    const struct par_position *place = &r->run->place;
    struct kept *kept = calloc(1, size_of(n_ranks));
    int64_t triangles = 0;
    if (!kept)
        return par_ranks_no_memory(error);
    *kept = (struct kept){place->next, place->round, place->phase, place->step,
                          .left_over = r->run->report->left_over - r->left_before,
                          .rounds = r->run->report->rounds - r->rounds_before, .n_ranks = n_ranks};
    memcpy(kept->done, done, sizeof kept->done);
    for (int p = 0; p < n_ranks; p++) {
        kept->writer[p] = (struct writer){r->territory.start[p + 1], (uint64_t)told[2 * p]};
        triangles += told[2 * p + 1];
    }
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    enum tri_status status = par_checkpoint_write(c, PAR_RANKS_STATE, n_ranks, triangles, carry, kept, error);
    free(kept);
    return status;
}

/* The manifest, which rank 0 has, says which files are free. */
static enum tri_status write_pieces(struct par_ranks *r, int64_t told[2], struct tri_error *error)
{
    uint64_t hash = 0;
    int64_t which = par_checkpoint_next(r->run->asked.options->checkpoint);
    enum tri_status status = par_spread(r->carrier, PAR_MOVE_INPUT, &which, sizeof which, TRI_OK, error);
    status = status ? status : par_pieces_write(r, which, &hash, error);
    told[0] = (int64_t)hash;
    told[1] = count_triangles(r);
    return status;
}

static enum tri_status keep(struct par_ranks *r, struct tri_error *error)
{
    int64_t mine[PAR_DONE], done[PAR_DONE], told[2] = {0};
    int64_t *all = malloc(2 * (size_t)r->carrier->n_ranks * sizeof *all);
    par_count_done(r, mine);
    enum tri_status status = all ? TRI_OK : par_ranks_no_memory(error);
    status = par_sum(r->carrier, mine, PAR_DONE, done, status, error);
    status = status ? status : write_pieces(r, told, error);
    status = par_gather(r->carrier, told, 2, all, status, error);
    if (!status && r->carrier->rank == 0)
        status = put(r, all, done, error);
    free(all);
    return par_agree(r->carrier, status, error);
}

enum tri_status par_keep(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    int64_t asked[2], sum[2];
    if (!c)
        return status;
    r->run->mesh->stop = NULL; /* there is something to lose */
    const double began = tri_seconds(), step = began - c->looked, triangles = (double)par_triangles(r->run);
    const bool is_last = r->carrier->rank == 0 && par_state_is_last(c, began + step, triangles);
    c->looked = began;
    asked[0] = is_last || tri_stop_is_asked(c->stop);
    asked[1] = r->carrier->rank == 0 && par_state_is_due(c, began, triangles);
    status = par_sum(r->carrier, asked, 2, sum, status, error);
    if (status || sum[0] + sum[1] == 0)
        return status;
    status = keep(r, error);
    c->last = tri_seconds();
    c->cost = c->writing = c->last - began;
    c->size = triangles;
    if (!status && is_last && c->time_up)
        c->time_up();
    return par_agree(r->carrier, status || sum[0] == 0 ? status : tri_fail_stopped(error), error);
}
