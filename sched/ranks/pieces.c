/* Tile by tile: what has a corner in it, told as to another rank. */
#include "sched/ranks/pieces.h"
#include "triangle/base/system.h"

#include <assert.h>
#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t PIECES = UINT64_C(0x3273656365697074); /* a version as well */

struct head {
    uint64_t word, run;
    int64_t first_tile, n_tiles; /* an offset for each, and the end, follow: then what is told of each */
};

/* --- what belongs to which tile */

struct sorting {
    const struct par_ranks *ranks;
    int32_t n_tiles;
    int32_t *tile_of; /* [n_vertices] own tiles, from 0; TRI_NONE: of others, or no vertex */
    struct par_ids (*lists)[2]; /* [n_tiles] triangles, and entries of the worklist */
};

static void find_tiles(struct sorting *s)
{
    const struct par_territory *territory = &s->ranks->territory;
    const struct tri_mesh *mesh = s->ranks->state->mesh;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        s->tile_of[v] = mesh->on[v] != TRI_VERTEX_NONE && par_is_own(territory, mesh->xy[v])
                            ? par_tile_at(territory, mesh->xy[v]) - territory->start[territory->rank] : TRI_NONE;
}

/* The own tiles that have a corner of a triangle, each once; returns how many. */
static int tiles_of(const struct sorting *s, tri_triangle_id t, int32_t tile[3])
{
    const struct tri_triangle *triangle = &s->ranks->state->mesh->tri[t];
    int n = 0;
    for (int k = 0; tri_is_live(triangle) && k < 3; k++) {
        int32_t at = s->tile_of[triangle->v[k]];
        if (at != TRI_NONE && (n < 1 || tile[0] != at) && (n < 2 || tile[1] != at))
            tile[n++] = at;
    }
    return n;
}

/* Into the lists of the triangle's tiles. */
static bool add(const struct sorting *s, int which, int32_t item, tri_triangle_id t)
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

static bool sort_all(struct sorting *s, const struct par_ranks *r)
{
    const struct par_territory *territory = &r->territory;
    const struct par_run *state = r->state;
    const int32_t n = territory->start[territory->rank + 1] - territory->start[territory->rank];
    *s = (struct sorting){.ranks = r, .n_tiles = n};
    s->tile_of = malloc(((size_t)state->mesh->n_vertices + 1) * sizeof *s->tile_of);
    s->lists = calloc((size_t)n + 1, sizeof *s->lists);
    bool memory = s->tile_of && s->lists;
    if (memory)
        find_tiles(s);
    for (tri_triangle_id t = 0; memory && t < state->mesh->n_triangles; t++)
        memory = add(s, 0, t, t);
    for (int32_t i = 0; memory && i < state->worklist.n; i++)
        memory = add(s, 1, i, state->worklist.item[i]);
    return memory;
}

/* --- writing */

/* Subsegments without an end in the tile are told of with the tiles of their ends: else two halves of one might come
 * back as two. */
