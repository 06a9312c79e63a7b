/* Files are those of the machine that wrote them: arrays as they lie in memory. */
#include "sched/checkpoint/state.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/phase.h"
#include "triangle/base/clock.h"
#include "triangle/base/grow.h"

static const uint64_t STATE = UINT64_C(0x3965746174736974); /* a version, too */

/* --- of which run */

static uint64_t hash_bounds(uint64_t hash, const struct tri_refine_options *q)
{
    const double reals[] = {q->min_angle, q->max_area, q->area_scale};
    const int64_t others[] = {q->region_areas, q->conforming, q->protect, q->max_steiner, q->unsuitable != NULL};
    return par_hash(par_hash(hash, reals, sizeof reals), others, sizeof others);
}

static uint64_t hash_options(uint64_t hash, const struct par_options *o)
{
    const int64_t others[] = {o->by_block, o->margin, o->size_test_in_parallel};
    return par_hash(par_hash(hash, &o->cell_triangles, sizeof o->cell_triangles), others, sizeof others);
}

static uint64_t hash_mesh(uint64_t hash, const struct tri_mesh *m)
{
    const int64_t counts[] = {m->n_vertices, m->n_triangles, m->n_subs, m->n_regions, m->n_columns, m->n_attributes};
    size_t v = (size_t)m->n_vertices;
    hash = par_hash(hash, counts, sizeof counts);
    hash = par_hash(hash, &m->unit, sizeof m->unit);
    hash = par_hash(hash, m->xy, v * sizeof *m->xy);
    hash = par_hash(hash, m->on, v * sizeof *m->on);
    hash = par_hash(hash, m->vertex_markers, v * sizeof *m->vertex_markers);
    hash = par_hash(hash, m->attributes, v * (size_t)m->n_attributes * sizeof *m->attributes);
    hash = par_hash(hash, m->tri, (size_t)m->n_triangles * sizeof *m->tri);
    hash = par_hash(hash, m->sub, (size_t)m->n_subs * sizeof *m->sub);
    hash = par_hash(hash, m->regions, (size_t)m->n_regions * sizeof *m->regions);
    return par_hash(hash, m->columns, (size_t)m->n_regions * (size_t)m->n_columns * sizeof *m->columns);
}

uint64_t par_state_run(const struct par_state *state)
{
    uint64_t hash = hash_bounds(0, state->quality);
    hash = state->then ? hash_bounds(hash, state->then) : hash;
    return hash_mesh(hash_options(hash, state->options), state->mesh);
}

/* --- a head, and then arrays */

struct cells {
    int64_t n_columns, n_rows; /* 0: none */
    struct tri_point low, high;
    double estimate;
};

struct head {
    uint64_t word;
    int64_t next, odd, round, phase, numbered; /* enum par_next; 0, or the column of a sweep */
    int64_t n_vertices, n_triangles, n_subs, n_worklist, n_keys, n_done, n_held, n_spare[PAR_KINDS];
    int64_t tiles_vertices, tiles_triangles, tiles_segments;
    int64_t counts_remaining, n_remaining, remained[TRI_EXCUSES + 1];
    int64_t n_schedules, rounds, levels, schedule, prerefined, pauses, most_live, deferred, left_over;
    double radius, radius_measured, radius_lemma7, radius_theory;
    struct cells cells, first; /* of the schedule; of the first of the whole mesh, which is told of */
    struct tri_refine_report total;
};

static struct cells cells_of(const struct par_partition *p)
{
    return (struct cells){p->x ? p->n_columns : 0, p->x ? p->n_rows : 0, p->low, p->high, p->estimate};
}

static void set_report(struct head *h, const struct par_report *r)
{
    h->rounds = r->rounds;
    h->levels = r->levels;
    h->schedule = r->schedule;
    h->prerefined = r->prerefined;
    h->pauses = r->pauses;
    h->most_live = r->most_live;
    h->deferred = r->deferred;
    h->left_over = r->left_over;
    h->radius_measured = r->radius_measured;
    h->radius_lemma7 = r->radius_lemma7;
    h->radius_theory = r->radius_theory;
    h->total = r->total;
}

