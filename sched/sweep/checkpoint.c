/* Files are those of the machine that wrote them: arrays as they lie in memory. */
#include "sched/sweep/checkpoint.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "sched/phase.h"
#include "sched/sweep/tiles.h"
#include "triangle/clock.h"
#include "triangle/grow.h"

static const uint64_t MANIFEST = UINT64_C(0x326863697274706b), STATE = UINT64_C(0x3265746174736974); /* versions, too */

static const char *const state_name[2] = {"state-0", "state-1"};
static const char piece_prefix[] = "piece-";
static const char manifest_name[] = "manifest", fresh_name[] = "manifest-new", tiles_name[] = "tiles";

/* --- files in the directory */

static void path_of(char path[PAR_CHECKPOINT_PATH], const char *directory, const char *name)
{
    snprintf(path, PAR_CHECKPOINT_PATH, "%s/%s", directory, name);
}

static int open_in(const char *directory, const char *name, int flags)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, name);
    return open(path, flags | O_CLOEXEC, 0666);
}

static enum tri_status cannot_write(const char *directory, const char *name, struct tri_error *error)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, name);
    return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "cannot write: %s", strerror(errno));
}

bool par_checkpoint_sync(const char *directory)
{
    int file = open(directory, O_RDONLY | O_CLOEXEC);
    bool done = file >= 0 && (fsync(file) == 0 || errno == EINVAL);
    if (file >= 0)
        close(file);
    return done;
}

/* --- manifest */

static uint64_t hash_of(const struct par_manifest *m)
{
    return par_hash(0, &m->of, sizeof *m - offsetof(struct par_manifest, of));
}

static bool is_manifest(const struct par_manifest *m)
{
    return m->word == MANIFEST && m->hash == hash_of(m) && (m->which == 0 || m->which == 1) && m->state_bytes >= 0 &&
           m->tiles_bytes >= 0 && m->n_ranks >= 0 && m->n_ranks <= INT32_MAX;
}

static enum tri_status read_manifest(struct par_manifest *m, const char *directory, struct tri_error *error)
{
    int file = open_in(directory, manifest_name, O_RDONLY);
    if (file < 0)
        return tri_fail(error, TRI_BAD_INPUT, directory, 0, "holds no checkpoint: %s", strerror(errno));
    bool whole = par_read_at(file, m, sizeof *m, 0) && is_manifest(m);
    close(file);
    if (whole)
        return TRI_OK;
    return tri_fail(error, TRI_BAD_INPUT, directory, 0, "the checkpoint's manifest is damaged, or of another version");
}

static enum tri_status write_manifest(struct par_checkpoint *c, struct par_manifest m, struct tri_error *error)
{
    char from[PAR_CHECKPOINT_PATH], to[PAR_CHECKPOINT_PATH];
    int file = open_in(c->directory, fresh_name, O_WRONLY | O_CREAT | O_TRUNC);
    m.word = MANIFEST;
    m.hash = hash_of(&m);
    bool done = file >= 0 && par_write_at(file, &m, sizeof m, 0) && fsync(file) == 0;
    if (file >= 0)
        done = close(file) == 0 && done;
    path_of(from, c->directory, fresh_name);
    path_of(to, c->directory, manifest_name);
    if (!done || rename(from, to) != 0 || !par_checkpoint_sync(c->directory))
        return cannot_write(c->directory, manifest_name, error);
    c->manifest = m;
    return TRI_OK;
}

/* --- opening and closing */

bool par_checkpoint_is_there(const char *directory)
{
    char path[PAR_CHECKPOINT_PATH];
    path_of(path, directory, manifest_name);
    return access(path, F_OK) == 0;
}

/* One process at a time; where there are no locks, nobody is kept out. */
static bool take_directory(struct par_checkpoint *c)
{
    struct flock whole = {.l_type = F_WRLCK, .l_whence = SEEK_SET};
    c->lock = open_in(c->directory, tiles_name, O_RDWR | O_CREAT);
    return c->lock >= 0 && (fcntl(c->lock, F_SETLK, &whole) == 0 || (errno != EACCES && errno != EAGAIN));
}

static enum tri_status check_run(const struct par_checkpoint *c, bool resume, uint64_t of, struct tri_error *error)
{
    struct par_manifest m;
    if (!resume && par_checkpoint_is_there(c->directory))
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds the checkpoint of a run already");
    enum tri_status status = resume ? read_manifest(&m, c->directory, error) : TRI_OK;
    if (!status && resume && m.of != of)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "holds a checkpoint of another version of the program");
    return status;
}