static void leave_out_sides(const struct sorting *s, int32_t tile, struct par_message *m, struct par_talk *talk,
                            int32_t *fresh)
{
    const struct tri_mesh *mesh = s->ranks->state->mesh;
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

static bool tell_piece(const struct sorting *s, int32_t tile, struct par_talk *talk, struct par_message *message)
{
    const struct par_run *state = s->ranks->state;
    const struct par_ids *triangles = &s->lists[tile][0], *entries = &s->lists[tile][1];
    bool memory = true;
    for (int32_t i = 0; memory && i < triangles->n; i++)
        memory = par_talk_add_triangle(talk, triangles->item[i]);
    memory = memory && par_message_tell(message, talk, state->mesh, s->ranks->n_common);
    for (int32_t i = 0; memory && i < entries->n; i++) {
        int32_t entry = entries->item[i];
        memory = par_message_add_entry(message, state->key.item[entry],
                                       par_talk_number(talk, state->worklist.item[entry]));
    }
    int32_t *fresh = memory ? malloc(((size_t)message->n_new_subs + 1) * sizeof *fresh) : NULL;
    if (fresh)
        leave_out_sides(s, tile, message, talk, fresh);
    free(fresh);
    return fresh;
}

static bool pack_piece(const struct sorting *s, int32_t tile, struct par_bytes *bytes)
{
    struct par_talk talk = {0};
    struct par_message message = {0};
    bytes->n = 0;
    bool memory = tell_piece(s, tile, &talk, &message) &&
                  par_message_write(&message, &talk, s->ranks->state->mesh, s->ranks->n_common, bytes);
    par_message_free(&message);
    par_talk_free(&talk);
    return memory;
}

static enum tri_status cannot_write(const char *path, struct tri_error *error)
{
    return tri_fail(error, TRI_CANNOT_WRITE, path, 0, "cannot write: %s", strerror(errno));
}

/* Pieces one after the other, then their offsets, then the head. */
static enum tri_status write_all(const struct sorting *s, tri_file file, const char *path, struct head head,
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

static enum tri_status write_file(const struct sorting *s, tri_file file, const char *path, uint64_t *hash,
                                  struct tri_error *error)
{
    const struct par_territory *territory = &s->ranks->territory;
    const struct head head = {PIECES, s->ranks->run, territory->start[territory->rank], s->n_tiles};
    size_t n = (size_t)s->n_tiles + 1;
    int64_t *offset = calloc(n, sizeof *offset);
    if (!offset)
        return par_ranks_no_memory(error);
    enum tri_status status = write_all(s, file, path, head, offset, error);
    *hash = par_hash(par_hash(0, &head, sizeof head), offset, n * sizeof *offset);
    free(offset);
    return status;
}

enum tri_status par_pieces_write(const struct par_ranks *r, int64_t which, uint64_t *hash, struct tri_error *error)
{
    const char *directory = r->state->options->checkpoint->directory;
    char path[PAR_CHECKPOINT_PATH];
    struct sorting s;
    const tri_file file = par_checkpoint_piece(path, directory, which, r->carrier->rank, true);
    if (file == TRI_NO_FILE)
        return cannot_write(path, error);
    par_room_mark(&r->state->spare, r->state->mesh, &r->state->executor);
    enum tri_status status = sort_all(&s, r) ? TRI_OK : par_ranks_no_memory(error);
    status = status ? status : write_file(&s, file, path, hash, error);
    if (!status && !par_checkpoint_end_piece(directory, path, file))
        status = cannot_write(path, error);
    (void)tri_file_close(file);
    free_sorting(&s);
    return status;
}

/* --- reading */

static enum tri_status damaged(const char *path, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, path, 0, "is damaged, or not of this checkpoint");
}

/* The file's offsets, malloc'ed; NULL: it is not what was written. */
static int64_t *read_offsets(tri_file file, int32_t first, int32_t n_tiles, uint64_t run, uint64_t hash)
{
    const struct head wanted = {PIECES, run, first, n_tiles};
    struct head head;
    size_t n = ((size_t)n_tiles + 1) * sizeof(int64_t);
    int64_t *offset = malloc(n);
    if (offset && tri_read_again(file, &head, sizeof head, 0) && tri_read_again(file, offset, n, sizeof head) &&
        memcmp(&head, &wanted, sizeof head) == 0 && par_hash(par_hash(0, &head, sizeof head), offset, n) == hash)
        return offset;
    free(offset);
    return NULL;
}

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
    const bool whole = tri_read_again(file, bytes.at, bytes.n, (uint64_t)offset[0]);
    enum tri_status status = whole ? TRI_OK : damaged(path, error);
    status = status ? status : par_borrow_from(r, &talk, &bytes, error);
    par_talk_free(&talk);
    free(bytes.at);
    return status == TRI_INTERNAL ? damaged(path, error) : status;
}

enum tri_status par_pieces_read(struct par_ranks *r, const struct par_piece_file *of, struct tri_error *error)
{
    const int32_t *start = r->territory.start, rank = r->carrier->rank;
    const int32_t first = start[rank] > of->first ? start[rank] : of->first;
    const int32_t end = start[rank + 1] < of->end ? start[rank + 1] : of->end;
    char path[PAR_CHECKPOINT_PATH];
    if (first >= end)
        return TRI_OK;
    const char *directory = r->state->options->checkpoint->directory;
    const tri_file file = par_checkpoint_piece(path, directory, of->which, of->writer, false);
    if (file == TRI_NO_FILE)
        return tri_fail(error, TRI_BAD_INPUT, path, 0, "cannot be read: %s", strerror(errno));
    int64_t *offset = read_offsets(file, of->first, of->end - of->first, r->run, of->hash);
    enum tri_status status = offset ? TRI_OK : damaged(path, error);
    for (int32_t tile = first; !status && tile < end; tile++)
        status = read_piece(r, file, path, &offset[tile - of->first], error);
    free(offset);
    (void)tri_file_close(file);
    return status;
}