/* Lists are of use within a schedule alone. */
static struct head head_of(const struct par_state *state, const struct par_tiles *tiles, int32_t odd)
{
    const struct tri_mesh *m = state->mesh;
    const bool lists = tiles || par_is_phase(state->next) || par_is_rest(state->next);
    struct head h = {.word = STATE, .next = state->next, .odd = odd, .round = state->round,
                     .phase = state->phase, .n_done = state->done.n, .numbered = state->end == PAR_NUMBERED,
                     .n_vertices = m->n_vertices, .n_triangles = m->n_triangles, .n_subs = m->n_subs,
                     .n_worklist = lists ? state->worklist.n : 0, .n_keys = lists ? state->key.n : 0,
                     .n_schedules = state->n_schedules, .radius = state->radius};
    set_report(&h, state->report);
    for (int k = 0; k < PAR_KINDS; k++) {
        assert(state->spare.ranges[k].dealt == 0); /* no block is at work */
        h.n_spare[k] = state->spare.ranges[k].n;
    }
    if (!tiles) {
        h.cells = cells_of(&state->cells);
        h.first = cells_of(&state->report->partition);
        return h;
    }
    h.counts_remaining = state->counts_remaining;
    h.n_remaining = state->counts_remaining ? state->remaining.n : 0;
    memcpy(h.remained, state->remained, sizeof h.remained);
    h.n_held = tiles->held.n;
    h.tiles_vertices = tiles->n_vertices;
    h.tiles_triangles = tiles->n_triangles;
    h.tiles_segments = tiles->n_segments;
    return h;
}

static void carry_cells(struct par_state_file *f, const struct cells *cells, struct par_partition *p)
{
    const size_t n_x = (size_t)cells->n_columns, n_y = n_x * (size_t)cells->n_rows;
    par_carry(f, p->x, n_x * sizeof *p->x);
    par_carry(f, p->y, n_y * sizeof *p->y);
}

static void carry_mesh(struct par_state_file *f, const struct head *h, struct tri_mesh *m)
{
    const size_t v = (size_t)h->n_vertices;
    par_carry(f, m->xy, v * sizeof *m->xy);
    par_carry(f, m->on, v * sizeof *m->on);
    par_carry(f, m->vertex_markers, v * sizeof *m->vertex_markers);
    par_carry(f, m->feature, v * sizeof *m->feature);
    par_carry(f, m->attributes, v * (size_t)m->n_attributes * sizeof *m->attributes);
    par_carry(f, m->tri, (size_t)h->n_triangles * sizeof *m->tri);
    par_carry(f, m->sub, (size_t)h->n_subs * sizeof *m->sub);
}

/* tiles: NULL, or those of a sweep. */
static void carry_arrays(struct par_state_file *f, const struct head *h, struct par_state *state,
                         struct par_tiles *tiles)
{
    carry_mesh(f, h, state->mesh);
    par_carry(f, state->worklist.item, (size_t)h->n_worklist * sizeof *state->worklist.item);
    par_carry(f, state->key.item, (size_t)h->n_keys * sizeof *state->key.item);
    par_carry(f, state->done.item, (size_t)h->n_done * sizeof *state->done.item);
    for (int k = 0; k < PAR_KINDS; k++)
        par_carry(f, state->spare.ranges[k].item, (size_t)h->n_spare[k] * sizeof *state->spare.ranges[k].item);
    if (tiles) {
        par_carry(f, tiles->number, (size_t)h->n_vertices * sizeof *tiles->number);
        par_carry(f, tiles->held.item, (size_t)h->n_held * sizeof *tiles->held.item);
        par_carry(f, state->remaining.item, (size_t)h->n_remaining * sizeof *state->remaining.item);
        return;
    }
    carry_cells(f, &h->cells, &state->cells);
    carry_cells(f, &h->first, &state->report->partition);
}

/* --- writing */

/* What is carried. */
struct cargo {
    struct par_state *state;
    struct par_tiles *tiles; /* NULL: a mesh as a whole */
    int32_t *odd;
};

static enum tri_status put(struct par_state_file *f, void *user, struct tri_error *error)
{
    const struct cargo *cargo = user;
    struct head h = head_of(cargo->state, cargo->tiles, *cargo->odd);
    (void)error;
    par_carry_head(f, &h, sizeof h);
    carry_arrays(f, &h, cargo->state, cargo->tiles);
    return TRI_OK;
}

