/* Checkpoints of a run on ranks, written between two steps. Each rank writes a file with its own part. Then rank 0
 * writes the position of the run and, last, the manifest. A run on any number of ranks can resume from it.
 *
 * A rank writes one piece for each of its tiles: all triangles with a corner in the tile, and their worklist entries,
 * as a message (talk.h). A rank that resumes pastes the pieces of its tiles as if it had borrowed the triangles.
 *
 * THEOREM. The invariant of ranks.h then holds for the new rank. It holds the triangles with a corner in its tiles: all
 * of them are in the pieces. A triangle in several pieces is recognised by its corners. Consider an edge of two such
 * triangles. If an end lies in a tile of the rank, both triangles and the subsegment on the edge are in its piece, so
 * the links are set. Other edges have no link, and need none: a block that may change one of the two triangles
 * contains both ends of the edge, and its rank borrows the triangles around them from their owners. */
#include <errno.h>
#include <stdlib.h>
#include <string.h>

#include "sched/checkpoint/state.h"
#include "sched/ranks/ranks.h"
#include "sched/schedule/room.h"
#include "triangle/base/hash.h"
#include "triangle/base/system.h"

static const uint64_t PIECES = UINT64_C(0x3273656365697074); /* identifies the file type and its version */

/* The head of a rank's file. It is followed by n_tiles + 1 offsets in bytes (the beginning of each piece, and the end
 * of the last one) and by the pieces. */
struct head {
    uint64_t word, run;          /* PIECES; hash of input and settings */
    int64_t first_tile, n_tiles; /* the tiles of the rank that wrote the file */
};

/* --- sorting triangles by tiles */

struct sorting {
    const struct par_ranks *ranks; /* this rank */
    int32_t n_tiles;            /* tiles that it owns */
    int32_t *tile_of;           /* [n_vertices] own tile of each vertex, from 0; TRI_NONE: tile of another rank, or
                                   unused id */
    struct par_ids (*lists)[2]; /* [n_tiles] triangles of each tile; indices of its worklist entries */
};

static void find_tiles(struct sorting *s)
{
    const struct par_territory *territory = &s->ranks->territory;
    const struct tri_mesh *mesh = s->ranks->run->mesh;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        s->tile_of[v] = mesh->on[v] != TRI_VERTEX_NONE && par_is_own(territory, mesh->xy[v])
                            ? par_tile_at(territory, mesh->xy[v]) - territory->start[territory->rank] : TRI_NONE;
}

/* Lists the own tiles that contain a corner of t, each once. Returns their number; 0 if t is deleted. */
static int tiles_of(const struct sorting *s, tri_triangle_id t, int32_t tile[3])
{
    const struct tri_triangle *triangle = &s->ranks->run->mesh->tri[t];
    int n = 0;
    for (int k = 0; tri_is_live(triangle) && k < 3; k++) {
        int32_t at = s->tile_of[triangle->v[k]];
        if (at != TRI_NONE && (n < 1 || tile[0] != at) && (n < 2 || tile[1] != at))
            tile[n++] = at;
    }
    return n;
}

/* Adds an item that belongs to triangle t to list `which` of each tile of t. False: no memory. */
static bool add_to_tiles(const struct sorting *s, int which, int32_t item, tri_triangle_id t)
{
    int32_t tile[3];
    bool memory = true;
    for (int k = tiles_of(s, t, tile); k > 0; k--)
        memory = memory && par_ids_add(&s->lists[tile[k - 1]][which], item);
    return memory;
}

static void free_sorting(struct sorting *s)
{
    for (int32_t i = 0; s->lists && i < s->n_tiles; i++) {
        free(s->lists[i][0].item);
        free(s->lists[i][1].item);
    }
    free(s->tile_of);
    free(s->lists);
}

/* Lists the triangles and the worklist entries of each tile. False: no memory. */
static bool sort_all(struct sorting *s, const struct par_ranks *r)
{
    const struct par_territory *territory = &r->territory;
    const struct par_run *run = r->run;
    const int32_t n = territory->start[territory->rank + 1] - territory->start[territory->rank];
    *s = (struct sorting){.ranks = r, .n_tiles = n};
    s->tile_of = malloc(((size_t)run->mesh->n_vertices + 1) * sizeof *s->tile_of);
    s->lists = calloc((size_t)n + 1, sizeof *s->lists);
    bool memory = s->tile_of && s->lists;
    if (memory)
        find_tiles(s);
    for (tri_triangle_id t = 0; memory && t < run->mesh->n_triangles; t++)
        memory = add_to_tiles(s, 0, t, t);
    for (int32_t i = 0; memory && i < run->worklist.n; i++)
        memory = add_to_tiles(s, 1, i, run->worklist.item[i]);
    return memory;
}