enum tri_status par_checkpoint_open(struct par_checkpoint *c, const char *directory, bool resume, uint64_t of,
                                    struct tri_error *error)
{
    *c = (struct par_checkpoint){.directory = directory, .lock = -1};
    if (strlen(directory) > PAR_CHECKPOINT_PATH - 32)
        return tri_fail(error, TRI_BAD_INPUT, NULL, 0, "the name of the directory for checkpoints is too long");
    if (!resume && mkdir(directory, 0777) != 0 && errno != EEXIST)
        return tri_fail(error, TRI_CANNOT_WRITE, directory, 0, "cannot be made: %s", strerror(errno));
    enum tri_status status = check_run(c, resume, of, error);
    if (status)
        return status;
    if (!take_directory(c)) {
        bool held = c->lock >= 0;
        status = held ? tri_fail(error, TRI_BAD_INPUT, directory, 0, "another process works on this checkpoint")
                      : cannot_write(directory, tiles_name, error);
    }
    status = status || !resume ? status : read_manifest(&c->manifest, directory, error);
    if (!status && !resume)
        status = write_manifest(c, (struct par_manifest){.of = of}, error);
    path_of(c->tiles_path, directory, tiles_name);
    c->spool = (struct par_spool){.file = c->lock, .path = c->tiles_path, .length = c->manifest.tiles_bytes};
    if (status)
        par_checkpoint_close(c, false);
    return status;
}

void par_checkpoint_piece(char path[PAR_CHECKPOINT_PATH], const char *directory, int64_t which, int rank)
{
    snprintf(path, PAR_CHECKPOINT_PATH, "%s/%s%d-%d", directory, piece_prefix, (int)which, rank);
}

/* Of however many ranks there have been. */
static void remove_pieces(const char *path)
{
    DIR *directory = opendir(path);
    char piece[PAR_CHECKPOINT_PATH];
    for (const struct dirent *entry; directory && (entry = readdir(directory));)
        if (strncmp(entry->d_name, piece_prefix, sizeof piece_prefix - 1) == 0 && strlen(entry->d_name) < 32) {
            path_of(piece, path, entry->d_name);
            unlink(piece);
        }
    if (directory)
        closedir(directory);
}

void par_checkpoint_close(struct par_checkpoint *c, bool remove)
{
    const char *const names[] = {manifest_name, fresh_name, state_name[0], state_name[1], tiles_name};
    for (size_t i = 0; remove && i < sizeof names / sizeof *names; i++) { /* the manifest first: then no run is left */
        char path[PAR_CHECKPOINT_PATH];
        path_of(path, c->directory, names[i]);
        unlink(path);
    }
    if (remove) {
        remove_pieces(c->directory);
        rmdir(c->directory);
    }
    if (c->lock >= 0)
        close(c->lock);
    c->lock = -1;
}

/* --- of which run */

static uint64_t hash_bounds(uint64_t hash, const struct tri_refine_options *q)
{
    const double reals[] = {q->min_angle, q->max_area, q->area_scale};
    const int64_t others[] = {q->region_areas, q->conforming, q->protect, q->max_steiner, q->unsuitable != NULL};
    return par_hash(par_hash(hash, reals, sizeof reals), others, sizeof others);
}

static uint64_t hash_mesh(uint64_t hash, const struct tri_mesh *m)
{
    size_t v = (size_t)m->n_vertices;
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

uint64_t par_checkpoint_run(const struct par_state *state, const struct par_partition *p)
{
    const int64_t counts[] = {p->n_columns, p->n_rows, state->n_kept, state->worklist.n, state->mesh->n_vertices,
                              state->mesh->n_triangles, state->mesh->n_subs};
    uint64_t hash = par_hash(hash_bounds(0, state->quality), counts, sizeof counts);
    hash = par_hash(hash, p->x, (size_t)p->n_columns * sizeof *p->x);
    hash = par_hash(hash, p->y, (size_t)p->n_columns * (size_t)p->n_rows * sizeof *p->y);
    hash = par_hash(hash, state->worklist.item, (size_t)state->worklist.n * sizeof *state->worklist.item);
    return hash_mesh(hash, state->mesh);
}

enum tri_status par_checkpoint_check(const struct par_checkpoint *c, uint64_t run, struct tri_error *error)
{
    if (par_checkpoint_has_state(c) && run != c->manifest.run)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0,
                        "is the checkpoint of another run: of another input, or with other switches");
    return TRI_OK;
}

