/* Writing and reading the state of a run, and the decision when to write one. One function for each part of a state
 * (carry_...) both writes and reads it, so both have the same format. Arrays have the same layout as in memory, so a
 * state can be read only on the same kind of machine. */
#include "sched/checkpoint/state.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/phase.h"
#include "sched/tunables.h"
#include "triangle/base/system.h"
#include "triangle/base/grow.h"
#include "triangle/base/hash.h"

/* --- the hash that identifies a run */

/* Hashes the bounds. Optional ones are hashed only if they are set, so that runs without them keep their hash. */
static uint64_t hash_bounds(uint64_t hash, const struct tri_quality *q)
{
    const double reals[] = {q->min_angle, q->max_area, q->area_scale};
    const int64_t others[] = {q->region_areas, q->conforming, q->protect, q->max_steiner, tri_asks_caller(q),
                              q->lattice};
    const uint64_t lengths[] = {q->lengths ? tri_lengths_hash(q->lengths) : 0, q->front};
    hash = tri_hash(tri_hash(hash, reals, sizeof reals), others, sizeof others);
    hash = q->lengths ? tri_hash(hash, lengths, sizeof lengths) : hash;
    return q->passes > 0 ? tri_hash(hash, &q->passes, sizeof q->passes) : hash;
}

/* Hashes the options on which the mesh depends. The number of threads and the memory limit are not among them. */
static uint64_t hash_options(uint64_t hash, const struct par_options *o)
{
    const int64_t others[] = {o->by_block, o->size_test_in_parallel};
    return tri_hash(tri_hash(hash, &o->cell_triangles, sizeof o->cell_triangles), others, sizeof others);
}

/* Hashes the initial mesh. n_kept: number of vertices before refinement, which alone have attributes. */
static uint64_t hash_mesh(uint64_t hash, const struct tri_mesh *m, int32_t n_kept)
{
    const int64_t counts[] = {m->n_vertices, m->n_triangles, m->n_subs, m->n_regions, m->n_columns, m->n_attributes};
    size_t v = (size_t)m->n_vertices;
    hash = tri_hash(hash, counts, sizeof counts);
    hash = tri_hash(hash, &m->unit, sizeof m->unit);
    hash = tri_hash(hash, m->xy, v * sizeof *m->xy);
    hash = tri_hash(hash, m->on, v * sizeof *m->on);
    hash = tri_hash(hash, m->vertex_markers, v * sizeof *m->vertex_markers);
    hash = tri_hash(hash, m->attributes, (size_t)n_kept * (size_t)m->n_attributes * sizeof *m->attributes);
    hash = tri_hash(hash, m->tri, (size_t)m->n_triangles * sizeof *m->tri);
    hash = tri_hash(hash, m->sub, (size_t)m->n_subs * sizeof *m->sub);
    hash = tri_hash(hash, m->regions, (size_t)m->n_regions * sizeof *m->regions);
    return tri_hash(hash, m->columns, (size_t)m->n_regions * (size_t)m->n_columns * sizeof *m->columns);
}

uint64_t par_state_run(const struct par_run *run)
{
    const uint64_t hash = hash_options(hash_bounds(0, run->asked.quality), run->asked.options);
    return hash_mesh(hash, run->mesh, run->asked.n_kept);
}

/* --- the parts of a state, written to a file or read from it */

/* The data that a walk over a state writes or reads. */
struct cargo {
    struct par_run *run;     /* the run */
    struct par_tiles *tiles; /* the tiles of a sweep; NULL: the mesh is kept as a whole */
    bool memory;             /* false: memory ran out; the rest is skipped */
};

#define CARRY(file, field) par_carry(file, &(field), sizeof(field))

/* The position. `column` is stored by carry_sweep; level is 0 in every state. */
static void carry_place(struct par_state_file *f, struct par_run *run)
{
    CARRY(f, run->place.next);
    CARRY(f, run->place.round);
    CARRY(f, run->place.phase);
    CARRY(f, run->n_schedules);
    CARRY(f, run->radius);
}

/* The counts of the report that the end of the run adds to. Times are not kept. */
static void carry_report(struct par_state_file *f, struct par_report *r)
{
    CARRY(f, r->rounds);
    CARRY(f, r->levels);
    CARRY(f, r->schedule);
    CARRY(f, r->columns);
    CARRY(f, r->rows);
    CARRY(f, r->prerefined);
    CARRY(f, r->pauses);
    CARRY(f, r->most_live);
    CARRY(f, r->deferred);
    CARRY(f, r->left_over);
    CARRY(f, r->radius_measured);
    CARRY(f, r->radius_lemma7);
    CARRY(f, r->radius_theory);
    CARRY(f, r->total);
}

