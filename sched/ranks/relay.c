/* A tile on its way: its struct, then its arrays in the order of the struct, each filled up to eight bytes. */
#include "sched/ranks/relay.h"

#include <stdlib.h>
#include <string.h>

static const size_t MOST_BYTES = (size_t)1 << 25;

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for a rank's tiles");
}

static size_t filled_up(size_t n) { return (n + 7) / 8 * 8; }

/* Bytes of the arrays of a tile. */
enum { ARRAYS = 7 };
static void sizes_of(const struct par_relay *relay, const struct tri_tile *tile, size_t size[ARRAYS])
{
    size_t v = (size_t)tile->n_vertices, t = (size_t)tile->n_triangles, s = (size_t)tile->n_segments;
    size[0] = v * sizeof *tile->points;
    size[1] = v * sizeof *tile->point_markers;
    size[2] = v * (size_t)relay->n_attributes * sizeof *tile->attributes;
    size[3] = t * sizeof *tile->corners;
    size[4] = t * sizeof *tile->regions;
    size[5] = s * sizeof *tile->ends;
    size[6] = s * sizeof *tile->segment_markers;
}

static bool pack(struct par_relay *relay, const struct tri_tile *tile)
{
    const void *array[ARRAYS] = {tile->points, tile->point_markers, tile->attributes, tile->corners,
                                 tile->regions, tile->ends, tile->segment_markers};
    size_t size[ARRAYS], sum = filled_up(sizeof *tile);
    sizes_of(relay, tile, size);
    for (int k = 0; k < ARRAYS; k++)
        sum += filled_up(size[k]);
    if (!par_bytes_reserve(&relay->tiles, sum))
        return false;
    char *at = relay->tiles.at + relay->tiles.n;
    memset(at, 0, sum);
    memcpy(at, tile, sizeof *tile);
    at += filled_up(sizeof *tile);
    for (int k = 0; k < ARRAYS; k++) {
        if (size[k] > 0)
            memcpy(at, array[k], size[k]);
        at += filled_up(size[k]);
    }
    relay->tiles.n += sum;
    return true;
}

/* Points *tile at what is packed; returns its bytes. */
static size_t unpack(const struct par_relay *relay, const char *bytes, struct tri_tile *tile)
{
    const void *array[ARRAYS];
    size_t size[ARRAYS], at = filled_up(sizeof *tile);
    memcpy(tile, bytes, sizeof *tile);
    sizes_of(relay, tile, size);
    for (int k = 0; k < ARRAYS; k++) {
        array[k] = bytes + at;
        at += filled_up(size[k]);
    }
    tile->points = (const double(*)[2])array[0];
    tile->point_markers = array[1];
    tile->attributes = array[2];
    tile->corners = (const int64_t(*)[3])array[3];
    tile->regions = array[4];
    tile->ends = (const int64_t(*)[2])array[5];
    tile->segment_markers = array[6];
    return at;
}

/* --- the sink */

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct par_relay *relay = user;
    struct tri_stream one = *stream;
    relay->n_attributes = stream->n_attributes;
    one.n_ranks = 1; /* to whoever takes them, all tiles are of one process */
    one.first_vertex = one.first_triangle = one.first_segment = NULL;
    if (relay->carrier->rank > 0 || !relay->to->begin)
        return TRI_OK;
    return relay->to->begin(relay->to->user, &one, error);
}

static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct par_relay *relay = user;
    if (relay->carrier->rank == 0)
        return relay->to->take(relay->to->user, tile, error);
    return pack(relay, tile) ? TRI_OK : no_memory(error);
}

struct tri_sink par_relay_sink(struct par_relay *relay)
{
    return (struct tri_sink){.user = relay, .begin = begin, .take = take};
}

/* --- turns */

/* Whole tiles from `at` on, about as many bytes as are good. */
static size_t piece_of(const struct par_relay *relay, size_t at)
{
    size_t most = relay->most_bytes > 0 ? relay->most_bytes : MOST_BYTES, n = 0;
    struct tri_tile tile;
    while (at + n < relay->tiles.n && n < most)
        n += unpack(relay, relay->tiles.at + at + n, &tile);
    return n;
}

static int64_t pieces_of(const struct par_relay *relay)
{
    int64_t pieces = 0;
    for (size_t at = 0; at < relay->tiles.n; at += piece_of(relay, at))
        pieces++;
    return pieces;
}

static enum tri_status hand_on(struct par_relay *relay, const struct par_bytes *piece, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    struct tri_tile tile;
    for (size_t at = 0; !status && at < piece->n;) {
        at += unpack(relay, piece->at + at, &tile);
        status = relay->to->take(relay->to->user, &tile, error);
    }
    return status;
}

/* One rank's next piece goes to rank 0. */
static enum tri_status move_piece(struct par_relay *relay, int turn, size_t *at, struct par_bytes *out,
                                  struct par_bytes *in, enum tri_status status, struct tri_error *error)
{
    const struct par_carrier *carrier = relay->carrier;
    if (!status && carrier->rank == turn) {
        size_t n = piece_of(relay, *at);
        if (!par_bytes_add(&out[0], relay->tiles.at + *at, n))
            status = no_memory(error);
        *at += n;
    }
    status = par_swap(relay->carrier, PAR_MOVE_TILES, out, in, status, error);
    if (!status && carrier->rank == 0)
        status = hand_on(relay, &in[turn], error);
    free(in[turn].at);
    in[turn] = (struct par_bytes){0};
    return status;
}

static enum tri_status take_turns(struct par_relay *relay, struct par_bytes *out, struct par_bytes *in,
                                  const int64_t *pieces, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    size_t at = 0;
    for (int turn = 1; turn < relay->carrier->n_ranks; turn++)
        for (int64_t i = 0; i < pieces[turn] && !relay->carrier->ended; i++)
            status = move_piece(relay, turn, &at, out, in, status, error);
    if (!status && relay->carrier->rank == 0 && relay->to->end)
        status = relay->to->end(relay->to->user, error);
    return par_agree(relay->carrier, status, error);
}

enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error)
{
    size_t n = (size_t)relay->carrier->n_ranks;
    struct par_bytes *out = calloc(n, sizeof *out), *in = calloc(n, sizeof *in);
    int64_t mine = relay->carrier->rank > 0 ? pieces_of(relay) : 0, *pieces = calloc(n, sizeof *pieces);
    if (!status && !(out && in && pieces))
        status = no_memory(error);
    status = par_gather(relay->carrier, &mine, 1, pieces, status, error);
    if (!status)
        status = take_turns(relay, out, in, pieces, error);
    for (size_t p = 0; out && p < n; p++)
        free(out[p].at);
    for (size_t p = 0; in && p < n; p++)
        free(in[p].at);
    free(out);
    free(in);
    free(pieces);
    free(relay->tiles.at);
    relay->tiles = (struct par_bytes){0};
    return status;
}