/* --- state: a head, and then arrays, the same walk for writing and reading */

struct head {
    uint64_t word;
    int64_t odd, round;
    int64_t n_vertices, n_triangles, n_subs, n_worklist, n_keys, n_held, n_spare[PAR_KINDS];
    int64_t tiles_vertices, tiles_triangles, tiles_segments;
    int64_t pauses, most_live, deferred, left_over;
    double radius;
    struct tri_refine_report total;
};

/* A state's file while it is written or read. */
struct carrier {
    int file;
    bool writing;
    int64_t place;
    uint64_t hash;
    bool failed;
};

static void carry(struct carrier *c, void *bytes, size_t n)
{
    if (!c->failed && n > 0)
        c->failed = c->writing ? !par_write_at(c->file, bytes, n, c->place) : !par_read_at(c->file, bytes, n, c->place);
    if (!c->failed)
        c->hash = par_hash(c->hash, bytes, n);
    c->place += (int64_t)n;
}

static struct head head_of(const struct par_state *state, const struct par_tiles *tiles, int32_t odd)
{
    const struct tri_mesh *m = state->mesh;
    const struct par_report *r = state->report;
    struct head h = {.word = STATE, .odd = odd, .round = state->round,
                     .n_vertices = m->n_vertices, .n_triangles = m->n_triangles, .n_subs = m->n_subs,
                     .n_worklist = state->worklist.n, .n_keys = state->key.n, .n_held = tiles->held.n,
                     .tiles_vertices = tiles->n_vertices, .tiles_triangles = tiles->n_triangles,
                     .tiles_segments = tiles->n_segments, .pauses = r->pauses,
                     .most_live = r->most_live, .deferred = r->deferred, .left_over = r->left_over,
                     .radius = state->radius, .total = r->total};
    for (int k = 0; k < PAR_KINDS; k++)
        h.n_spare[k] = state->spare.ranges[k].n;
    return h;
}

/* All arrays of which the head tells the lengths; there is room for them. */
static void carry_arrays(struct carrier *c, const struct head *h, struct par_state *state, struct par_tiles *tiles)
{
    struct tri_mesh *m = state->mesh;
    size_t v = (size_t)h->n_vertices;
    carry(c, m->xy, v * sizeof *m->xy);
    carry(c, m->on, v * sizeof *m->on);
    carry(c, m->vertex_markers, v * sizeof *m->vertex_markers);
    carry(c, m->feature, v * sizeof *m->feature);
    carry(c, m->attributes, v * (size_t)m->n_attributes * sizeof *m->attributes);
    carry(c, tiles->number, v * sizeof *tiles->number);
    carry(c, m->tri, (size_t)h->n_triangles * sizeof *m->tri);
    carry(c, m->sub, (size_t)h->n_subs * sizeof *m->sub);
    carry(c, state->worklist.item, (size_t)h->n_worklist * sizeof *state->worklist.item);
    carry(c, state->key.item, (size_t)h->n_keys * sizeof *state->key.item);
    carry(c, tiles->held.item, (size_t)h->n_held * sizeof *tiles->held.item);
    for (int k = 0; k < PAR_KINDS; k++)
        carry(c, state->spare.ranges[k].item, (size_t)h->n_spare[k] * sizeof *state->spare.ranges[k].item);
}

static enum tri_status save(struct par_checkpoint *c, const struct par_state *state, const struct par_tiles *tiles,
                            int32_t odd, struct tri_error *error)
{
    struct par_manifest m = c->manifest;
    struct head h = head_of(state, tiles, odd);
    m.which = par_checkpoint_next(&c->manifest);
    m.n_ranks = 0;
    const char *name = state_name[m.which];
    struct carrier to = {.file = open_in(c->directory, name, O_WRONLY | O_CREAT | O_TRUNC), .writing = true};
    to.failed = to.file < 0;
    carry(&to, &h, sizeof h);
    carry_arrays(&to, &h, (struct par_state *)state, (struct par_tiles *)tiles); /* which it only reads, writing */
    bool done = !to.failed && fsync(to.file) == 0;
    if (to.file >= 0)
        done = close(to.file) == 0 && done;
    if (!done)
        return cannot_write(c->directory, name, error);
    if (fsync(c->spool.file) != 0)
        return cannot_write(c->directory, tiles_name, error);
    m.state_bytes = to.place;
    m.state_hash = to.hash;
    m.tiles_bytes = c->spool.length;
    m.triangles = tiles->n_triangles;
    enum tri_status status = write_manifest(c, m, error);
    c->saved += !status;
    return status;
}