/* A list of *n items. array: address of the pointer to the items, which may move when the list grows for reading. */
static void carry_items(struct cargo *cargo, struct par_state_file *f, void *array, int32_t *n, int32_t *capacity,
                        size_t item)
{
    int32_t wanted = *n;
    void *items;
    /* When reading, this replaces the number by that in the file. */
    CARRY(f, wanted);
    cargo->memory = cargo->memory && tri_grow(array, capacity, wanted, item);
    *n = cargo->memory ? wanted : 0;
    memcpy(&items, array, sizeof items);
    par_carry(f, items, (size_t)*n * item);
}

#define CARRY_LIST(cargo, f, list) \
    carry_items(cargo, f, &(list).item, &(list).n, &(list).capacity, sizeof *(list).item)

/* The cells, which may be empty. When reading, the arrays of *p are replaced. */
static void carry_partition(struct cargo *cargo, struct par_state_file *f, struct par_partition *p)
{
    struct par_partition as = *p;
    CARRY(f, as.n_columns);
    CARRY(f, as.n_rows);
    CARRY(f, as.low);
    CARRY(f, as.high);
    CARRY(f, as.estimate);
    const size_t n_x = (size_t)as.n_columns, n_y = n_x * (size_t)as.n_rows;
    /* Allocate arrays for the cells in the file. */
    if (f->reads && n_x > 0) {
        par_partition_free(p);
        as.x = malloc(n_x * sizeof *p->x);
        as.y = malloc(n_y * sizeof *p->y);
        cargo->memory = cargo->memory && as.x && as.y;
        *p = as;
    }
    if (cargo->memory) {
        par_carry(f, p->x, n_x * sizeof *p->x);
        par_carry(f, p->y, n_y * sizeof *p->y);
    }
}

/* Returns how many items are missing. */
static int32_t items_missing(int32_t wanted, int32_t there) { return wanted > there ? wanted - there : 0; }

/* The counts of the mesh. When reading, its arrays grow to hold them. */
static void carry_counts(struct cargo *cargo, struct par_state_file *f, struct tri_mesh *m)
{
    int32_t v = m->n_vertices, t = m->n_triangles, s = m->n_subs;
    CARRY(f, v);
    CARRY(f, t);
    CARRY(f, s);
    cargo->memory = cargo->memory && tri_mesh_reserve_vertices(m, items_missing(v, m->n_vertices), NULL) == TRI_OK &&
                    tri_mesh_reserve_triangles(m, items_missing(t, m->n_triangles), NULL) == TRI_OK &&
                    tri_mesh_reserve_subs(m, items_missing(s, m->n_subs), NULL) == TRI_OK;
    if (cargo->memory) {
        m->n_vertices = v;
        m->n_triangles = t;
        m->n_subs = s;
    }
}

/* The arrays of the mesh that refinement changes. carry_counts must come first. */
static void carry_mesh(struct par_state_file *f, struct tri_mesh *m)
{
    const size_t v = (size_t)m->n_vertices;
    par_carry(f, m->xy, v * sizeof *m->xy);
    par_carry(f, m->on, v * sizeof *m->on);
    par_carry(f, m->vertex_markers, v * sizeof *m->vertex_markers);
    par_carry(f, m->feature, v * sizeof *m->feature);
    if (m->has_lengths)
        par_carry(f, m->length, v * sizeof *m->length);
    par_carry(f, m->tri, (size_t)m->n_triangles * sizeof *m->tri);
    par_carry(f, m->sub, (size_t)m->n_subs * sizeof *m->sub);
}

/* The data of a sweep: column, counts of bad triangles and of tiles, numbers of vertices, and vertices that are held
 * back. */
static void carry_sweep(struct cargo *cargo, struct par_state_file *f)
{
    struct par_run *run = cargo->run;
    struct par_tiles *tiles = cargo->tiles;
    CARRY(f, run->place.column);
    CARRY(f, run->remain.is_on);
    CARRY(f, run->remain.counted);
    CARRY(f, tiles->n_vertices);
    CARRY(f, tiles->n_triangles);
    CARRY(f, tiles->n_segments);
    /* All triangles that were handed out have left the mesh. */
    run->gone = tiles->n_triangles;
    cargo->memory = cargo->memory && par_tiles_reserve(tiles);
    if (cargo->memory)
        par_carry(f, tiles->number, (size_t)run->mesh->n_vertices * sizeof *tiles->number);
    CARRY_LIST(cargo, f, tiles->held);
    CARRY_LIST(cargo, f, run->remain.listed);
}