/* --- writing pieces */

/* Removes subsegments without an end in the tile from the message. They are in the pieces of the tiles of their ends.
 * If they were in this piece as well, the two sides of one subsegment might be read as two subsegments. fresh: room for
 * m->n_new_subs new numbers. */
static void leave_out_sides(const struct sorting *s, int32_t tile, struct par_message *m, struct par_talk *talk,
                            int32_t *fresh)
{
    const struct tri_mesh *mesh = s->ranks->run->mesh;
    int32_t kept = 0, n_subs = 0;
    for (int32_t i = 0; i < m->n_new_subs; i++)
        fresh[i] = TRI_NONE;
    for (int32_t i = 0; i < m->n_sides; i++) {
        struct par_told_side side = m->side[i];
        const tri_vertex_id *end = mesh->sub[talk->sub.item[side.sub]].v;
        if (s->tile_of[end[0]] != tile && s->tile_of[end[1]] != tile)
            continue;
        fresh[side.sub] = fresh[side.sub] == TRI_NONE ? n_subs++ : fresh[side.sub];
        side.sub = fresh[side.sub];
        m->side[kept++] = side;
    }
    m->n_sides = kept;
    m->n_new_subs = talk->sub.n = n_subs;
}

/* Fills the message with the triangles, subsegments and worklist entries of a tile. False: no memory. */
static bool fill_piece(const struct sorting *s, int32_t tile, struct par_talk *talk, struct par_message *message)
{
    const struct par_run *run = s->ranks->run;
    const struct par_ids *triangles = &s->lists[tile][0], *entries = &s->lists[tile][1];
    bool memory = true;
    for (int32_t i = 0; memory && i < triangles->n; i++)
        memory = par_talk_add_triangle(talk, triangles->item[i]);
    memory = memory && par_message_fill(message, talk, run->mesh, s->ranks->n_common);
    for (int32_t i = 0; memory && i < entries->n; i++) {
        int32_t entry = entries->item[i];
        memory = par_message_add_entry(message, run->key.item[entry],
                                       par_talk_number(talk, run->worklist.item[entry]));
    }
    int32_t *fresh = memory ? malloc(((size_t)message->n_new_subs + 1) * sizeof *fresh) : NULL;
    if (fresh)
        leave_out_sides(s, tile, message, talk, fresh);
    free(fresh);
    return fresh;
}

/* Encodes the piece of a tile; replaces the contents of `bytes`. False: no memory. */
static bool pack_piece(const struct sorting *s, int32_t tile, struct par_bytes *bytes)
{
    struct par_talk talk = {0};
    struct par_message message = {0};
    bytes->n = 0;
    bool memory = fill_piece(s, tile, &talk, &message) &&
                  par_message_write(&message, &talk, s->ranks->run->mesh, s->ranks->n_common, bytes);
    par_message_free(&message);
    par_talk_free(&talk);
    return memory;
}

static enum tri_status cannot_write(const char *path, struct tri_error *error)
{
    return tri_fail_system(error, TRI_CANNOT_WRITE, path, "cannot write", errno);
}

/* Writes the pieces one after the other, then their offsets and the head in front of them. offset: receives the
 * n_tiles + 1 offsets. */
static enum tri_status write_pieces(const struct sorting *s, tri_file file, const char *path, struct head head,
                                 int64_t *offset, struct tri_error *error)
{
    struct par_bytes bytes = {0};
    enum tri_status status = TRI_OK;
    size_t n = ((size_t)s->n_tiles + 1) * sizeof *offset;
    offset[0] = (int64_t)(sizeof head + n);
    for (int32_t tile = 0; !status && tile < s->n_tiles; tile++) {
        if (!pack_piece(s, tile, &bytes))
            status = par_ranks_no_memory(error);
        else if (!tri_write_at(file, bytes.at, bytes.n, (uint64_t)offset[tile]))
            status = cannot_write(path, error);
        offset[tile + 1] = offset[tile] + (int64_t)bytes.n;
    }
    free(bytes.at);
    if (!status && !(tri_write_at(file, offset, n, sizeof head) && tri_write_at(file, &head, sizeof head, 0)))
        status = cannot_write(path, error);
    return status;
}