/* --- going on */

static enum tri_status damaged(const struct par_checkpoint *c, const char *name, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "the checkpoint's file %s is damaged", name);
}

static bool is_count(int64_t n, int64_t least) { return n >= least && n <= INT32_MAX; }

/* Could this be the head of a state of this run? */
static bool is_head(const struct head *h, const struct par_state *state, const struct par_partition *partition)
{
    const struct tri_mesh *m = state->mesh;
    bool counts = is_count(h->n_vertices, m->n_vertices) && is_count(h->n_triangles, m->n_triangles) &&
                  is_count(h->n_subs, m->n_subs) && is_count(h->n_worklist, 0) && is_count(h->n_held, 0) &&
                  (h->n_keys == 0 || h->n_keys == h->n_worklist);
    for (int k = 0; k < PAR_KINDS; k++)
        counts = counts && is_count(h->n_spare[k], 0);
    return counts && h->word == STATE && h->odd > 1 && h->odd % 2 == 1 && h->odd <= partition->n_columns + 2;
}

static enum tri_status reserve(const struct head *h, struct par_state *state, struct par_tiles *tiles,
                               struct tri_error *error)
{
    struct tri_mesh *m = state->mesh;
    enum tri_status status = tri_mesh_reserve_vertices(m, (int32_t)h->n_vertices - m->n_vertices, error);
    status = status ? status : tri_mesh_reserve_triangles(m, (int32_t)h->n_triangles - m->n_triangles, error);
    status = status ? status : tri_mesh_reserve_subs(m, (int32_t)h->n_subs - m->n_subs, error);
    if (status)
        return status;
    bool memory = par_tiles_reserve(tiles) &&
                  tri_grow(&state->worklist.item, &state->worklist.capacity, (int32_t)h->n_worklist,
                           sizeof *state->worklist.item) &&
                  tri_grow(&state->key.item, &state->key.capacity, (int32_t)h->n_keys, sizeof *state->key.item) &&
                  tri_grow(&tiles->held.item, &tiles->held.capacity, (int32_t)h->n_held, sizeof *tiles->held.item);
    for (int k = 0; memory && k < PAR_KINDS; k++)
        memory = par_ranges_reserve(&state->spare.ranges[k], (int32_t)h->n_spare[k]);
    return memory ? TRI_OK : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the state of a checkpoint");
}

static void set_counts(const struct head *h, struct par_state *state, struct par_tiles *tiles)
{
    struct par_report *r = state->report;
    state->mesh->n_vertices = (int32_t)h->n_vertices;
    state->mesh->n_triangles = (int32_t)h->n_triangles;
    state->mesh->n_subs = (int32_t)h->n_subs;
    state->worklist.n = (int32_t)h->n_worklist;
    state->key.n = (int32_t)h->n_keys;
    state->round = (int)h->round;
    state->radius = h->radius;
    tiles->held.n = (int32_t)h->n_held;
    tiles->n_vertices = h->tiles_vertices;
    tiles->n_triangles = h->tiles_triangles;
    tiles->n_segments = h->tiles_segments;
    state->gone = h->tiles_triangles;
    for (int k = 0; k < PAR_KINDS; k++)
        state->spare.ranges[k].n = (int32_t)h->n_spare[k];
    r->total = h->total;
    r->pauses = h->pauses;
    r->most_live = h->most_live;
    r->deferred = h->deferred;
    r->left_over = h->left_over;
}

static enum tri_status load(struct par_checkpoint *c, struct par_state *state, struct par_tiles *tiles, int32_t *odd,
                            struct tri_error *error)
{
    const char *name = state_name[c->manifest.which];
    struct head h = {0};
    struct carrier from = {.file = open_in(c->directory, name, O_RDONLY)};
    from.failed = from.file < 0;
    carry(&from, &h, sizeof h);
    bool sound = !from.failed && is_head(&h, state, tiles->partition);
    enum tri_status status = sound ? reserve(&h, state, tiles, error) : TRI_OK;
    if (sound && !status) {
        carry_arrays(&from, &h, state, tiles);
        sound = !from.failed && from.place == c->manifest.state_bytes && from.hash == c->manifest.state_hash;
    }
    if (from.file >= 0)
        close(from.file);
    if (!sound)
        return damaged(c, name, error);
    if (!status) {
        set_counts(&h, state, tiles);
        *odd = (int32_t)h.odd;
    }
    return status;
}