/* A par_state_walk: the whole state. The file holds, in this order: position, report, worklist with keys, blocks that
 * are done, spare room, counts and arrays of the mesh, and then either the data of a sweep or the cells. */
static enum tri_status carry(struct par_state_file *f, void *user, struct tri_error *error)
{
    struct cargo *cargo = user;
    struct par_run *run = cargo->run;
    carry_place(f, run);
    carry_report(f, run->report);
    CARRY_LIST(cargo, f, run->worklist);
    CARRY_LIST(cargo, f, run->key);
    CARRY_LIST(cargo, f, run->place.done);
    for (int k = 0; k < PAR_KINDS; k++) {
        assert(run->spare.ranges[k].dealt == 0); /* no block is running, so no range is dealt out */
        CARRY_LIST(cargo, f, run->spare.ranges[k]);
    }
    carry_counts(cargo, f, run->mesh);
    if (cargo->memory)
        carry_mesh(f, run->mesh);
    if (cargo->tiles) { /* the cells of a sweep are made again from the input, so they are not stored */
        carry_sweep(cargo, f);
    } else {
        carry_partition(cargo, f, &run->cells);
        carry_partition(cargo, f, &run->report->partition);
    }
    return cargo->memory ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a state");
}

/* --- when a state is written */

bool par_state_is_last(const struct par_checkpoint *c, double now, double triangles)
{
    const double growth = fmax(triangles / fmax(c->size, 1), 1); /* the part of the cost that grows with the mesh;
                                                                    unused room is only read, not written */
    const bool measured = c->writing >= PAR_STATE_MEASURES;
    const double lead = measured ? 2 * (c->cost + (growth - 1) * c->writing) : 0;
    return c->limit > 0 && c->saved > 0 && c->limit - now <= lead;
}

bool par_state_is_due(const struct par_checkpoint *c, double now, double triangles)
{
    static const double EARLY = 0.01; /* share of the time until the limit, after which the first state measures the
                                         disk: early enough even for a disk that is 30 times as slow as the mesher */
    const bool measures = c->limit > 0 && c->writing < PAR_STATE_MEASURES;
    const bool resumed = c->saved == 0 && par_checkpoint_has_state(c); /* a resumed run must first make progress */
    const double wait = measures ? fmin(c->seconds, (resumed ? 0.5 : EARLY) * (c->limit - c->last)) : c->seconds;
    return now - c->last >= wait || par_state_is_last(c, now, triangles);
}

/* Returns the number of triangles in memory. */
static double live_triangles(const struct par_run *run) { return (double)(par_triangles(run) - run->gone); }

/* Writes a state, and measures how long it takes. If it is the last state before the limit, requests the end of the
 * run. Called on the calling thread while no block runs. */
static enum tri_status save(struct par_checkpoint *c, struct par_run *run, struct par_tiles *tiles,
                            struct tri_error *error)
{
    struct cargo cargo = {run, tiles, true};
    const double began = tri_seconds();
    enum tri_status status = par_checkpoint_write(c, tiles ? PAR_SWEPT_STATE : PAR_WHOLE_STATE, 0,
                                                  par_triangles(run), carry, &cargo, error);
    c->last = tri_seconds();
    c->cost = c->last - began;
    c->size = live_triangles(run);
    if (!status && c->time_up && par_state_is_last(c, c->last, c->size))
        c->time_up();
    return status;
}

#ifndef NDEBUG
/* Called after reading. Returns whether the worklist's entries name existing triangles, and the keys ascend. Links of
 * triangles are not checked, since free triangles have not been marked yet. */
static bool is_state_sound(const struct par_run *run)
{
    const struct par_ids *list = &run->worklist;
    bool sound = run->mesh->n_vertices >= run->asked.n_kept && (run->key.n == 0 || run->key.n == list->n);
    for (int32_t i = 0; sound && i < list->n; i++)
        sound = list->item[i] >= 0 && list->item[i] < run->mesh->n_triangles;
    for (int32_t i = 1; sound && i < run->key.n; i++)
        sound = run->key.item[i - 1] < run->key.item[i];
    return sound;
}
#endif

/* Reads the state of the checkpoint into the run. */
static enum tri_status load(struct par_checkpoint *c, struct par_run *run, struct par_tiles *tiles,
                            struct tri_error *error)
{
    struct cargo cargo = {run, tiles, true};
    enum tri_status status = par_checkpoint_read(c, carry, &cargo, error);
    assert(status || is_state_sound(run));
    return status;
}