static enum tri_status save(struct par_checkpoint *c, const struct par_state *state, const struct par_tiles *tiles,
                            int32_t odd, struct tri_error *error)
{
    struct cargo cargo = {(struct par_state *)state, (struct par_tiles *)tiles, &odd}; /* which it only reads, but: */
    const double began = tri_seconds();
    if (tiles && !par_tiles_reserve(cargo.tiles)) /* vertices are new, amid a column */
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the numbers of vertices");
    enum tri_status status = par_checkpoint_write(c, tiles ? PAR_SWEPT_STATE : PAR_WHOLE_STATE, par_triangles(state),
                                                  put, &cargo, error);
    c->last = tri_seconds();
    c->cost = c->last - began;
    return status;
}

/* --- going on */

static bool is_count(int64_t n, int64_t least) { return n >= least && n <= INT32_MAX; }

static bool are_cells(const struct cells *c)
{
    const bool none = c->n_columns == 0 && c->n_rows == 0;
    return none || (is_count(c->n_columns, 3) && is_count(c->n_rows, 3) && is_count(c->n_columns * c->n_rows, 9));
}

static bool is_place(const struct head *h, const struct par_tiles *tiles)
{
    const bool in_column = h->next == PAR_COLUMN || h->next == PAR_COLUMN_PHASE;
    if (h->next < 0 || h->next > PAR_HAND_OUT || h->phase < 0 || h->phase > PAR_PHASES || h->round < 0 ||
        in_column != (tiles != NULL))
        return false;
    if (tiles)
        return h->odd % 2 == 1 && h->odd >= (h->next == PAR_COLUMN ? 3 : 1) &&
               h->odd <= tiles->partition->n_columns + 2;
    return h->odd == 0 && (h->cells.n_columns > 0 || !(par_is_phase((enum par_next)h->next) ||
                                                       par_is_rest((enum par_next)h->next)));
}

/* Could this be the head of a state of this run? */
static bool is_head(const struct head *h, const struct par_state *state, const struct par_tiles *tiles)
{
    const struct tri_mesh *m = state->mesh;
    bool counts = is_count(h->n_vertices, m->n_vertices) && is_count(h->n_triangles, 0) &&
                  is_count(h->n_subs, m->n_subs) && is_count(h->n_worklist, 0) && is_count(h->n_held, 0) &&
                  is_count(h->n_remaining, 0) &&
                  is_count(h->n_done, 0) &&
                  (h->n_keys == 0 || h->n_keys == h->n_worklist);
    for (int k = 0; k < PAR_KINDS; k++)
        counts = counts && is_count(h->n_spare[k], 0);
    return counts && h->word == STATE && are_cells(&h->cells) && are_cells(&h->first) && is_place(h, tiles);
}

static int32_t more(int64_t wanted, int32_t there) { return wanted > there ? (int32_t)wanted - there : 0; }

static enum tri_status reserve_mesh(const struct head *h, struct tri_mesh *m, struct tri_error *error)
{
    enum tri_status status = tri_mesh_reserve_vertices(m, more(h->n_vertices, m->n_vertices), error);
    status = status ? status : tri_mesh_reserve_triangles(m, more(h->n_triangles, m->n_triangles), error);
    return status ? status : tri_mesh_reserve_subs(m, more(h->n_subs, m->n_subs), error);
}

static bool reserve_cells(const struct cells *cells, struct par_partition *p)
{
    const size_t n_x = (size_t)cells->n_columns, n_y = n_x * (size_t)cells->n_rows;
    par_partition_free(p);
    if (n_x == 0)
        return true;
    *p = (struct par_partition){(int32_t)cells->n_columns, (int32_t)cells->n_rows, malloc(n_x * sizeof *p->x),
                                malloc(n_y * sizeof *p->y), cells->low, cells->high, cells->estimate};
    if (!p->x || !p->y)
        par_partition_free(p);
    return p->x;
}

static bool reserve_lists(const struct head *h, struct par_state *state, struct par_tiles *tiles)
{
    bool memory = tri_grow(&state->worklist.item, &state->worklist.capacity, (int32_t)h->n_worklist,
                           sizeof *state->worklist.item) &&
                  tri_grow(&state->key.item, &state->key.capacity, (int32_t)h->n_keys, sizeof *state->key.item) &&
                  tri_grow(&state->done.item, &state->done.capacity, (int32_t)h->n_done, sizeof *state->done.item);
    for (int k = 0; memory && k < PAR_KINDS; k++)
        memory = par_ranges_reserve(&state->spare.ranges[k], (int32_t)h->n_spare[k]);
    if (!tiles)
        return memory && reserve_cells(&h->cells, &state->cells) && reserve_cells(&h->first, &state->report->partition);
    return memory && par_tiles_reserve(tiles) &&
           tri_grow(&state->remaining.item, &state->remaining.capacity, (int32_t)h->n_remaining,
                    sizeof *state->remaining.item) &&
           tri_grow(&tiles->held.item, &tiles->held.capacity, (int32_t)h->n_held, sizeof *tiles->held.item);
}