/* Writes a whole file. *hash receives the hash of head and offsets; each piece contains its own hash. */
static enum tri_status write_file(const struct sorting *s, tri_file file, const char *path, uint64_t *hash,
                                  struct tri_error *error)
{
    const struct par_territory *territory = &s->ranks->territory;
    const struct head head = {PIECES, s->ranks->of_run, territory->start[territory->rank], s->n_tiles};
    size_t n = (size_t)s->n_tiles + 1;
    int64_t *offset = calloc(n, sizeof *offset);
    if (!offset)
        return par_ranks_no_memory(error);
    enum tri_status status = write_pieces(s, file, path, head, offset, error);
    *hash = tri_hash(tri_hash(0, &head, sizeof head), offset, n * sizeof *offset);
    free(offset);
    return status;
}

/* Writes this rank's file for state `which` and syncs it to the disk. *hash: as in write_file. Not collective.
 * TRI_CANNOT_WRITE, TRI_NO_MEMORY. */
static enum tri_status write_piece_file(const struct par_ranks *r, int64_t which, uint64_t *hash,
                                        struct tri_error *error)
{
    const char *directory = r->run->asked.options->checkpoint->directory;
    char path[PAR_CHECKPOINT_PATH];
    struct sorting s;
    const tri_file file = par_checkpoint_piece(path, directory, which, r->carrier->rank, true);
    if (file == TRI_NO_FILE)
        return cannot_write(path, error);
    par_room_mark(&r->run->spare, r->run->mesh, &r->run->asked.executor);
    enum tri_status status = sort_all(&s, r) ? TRI_OK : par_ranks_no_memory(error);
    status = status ? status : write_file(&s, file, path, hash, error);
    if (!status && !par_checkpoint_end_piece(directory, path, file))
        status = cannot_write(path, error);
    (void)tri_file_close(file);
    free_sorting(&s);
    return status;
}

/* --- reading pieces */

static enum tri_status damaged(const char *path, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, path, 0, "is damaged, or not of this checkpoint");
}

/* Returns the file's offsets, to be freed by the caller. NULL: the head or the hash is wrong, or no memory. */
static int64_t *read_offsets(tri_file file, int32_t first, int32_t n_tiles, uint64_t run, uint64_t hash)
{
    const struct head wanted = {PIECES, run, first, n_tiles};
    struct head head;
    size_t n = ((size_t)n_tiles + 1) * sizeof(int64_t);
    int64_t *offset = malloc(n);
    if (offset && tri_read_back(file, &head, sizeof head, 0) && tri_read_back(file, offset, n, sizeof head) &&
        memcmp(&head, &wanted, sizeof head) == 0 && tri_hash(tri_hash(0, &head, sizeof head), offset, n) == hash)
        return offset;
    free(offset);
    return NULL;
}

/* Pastes the piece between two offsets into this rank's mesh. */
static enum tri_status read_piece(struct par_ranks *r, tri_file file, const char *path, const int64_t offset[2],
                                  struct tri_error *error)
{
    struct par_bytes bytes = {.n = 0};
    struct par_talk talk = {0};
    if (offset[1] < offset[0] || offset[0] < 0)
        return damaged(path, error);
    if (!par_bytes_reserve(&bytes, (size_t)(offset[1] - offset[0]) + 1))
        return par_ranks_no_memory(error);
    bytes.n = (size_t)(offset[1] - offset[0]);
    const bool whole = tri_read_back(file, bytes.at, bytes.n, (uint64_t)offset[0]);
    enum tri_status status = whole ? TRI_OK : damaged(path, error);
    status = status ? status : par_borrow_from(r, &talk, &bytes, error);
    par_talk_free(&talk);
    free(bytes.at);
    return status == TRI_INTERNAL ? damaged(path, error) : status;
}

/* A file of one rank in a checkpoint. */
struct piece_file {
    int64_t which;      /* number of the state: 0 or 1 */
    int writer;         /* rank that wrote the file */
    int32_t first, end; /* its tiles: first .. end - 1 */
    uint64_t hash;      /* as in struct writer */
};

/* Pastes the pieces of those tiles in a file that this rank owns now. Not collective. TRI_BAD_INPUT: the file is
 * missing or damaged. TRI_NO_MEMORY. */
