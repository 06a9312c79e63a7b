/* Tiles in a file. Heads and arrays have the same layout as in memory, so a file can be read only on the same kind of
 * machine. Its first word shows whether this is the case. */
#include "sched/checkpoint/spool.h"
#include "sched/tiles/tile_arrays.h"
#include "sched/tunables.h"
#include "triangle/base/hash.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

static const uint64_t TILE = UINT64_C(0x32656c6974697274); /* "tritile2": file type and version */

/* The head of a tile in the file. Its arrays follow. */
struct head {
    uint64_t word;              /* TILE */
    uint64_t hash;              /* hash of the members below and of the arrays */
    int64_t bytes;              /* bytes of the arrays, each padded to a multiple of eight */
    struct tri_tile tile;       /* numbers of the tile; its pointers are NULL */
    int32_t n_attributes, none; /* attributes of a vertex; padding, 0 */
};

/* --- arrays of a tile, packed */

/* Returns whether array k holds vertex numbers. */
static bool is_of_numbers(int k) { return k == PAR_TILE_CORNERS || k == PAR_TILE_ENDS; }

/* Lists the arrays of a tile as they are packed: numbers of vertices take half the bytes. */
static void arrays_of(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS])
{
    par_tile_arrays(tile, n_attributes, array);
    array[PAR_TILE_CORNERS].bytes /= 2;
    array[PAR_TILE_ENDS].bytes /= 2;
}

/* Returns the size of a tile's packed arrays, with padding. */
static size_t packed_size(const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    size_t sum = 0;
    arrays_of(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++)
        sum += par_padded(array[k].bytes);
    return sum;
}

/* Returns the hash of a head, after its member `hash`, and of the arrays. */
static uint64_t hash_of(const struct head *h, const char *arrays)
{
    uint64_t hash = tri_hash(0, &h->bytes, sizeof *h - offsetof(struct head, bytes));
    return tri_hash(hash, arrays, (size_t)h->bytes);
}

/* Packs numbers of vertices as 32-bit distances back from `end`. False: a vertex is too far away. */
static bool pack_numbers(char *to, const int64_t *number, size_t n, int64_t end)
{
    bool fits = true;
    for (size_t i = 0; i < n; i++) {
        const uint64_t back = (uint64_t)(end - number[i]);
        const uint32_t short_back = (uint32_t)back;
        fits = fits && back == short_back;
        memcpy(to + 4 * i, &short_back, 4);
    }
    return fits;
}

/* Packs a tile's arrays. `to` must be zero, because padding is not written. False: a vertex is too far away. */
static bool pack_tile(char *to, const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    bool fits = true;
    arrays_of(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++) {
        if (is_of_numbers(k))
            fits = pack_numbers(to, array[k].at, array[k].bytes / 4, tile->first_vertex + tile->n_vertices) && fits;
        else if (array[k].bytes > 0)
            memcpy(to, array[k].at, array[k].bytes);
        to += par_padded(array[k].bytes);
    }
    return fits;
}

/* Fails with TRI_NO_MEMORY. */
static enum tri_status no_memory(const struct par_spool *spool, struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, spool->path, 0, "out of memory for a tile");
}

/* Fails with TRI_CANNOT_WRITE and the reason in errno. */
static enum tri_status fail_writing(const struct par_spool *spool, struct tri_error *error)
{
    return tri_fail_system(error, TRI_CANNOT_WRITE, spool->path, "cannot write", errno);
}

/* Asks the system to begin writing recent tiles to the disk, so that syncing them, when a state is written, takes
 * little time. Only a hint, which the system may ignore. */
static void start_writing(struct par_spool *spool)
{
    if (spool->length - spool->sent < PAR_SPOOL_SHIP)
        return;
    tri_file_start_sync(spool->file, (uint64_t)spool->sent, (uint64_t)(spool->length - spool->sent));
    spool->sent = spool->length;
}

/* Appends a tile to the file. On errors spool->length does not change, so a partly written tile does not count. */
static enum tri_status append_tile(struct par_spool *spool, const struct tri_tile *tile, struct tri_error *error)
{
    const size_t n = packed_size(tile, spool->n_attributes);
    struct head *h = calloc(1, sizeof *h + n);
    enum tri_status status = TRI_OK;
    if (!h)
        return no_memory(spool, error);
    char *arrays = (char *)(h + 1);
    *h = (struct head){.word = TILE, .bytes = (int64_t)n, .n_attributes = spool->n_attributes};
    /* Copy the numbers only: pointers have no meaning in a file. */
    h->tile = (struct tri_tile){.column = tile->column, .row = tile->row, .first_vertex = tile->first_vertex,
                                .first_triangle = tile->first_triangle, .first_segment = tile->first_segment,
                                .n_vertices = tile->n_vertices, .n_triangles = tile->n_triangles,
                                .n_segments = tile->n_segments};
    if (!pack_tile(arrays, tile, spool->n_attributes))
        status = tri_fail(error, TRI_TOO_LARGE, spool->path, 0, "a tile refers to a vertex over 2^32 numbers back");
    h->hash = hash_of(h, arrays);
    if (!status && !tri_write_at(spool->file, h, sizeof *h + n, (uint64_t)spool->length))
        status = fail_writing(spool, error);
    spool->length += status ? 0 : (int64_t)(sizeof *h + n);
    /* spool->length now includes the tile, unless writing has failed. */
    start_writing(spool);
    free(h);
    return status;
}