static void get_report(const struct head *h, struct par_report *r)
{
    r->rounds = (int)h->rounds;
    r->levels = (int)h->levels;
    r->schedule = (int32_t)h->schedule;
    r->columns = r->partition.n_columns;
    r->rows = r->partition.n_rows;
    r->prerefined = h->prerefined;
    r->pauses = h->pauses;
    r->most_live = h->most_live;
    r->deferred = h->deferred;
    r->left_over = h->left_over;
    r->radius_measured = h->radius_measured;
    r->radius_lemma7 = h->radius_lemma7;
    r->radius_theory = h->radius_theory;
    r->total = h->total;
}

static void set_counts(const struct head *h, struct par_state *state, struct par_tiles *tiles)
{
    state->mesh->n_vertices = (int32_t)h->n_vertices;
    state->mesh->n_triangles = (int32_t)h->n_triangles;
    state->mesh->n_subs = (int32_t)h->n_subs;
    state->worklist.n = (int32_t)h->n_worklist;
    state->key.n = (int32_t)h->n_keys;
    state->n_schedules = (int32_t)h->n_schedules;
    state->done.n = (int32_t)h->n_done;
    state->next = (enum par_next)h->next;
    state->round = (int)h->round;
    state->phase = (int)h->phase;
    state->end = h->numbered != 0 ? PAR_NUMBERED : PAR_UNFINISHED;
    state->radius = h->radius;
    for (int k = 0; k < PAR_KINDS; k++)
        state->spare.ranges[k].n = (int32_t)h->n_spare[k];
    get_report(h, state->report);
    if (!tiles)
        return;
    state->counts_remaining = h->counts_remaining != 0;
    state->remaining.n = (int32_t)h->n_remaining;
    memcpy(state->remained, h->remained, sizeof state->remained);
    tiles->held.n = (int32_t)h->n_held;
    tiles->n_vertices = h->tiles_vertices;
    tiles->n_triangles = h->tiles_triangles;
    tiles->n_segments = h->tiles_segments;
    state->gone = h->tiles_triangles;
}

#ifndef NDEBUG
/* Do the lists of what has been read name triangles that are there, by keys that ascend? Links are not looked at: free
 * triangles are not marked yet. */
static bool is_state_sound(const struct par_state *state)
{
    const struct par_ids *list = &state->worklist;
    bool sound = state->mesh->n_vertices >= state->n_kept && (state->key.n == 0 || state->key.n == list->n);
    for (int32_t i = 0; sound && i < list->n; i++)
        sound = list->item[i] >= 0 && list->item[i] < state->mesh->n_triangles;
    for (int32_t i = 1; sound && i < state->key.n; i++)
        sound = state->key.item[i - 1] < state->key.item[i];
    return sound;
}
#endif

/* Nothing that counts changes before all has been checked. */
static enum tri_status get(struct par_state_file *f, void *user, struct tri_error *error)
{
    const struct cargo *cargo = user;
    struct par_state *state = cargo->state;
    struct head h = {0};
    par_carry_head(f, &h, sizeof h);
    f->failed = f->failed || !is_head(&h, state, cargo->tiles);
    enum tri_status status = TRI_OK;
    if (!f->failed && f->way == PAR_READ) {
        status = reserve_mesh(&h, state->mesh, error);
        if (!status && !reserve_lists(&h, state, cargo->tiles))
            status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the state of a checkpoint");
    }
    if (f->failed || status)
        return status;
    carry_arrays(f, &h, state, cargo->tiles);
    if (f->way == PAR_READ && !f->failed) {
        set_counts(&h, state, cargo->tiles);
        *cargo->odd = (int32_t)h.odd;
        assert(is_state_sound(state));
    }
    return TRI_OK;
}

static enum tri_status load(struct par_checkpoint *c, struct par_state *state, struct par_tiles *tiles, int32_t *odd,
                            struct tri_error *error)
{
    struct cargo cargo = {state, tiles, odd};
    return par_checkpoint_read(c, get, &cargo, error);
}

/* --- beginning and end of a run */