/* --- beginning and end of a run */

enum tri_status par_state_begin(struct par_checkpoint *c, struct par_run *run, struct tri_error *error)
{
    c->stop = run->mesh->stop;
    c->last = tri_seconds();
    if (par_checkpoint_has_ranks(c)) /* checked first, since ranks compute a different hash for the same run */
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of several tasks, but this run keeps the mesh as a whole");
    enum tri_status status = par_checkpoint_take(c, par_state_run(run), error);
    const bool is_whole = c->manifest.kind == PAR_WHOLE_STATE;
    if (!status && par_checkpoint_has_state(c) && !is_whole && !run->asked.options->sink)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of a sweep, but this run keeps the mesh as a whole");
    /* While the state is read, only par_checkpoint_read checks for a requested end, before it changes anything. */
    if (!status && par_checkpoint_has_state(c) && is_whole) {
        run->mesh->stop = NULL;
        status = load(c, run, NULL, error);
    }
    /* A state of a whole mesh, or a sweep that was given up: the mesh must not be swept again. */
    if (is_whole && run->place.next == PAR_BOUNDS)
        run->place.next = PAR_BOUNDS_WHOLE;
    return status;
}

/* --- states between steps and during phases */

enum tri_status par_state_border(struct par_checkpoint *c, struct par_run *run, struct par_tiles *tiles,
                                 bool surely, struct tri_error *error)
{
    /* The receiver of the tiles has failed: save the state before reporting it. */
    const bool failed = tiles && c->spool.failed, due = par_state_is_due(c, tri_seconds(), live_triangles(run));
    run->mesh->stop = NULL;
    if (!tri_stop_is_asked(c->stop) && !surely && !failed && !due)
        return TRI_OK;
    enum tri_status status = save(c, run, tiles, error);
    if (failed && error) /* regardless of whether the state could be written */
        *error = c->spool.failure;
    if (failed)
        return c->spool.failed;
    return status || !tri_stop_is_asked(c->stop) ? status : tri_fail_stopped(error);
}

/* A tri_stop callback: returns whether a halt is due, to write a state. Called before each block begins, on any thread;
 * it only reads the checkpoint and an atomic count. It may return false again later, since the halt ends when the state
 * has been written. States take at most a tenth of the time: one is due only after PAR_STATE_REST times the duration of
 * the last. */
static bool is_halt_due(void *user)
{
    const struct par_run *run = user;
    const struct par_checkpoint *c = run->asked.options->checkpoint;
    const double now = tri_seconds();
    const double triangles = (double)(atomic_load_explicit(&run->reached, memory_order_relaxed) - run->gone);
    return tri_stop_is_asked(c->stop) || par_state_is_last(c, now, triangles) ||
           (par_state_is_due(c, now, triangles) && now - c->last >= PAR_STATE_REST * c->cost);
}

/* Runs the phase until it ends. Each halt ends par_phase with TRI_STOPPED; a state is written, and the loop runs the
 * remaining blocks, unless the caller has requested the end. */
enum tri_status par_state_phase(struct par_checkpoint *c, struct par_run *run, struct par_turn turn,
                                struct par_tiles *tiles, struct tri_error *error)
{
    const struct tri_stop halt = {is_halt_due, run};
    enum tri_status status;
    turn.halt = run->asked.options->by_block ? NULL : &halt;
    do {
        status = par_phase(run, &turn, error);
        if (status != TRI_STOPPED)
            break;
        /* A halt: no block is running now, and place.done lists the blocks that have ended. */
        status = save(c, run, tiles, error);
        if (!status && tri_stop_is_asked(c->stop))
            status = tri_fail_stopped(error);
    } while (!status);
    return status;
}

/* --- a sweep */

enum tri_status par_state_begin_sweep(struct par_checkpoint *c, struct par_run *run, struct par_tiles *tiles,
                                      struct tri_error *error)
{
    const bool again = par_checkpoint_has_sweep(c); /* false if there is only a state of an earlier step */
    c->spool.to = tiles->sink;
    c->spool.again = again;
    c->sink = par_spool_sink(&c->spool);
    tiles->sink = &c->sink;
    run->mesh->stop = NULL;
    enum tri_status status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    return status || !again ? status : load(c, run, tiles, error);
}

enum tri_status par_state_give_up_sweep(struct par_checkpoint *c, struct par_run *run, struct tri_error *error)
{
    run->mesh->stop = c->stop;
    return par_checkpoint_forget(c, PAR_WHOLE_STATE, error);
}