/* --- handing out the tiles of the file again */

/* Unpacks numbers of vertices (see pack_numbers), into malloc'ed memory. NULL: no memory. */
static int64_t *unpack_numbers(const char *at, size_t n, int64_t end)
{
    int64_t *number = malloc((n + 1) * sizeof *number);
    for (size_t i = 0; number && i < n; i++) {
        uint32_t back;
        memcpy(&back, at + 4 * i, 4);
        number[i] = end - back;
    }
    return number;
}

/* Hands out one tile from its packed arrays. */
static enum tri_status hand_out_tile(const struct par_spool *spool, const struct head *h, const char *arrays,
                                     struct tri_error *error)
{
    struct tri_tile tile = h->tile;
    struct par_array array[PAR_TILE_ARRAYS];
    int64_t *number[PAR_TILE_ARRAYS] = {NULL};
    bool memory = true;
    arrays_of(&tile, h->n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; arrays += par_padded(array[k++].bytes)) {
        array[k].at = arrays;
        if (!is_of_numbers(k))
            continue;
        array[k].at = number[k] = unpack_numbers(arrays, array[k].bytes / 4, tile.first_vertex + tile.n_vertices);
        memory = memory && number[k];
    }
    /* The arrays of vertex numbers have been unpack_numbers. The other arrays are used in place. */
    par_tile_point_at(&tile, array);
    enum tri_status status = memory ? spool->to->take(spool->to->user, &tile, error) : no_memory(spool, error);
    free(number[PAR_TILE_CORNERS]);
    free(number[PAR_TILE_ENDS]);
    return status;
}

/* Fails with TRI_BAD_INPUT and the position of the damaged tile. */
static enum tri_status fail_damaged(const struct par_spool *spool, int64_t place, struct tri_error *error)
{
    return tri_fail(error, TRI_BAD_INPUT, spool->path, 0, "damaged at byte %lld", (long long)place);
}

/* Reads and checks the tile at a position of the file. *arrays is malloc'ed or NULL; the caller frees it, after errors
 * as well. */
static enum tri_status read_tile(const struct par_spool *spool, int64_t place, struct head *h, char **arrays,
                                 struct tri_error *error)
{
    /* Check the head before its lengths are used. */
    int64_t left = spool->length - place - (int64_t)sizeof *h;
    *arrays = NULL;
    if (left < 0 || !tri_read_back(spool->file, h, sizeof *h, (uint64_t)place) || h->word != TILE || h->bytes < 0 ||
        h->bytes > left || h->n_attributes != spool->n_attributes)
        return fail_damaged(spool, place, error);
    *arrays = malloc((size_t)h->bytes + 1);
    if (!*arrays)
        return no_memory(spool, error);
    if (!tri_read_back(spool->file, *arrays, (size_t)h->bytes, (uint64_t)place + sizeof *h) ||
        h->hash != hash_of(h, *arrays) || (size_t)h->bytes != packed_size(&h->tile, h->n_attributes))
        return fail_damaged(spool, place, error);
    return TRI_OK;
}

/* Hands out all tiles of the file, in their order. */
static enum tri_status hand_out_again(struct par_spool *spool, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int64_t place = 0; !status && place < spool->length;) {
        struct head h;
        char *arrays;
        status = read_tile(spool, place, &h, &arrays, error);
        status = status ? status : hand_out_tile(spool, &h, arrays, error);
        place += status ? 0 : (int64_t)sizeof h + h.bytes;
        free(arrays);
    }
    return status;
}

/* --- the sink */

/* Passes the beginning of the stream on, then hands out the tiles of the file if the run is resumed. */
static enum tri_status begin_stream(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct par_spool *spool = user;
    spool->n_attributes = stream->n_attributes;
    enum tri_status status = spool->to->begin ? spool->to->begin(spool->to->user, stream, error) : TRI_OK;
    return status || !spool->again ? status : hand_out_again(spool, error);
}

/* Appends the tile to the file and passes it on, except the first tile of a resumed run, which is in the file already.
 * If the receiver fails, this is only noted, since the tile is safe in the file: par_state_border writes a state and
 * then returns the failure. */
static enum tri_status take_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct par_spool *spool = user;
    if (spool->again) {
        spool->again = false;
        return TRI_OK;
    }
    enum tri_status status = append_tile(spool, tile, error);
    if (!status && !spool->failed)
        spool->failed = spool->to->take(spool->to->user, tile, &spool->failure);
    return status;
}

/* Passes the end of the stream on, unless the receiver has failed before. */
static enum tri_status end_stream(void *user, struct tri_error *error)
{
    struct par_spool *spool = user;
    (void)error;
    if (!spool->failed && spool->to->end)
        spool->failed = spool->to->end(spool->to->user, &spool->failure);
    return TRI_OK;
}

struct tri_sink par_spool_sink(struct par_spool *spool)
{
    return (struct tri_sink){spool, begin_stream, take_tile, end_stream};
}