enum tri_status par_state_begin(struct par_checkpoint *c, struct par_state *state, struct tri_error *error)
{
    int32_t odd;
    c->stop = state->mesh->stop;
    c->last = tri_seconds();
    if (par_checkpoint_has_ranks(c)) /* whose hash of the same run is another one */
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of several tasks, and this mesh is to be made as a whole");
    enum tri_status status = par_checkpoint_take(c, par_state_run(state), error);
    state->stays = c->manifest.kind == PAR_WHOLE_STATE;
    if (status || !par_checkpoint_has_state(c))
        return status;
    if (!state->stays && !state->options->sink)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of a sweep, and this mesh is to be made as a whole");
    if (!state->stays)
        return TRI_OK;
    state->mesh->stop = NULL;
    return load(c, state, NULL, &odd, error);
}

void par_state_end(struct par_checkpoint *c, struct par_state *state) { state->mesh->stop = c->stop; }

/* --- a mesh that stays as a whole */

enum tri_status par_state_border(struct par_checkpoint *c, struct par_state *state, bool surely,
                                 struct tri_error *error)
{
    state->mesh->stop = NULL;
    const bool asked = tri_stop_is_asked(c->stop);
    if (!asked && !surely && tri_seconds() - c->last < c->seconds)
        return TRI_OK;
    enum tri_status status = save(c, state, NULL, 0, error);
    return status || !asked ? status : tri_fail_stopped(error);
}

void par_state_let_stop(struct par_checkpoint *c, struct par_state *state) { state->mesh->stop = c->stop; }

/* Asked by blocks before they begin. It does not stay true: a halt ends. */
static bool is_halt_due(void *user)
{
    const struct par_checkpoint *c = user;
    const double passed = tri_seconds() - c->last;
    return tri_stop_is_asked(c->stop) || (passed >= c->seconds && passed >= 9 * c->cost);
}

enum tri_status par_state_phase(struct par_checkpoint *c, struct par_state *state,
                                const struct par_partition *partition, const struct par_tiles *tiles, int32_t only,
                                struct tri_error *error)
{
    const struct tri_stop halt = {is_halt_due, c};
    enum tri_status status;
    do {
        state->halt = state->options->by_block ? NULL : &halt;
        status = par_phase(state, partition, state->phase, only, error);
        state->halt = NULL;
        if (status != TRI_STOPPED)
            break;
        status = save(c, state, tiles, tiles ? only | 1 : 0, error); /* with the odd column beside an even one */
        if (!status && tri_stop_is_asked(c->stop))
            status = tri_fail_stopped(error);
    } while (!status);
    return status;
}

/* --- a sweep */

enum tri_status par_state_begin_sweep(struct par_checkpoint *c, struct par_state *state, struct par_tiles *tiles,
                                      int32_t *odd, struct tri_error *error)
{
    const bool again = par_checkpoint_has_state(c);
    c->spool.to = tiles->sink;
    c->spool.again = again;
    c->sink = par_spool_sink(&c->spool);
    tiles->sink = &c->sink;
    state->mesh->stop = NULL;
    enum tri_status status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    return status || !again ? status : load(c, state, tiles, odd, error);
}

enum tri_status par_state_column(struct par_checkpoint *c, struct par_state *state, const struct par_tiles *tiles,
                                 int32_t odd, struct tri_error *error)
{
    state->mesh->stop = NULL;
    bool asked = tri_stop_is_asked(c->stop), failed = c->spool.failed != TRI_OK;
    if (!asked && !failed && tri_seconds() - c->last < c->seconds)
        return TRI_OK;
    if (failed)
        return par_state_last_column(c, state, tiles, odd, error);
    enum tri_status status = save(c, state, tiles, odd, error);
    return status || !asked ? status : tri_fail_stopped(error);
}

/* Whether the state could be saved or not, what the taker said is told. */
enum tri_status par_state_last_column(struct par_checkpoint *c, const struct par_state *state,
                                      const struct par_tiles *tiles, int32_t odd, struct tri_error *error)
{
    if (!c->spool.failed)
        return TRI_OK;
    (void)save(c, state, tiles, odd, NULL);
    if (error)
        *error = c->spool.failure;
    return c->spool.failed;
}

enum tri_status par_state_give_up_sweep(struct par_checkpoint *c, struct par_state *state, struct tri_error *error)
{
    state->mesh->stop = c->stop;
    return par_checkpoint_forget(c, PAR_WHOLE_STATE, error);
}