/* --- a state of others */

enum tri_status par_checkpoint_put(struct par_checkpoint *c, const void *state, size_t n, struct par_manifest next,
                                   struct tri_error *error)
{
    next.which = par_checkpoint_next(&c->manifest);
    next.of = c->manifest.of;
    next.state_bytes = (int64_t)n;
    next.state_hash = par_hash(0, state, n);
    const char *name = state_name[next.which];
    int file = open_in(c->directory, name, O_WRONLY | O_CREAT | O_TRUNC);
    bool done = file >= 0 && par_write_at(file, state, n, 0) && fsync(file) == 0;
    if (file >= 0)
        done = close(file) == 0 && done;
    enum tri_status status = done ? write_manifest(c, next, error) : cannot_write(c->directory, name, error);
    c->saved += !status;
    return status;
}

enum tri_status par_checkpoint_get(const struct par_checkpoint *c, void *state, struct tri_error *error)
{
    const struct par_manifest *m = &c->manifest;
    int file = open_in(c->directory, state_name[m->which], O_RDONLY);
    bool sound = file >= 0 && par_read_at(file, state, (size_t)m->state_bytes, 0) &&
                 par_hash(0, state, (size_t)m->state_bytes) == m->state_hash;
    if (file >= 0)
        close(file);
    return sound ? TRI_OK : damaged(c, state_name[m->which], error);
}

/* --- for the sweep */

enum tri_status par_checkpoint_begin(struct par_checkpoint *c, struct par_state *state, struct par_tiles *tiles,
                                     int32_t *odd, struct tri_error *error)
{
    uint64_t run = par_checkpoint_run(state, tiles->partition);
    bool again = par_checkpoint_has_state(c);
    enum tri_status checked = par_checkpoint_check(c, run, error);
    if (checked)
        return checked;
    if (again && c->manifest.n_ranks > 0)
        return tri_fail(error, TRI_BAD_INPUT, c->directory, 0, "is the checkpoint of several tasks");
    c->manifest.run = run;
    if (ftruncate(c->spool.file, (off_t)c->spool.length) != 0)
        return cannot_write(c->directory, tiles_name, error);
    c->spool.to = tiles->sink;
    c->spool.again = again;
    c->sink = par_spool_sink(&c->spool);
    c->stop = state->mesh->stop;
    c->last = tri_seconds();
    tiles->sink = &c->sink;
    state->mesh->stop = again ? NULL : c->stop; /* as long as there is nothing to lose */
    enum tri_status status = par_tiles_begin(tiles, tiles->partition->estimate, error);
    return status || !again ? status : load(c, state, tiles, odd, error);
}

enum tri_status par_checkpoint_border(struct par_checkpoint *c, struct par_state *state,
                                      const struct par_tiles *tiles, int32_t odd, struct tri_error *error)
{
    state->mesh->stop = NULL;
    bool asked = tri_stop_is_asked(c->stop), failed = c->spool.failed != TRI_OK;
    if (!asked && !failed && tri_seconds() - c->last < c->seconds)
        return TRI_OK;
    if (failed)
        return par_checkpoint_last(c, state, tiles, odd, error);
    enum tri_status status = save(c, state, tiles, odd, error);
    c->last = tri_seconds();
    return status || !asked ? status : tri_fail_stopped(error);
}

/* Whether the state could be saved or not, what the taker said is told. */
enum tri_status par_checkpoint_last(struct par_checkpoint *c, const struct par_state *state,
                                    const struct par_tiles *tiles, int32_t odd, struct tri_error *error)
{
    if (!c->spool.failed)
        return TRI_OK;
    (void)save(c, state, tiles, odd, NULL);
    if (error)
        *error = c->spool.failure;
    return c->spool.failed;
}

enum tri_status par_checkpoint_end(struct par_checkpoint *c, struct par_state *state, bool forget,
                                   struct tri_error *error)
{
    state->mesh->stop = c->stop;
    if (!forget)
        return TRI_OK;
    c->spool.length = 0;
    return write_manifest(c, (struct par_manifest){.of = c->manifest.of}, error);
}