static enum tri_status read_piece_file(struct par_ranks *r, const struct piece_file *of, struct tri_error *error)
{
    const int32_t *start = r->territory.start, rank = r->carrier->rank;
    const int32_t first = start[rank] > of->first ? start[rank] : of->first;
    const int32_t end = start[rank + 1] < of->end ? start[rank + 1] : of->end;
    char path[PAR_CHECKPOINT_PATH];
    if (first >= end)
        return TRI_OK;
    const char *directory = r->run->asked.options->checkpoint->directory;
    const tri_file file = par_checkpoint_piece(path, directory, of->which, of->writer, false);
    if (file == TRI_NO_FILE)
        return tri_fail_system(error, TRI_BAD_INPUT, path, "cannot be read", errno);
    int64_t *offset = read_offsets(file, of->first, of->end - of->first, r->of_run, of->hash);
    enum tri_status status = offset ? TRI_OK : damaged(path, error);
    for (int32_t tile = first; !status && tile < end; tile++)
        status = read_piece(r, file, path, &offset[tile - of->first], error);
    free(offset);
    (void)tri_file_close(file);
    return status;
}

/* --- the state file */

/* A rank that wrote a file of pieces. */
struct writer {
    int64_t end;   /* the tile after its last one: the first tile of the next rank */
    uint64_t hash; /* hash of head and offsets of its file */
};

/* The contents of the state file, which rank 0 writes. */
struct kept {
    int32_t next, round, phase, step; /* as in struct par_position */
    int64_t left_over;      /* counted since par_ranks_begin, as in the report */
    int64_t rounds;         /* completed rounds of both schedules since par_ranks_begin */
    int64_t done[PAR_DONE]; /* sums of the counters of all ranks */
    int64_t n_ranks;        /* ranks that wrote the checkpoint */
    struct writer writer[]; /* [n_ranks] */
};

static size_t size_of(int64_t n_ranks) { return sizeof(struct kept) + (size_t)n_ranks * sizeof(struct writer); }

/* Writes or reads the state file; user: a struct kept with n_ranks set. */
static enum tri_status carry_kept(struct par_state_file *file, void *user, struct tri_error *error)
{
    struct kept *kept = user;
    (void)error;
    par_carry(file, kept, size_of(kept->n_ranks));
    return TRI_OK;
}

/* --- resuming */

/* Empties the mesh, except for the coarse vertices, which all ranks hold. The pieces contain everything else. */
static void clear_mesh(struct par_run *run, int32_t n_common)
{
    run->mesh->n_vertices = n_common;
    run->mesh->n_triangles = run->mesh->n_subs = 0;
    run->worklist.n = run->key.n = 0;
    par_room_free(&run->spare);
}

/* Lists the straddlers of a mesh without deleted triangles. False: no memory. */
static bool find_straddlers(struct par_ranks *r)
{
    bool memory = true;
    for (tri_triangle_id t = 0; memory && t < r->run->mesh->n_triangles; t++)
        memory = par_own_corners(r, t) == 3 || par_ids_add(&r->straddlers, t);
    return memory;
}

/* Replaces this rank's mesh and worklist by the pieces of its tiles, from all files that contain one. Not collective.
 * */
static enum tri_status read_pieces(struct par_ranks *r, const struct par_manifest *m, const struct writer *writer,
                                   struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    clear_mesh(r->run, r->n_common);
    if (!par_index_straddlers(r))
        return par_ranks_no_memory(error);
    for (int p = 0; !status && p < m->n_ranks; p++) {
        const struct piece_file file = {m->which, p, p > 0 ? (int32_t)writer[p - 1].end : 0,
                                            (int32_t)writer[p].end, writer[p].hash};
        status = read_piece_file(r, &file, error);
    }
    return status || find_straddlers(r) ? status : par_ranks_no_memory(error);
}

/* Restores position and report. The counters of all ranks are added to the report of rank 0. */
static void restore_position(struct par_ranks *r, const struct kept *c)
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

/* Collective: rank 0 reads the state file and sends it to the others; then each rank reads the pieces of its tiles. */
static enum tri_status read_all(struct par_ranks *r, const struct par_manifest *m, struct tri_error *error)
{
    struct kept *kept = calloc(1, size_of(m->n_ranks));
    enum tri_status status = kept ? TRI_OK : par_ranks_no_memory(error);
    if (!status && r->carrier->rank == 0) {
        kept->n_ranks = m->n_ranks;
        status = par_checkpoint_read(r->run->asked.options->checkpoint, carry_kept, kept, error);
    }
    status = par_spread(r->carrier, PAR_MOVE_INPUT, kept, size_of(m->n_ranks), status, error);
    status = status ? status : read_pieces(r, m, kept->writer, error);
    if (!status)
        restore_position(r, kept);
    free(kept);
    return status;
}

/* Collective: rank 0 checks that the checkpoint belongs to this run. *m receives the manifest of rank 0. */
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

enum tri_status par_resume(struct par_ranks *r, bool *again, struct tri_error *error)
{
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    struct par_manifest m;
    *again = false;
    if (!c)
        return TRI_OK;
    c->stop = r->run->mesh->stop;
    c->last = c->last_check = tri_seconds();
    enum tri_status status = check_manifest(r, &m, error);
    if (status || m.state_bytes == 0)
        return status;
    *again = true;
    r->run->mesh->stop = NULL; /* from now on par_offer_checkpoint stops the run, after a checkpoint */
    return read_all(r, &m, error);
}

/* --- writing checkpoints */

/* Returns the number of triangles whose first corner is in this rank's tiles, so that the sum over all ranks counts
 * each triangle once. */
static int64_t count_triangles(const struct par_ranks *r)
{
    const struct tri_mesh *mesh = r->run->mesh;
    int64_t n = 0;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        n += tri_is_live(&mesh->tri[t]) && par_is_own(&r->territory, mesh->xy[mesh->tri[t].v[0]]);
    return n;
}

/* Rank 0 only: writes the state file and the manifest. done: counters of all ranks. file_facts: hash and number of
 * triangles of each rank. */
static enum tri_status write_state(struct par_ranks *r, const int64_t *file_facts, const int64_t done[PAR_DONE],
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
        kept->writer[p] = (struct writer){r->territory.start[p + 1], (uint64_t)file_facts[2 * p]};
        triangles += file_facts[2 * p + 1];
    }
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    enum tri_status status = par_checkpoint_write(c, PAR_RANKS_STATE, n_ranks, triangles, carry_kept, kept, error);
    free(kept);
    return status;
}

/* Collective: rank 0 sends the number of the next state, which only its manifest determines; then each rank writes its
 * file. file_facts: receives the hash and the number of triangles of this rank. */
static enum tri_status write_own(struct par_ranks *r, int64_t file_facts[2], struct tri_error *error)
{
    uint64_t hash = 0;
    int64_t which = par_checkpoint_next(r->run->asked.options->checkpoint);
    enum tri_status status = par_spread(r->carrier, PAR_MOVE_INPUT, &which, sizeof which, TRI_OK, error);
    status = status ? status : write_piece_file(r, which, &hash, error);
    file_facts[0] = (int64_t)hash;
    file_facts[1] = count_triangles(r);
    return status;
}

/* Collective: writes a checkpoint. */
static enum tri_status write_all(struct par_ranks *r, struct tri_error *error)
{
    int64_t mine[PAR_DONE], done[PAR_DONE], file_facts[2] = {0};
    int64_t *all = malloc(2 * (size_t)r->carrier->n_ranks * sizeof *all);
    par_count_done(r, mine);
    enum tri_status status = all ? TRI_OK : par_ranks_no_memory(error);
    status = par_sum(r->carrier, mine, PAR_DONE, done, status, error);
    status = status ? status : write_own(r, file_facts, error);
    status = par_gather(r->carrier, file_facts, 2, all, status, error);
    if (!status && r->carrier->rank == 0)
        status = write_state(r, all, done, error);
    free(all);
    return par_agree(r->carrier, status, error);
}

enum tri_status par_offer_checkpoint(struct par_ranks *r, enum tri_status status, struct tri_error *error)
{
    struct par_checkpoint *c = r->run->asked.options->checkpoint;
    int64_t asked[2], sum[2];
    if (!c)
        return status;
    r->run->mesh->stop = NULL; /* stop only here, after a checkpoint */
    const double began = tri_seconds(), step = began - c->last_check, triangles = (double)par_triangles(r->run);
    const bool is_last = r->carrier->rank == 0 && par_state_is_last(c, began + step, triangles);
    c->last_check = began;
    asked[0] = is_last || tri_stop_is_asked(c->stop);
    asked[1] = r->carrier->rank == 0 && par_state_is_due(c, began, triangles);
    status = par_sum(r->carrier, asked, 2, sum, status, error);
    if (status || sum[0] + sum[1] == 0)
        return status;
    status = write_all(r, error);
    c->last = tri_seconds();
    c->cost = c->writing = c->last - began;
    c->size = triangles;
    if (!status && is_last && c->time_up)
        c->time_up();
    return par_agree(r->carrier, status || sum[0] == 0 ? status : tri_fail_stopped(error), error);
}
