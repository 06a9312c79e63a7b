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

/* Points *tile at what is packed, of which there are n bytes; returns how many it takes, or 0: it is no tile. */
static size_t unpack(const struct par_relay *relay, const char *bytes, size_t n, struct tri_tile *tile)
{
    const void *array[ARRAYS];
    size_t size[ARRAYS], at = filled_up(sizeof *tile);
    if (n < at)
        return 0;
    memcpy(tile, bytes, sizeof *tile);
    if (tile->n_vertices < 0 || tile->n_triangles < 0 || tile->n_segments < 0)
        return 0;
    sizes_of(relay, tile, size);
    for (int k = 0; k < ARRAYS; k++) {
        if (n - at < filled_up(size[k]))
            return 0;
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

/* --- pieces */

/* Whole tiles that have not been sent, about as many bytes as are good. */
static size_t next_piece(const struct par_relay *relay)
{
    size_t most = relay->most_bytes > 0 ? relay->most_bytes : MOST_BYTES, n = 0;
    struct tri_tile tile;
    while (relay->sent + n < relay->tiles.n && n < most)
        n += unpack(relay, relay->tiles.at + relay->sent + n, relay->tiles.n - relay->sent - n, &tile);
    return n;
}

static enum tri_status hand_on(struct par_relay *relay, const struct par_bytes *piece, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    struct tri_tile tile;
    for (size_t at = 0; !status && at < piece->n;) {
        const size_t n = unpack(relay, piece->at + at, piece->n - at, &tile);
        if (n == 0)
            return tri_fail(error, TRI_INTERNAL, NULL, 0, "what came from another rank is no tile");
        status = relay->to->take(relay->to->user, &tile, error);
        at += n;
    }
    return status;
}

/* Of the rank whose turn it is the next piece goes to rank 0. ends: this one has no more tiles to come. Collective. */
static enum tri_status step(struct par_relay *relay, bool ends, struct tri_error *error)
{
    const int rank = relay->carrier->rank, turn = relay->turn;
    enum tri_status status = TRI_OK;
    int64_t last = 0;
    if (rank == turn) {
        const size_t n = next_piece(relay);
        status = par_bytes_add(&relay->out[0], relay->tiles.at + relay->sent, n) ? TRI_OK : no_memory(error);
        relay->sent += n;
        last = ends && relay->sent == relay->tiles.n;
    }
    status = par_gather(relay->carrier, &last, 1, relay->told, status, error);
    status = par_swap(relay->carrier, PAR_MOVE_TILES, relay->out, relay->in, status, error);
    if (status)
        return status;
    relay->turn += relay->told[turn] != 0;
    if (rank == 0)
        status = hand_on(relay, &relay->in[turn], error);
    free(relay->in[turn].at);
    relay->in[turn] = (struct par_bytes){0};
    return status;
}

/* Until all that is kept has been sent. */
static enum tri_status send_all(struct par_relay *relay, bool ends, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    while (!status && relay->turn < relay->carrier->rank)
        status = step(relay, false, error);
    while (!status && (relay->sent < relay->tiles.n || (ends && relay->turn == relay->carrier->rank)))
        status = step(relay, ends, error);
    relay->tiles.n = relay->sent = 0;
    return status;
}

/* --- the sink */

static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct par_relay *relay = user;
    struct tri_stream one = *stream;
    const size_t n = (size_t)relay->carrier->n_ranks;
    relay->n_attributes = stream->n_attributes;
    relay->turn = 1;
    relay->out = calloc(n, sizeof *relay->out);
    relay->in = calloc(n, sizeof *relay->in);
    relay->told = calloc(n, sizeof *relay->told);
    if (!relay->out || !relay->in || !relay->told)
        return no_memory(error);
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
    if (!pack(relay, tile))
        return no_memory(error);
    return relay->room == 0 || relay->tiles.n < relay->room ? TRI_OK : send_all(relay, false, error);
}

static enum tri_status end(void *user, struct tri_error *error)
{
    struct par_relay *relay = user;
    const struct par_carrier *carrier = relay->carrier;
    enum tri_status status = carrier->rank > 0 ? send_all(relay, true, error) : TRI_OK;
    while (!status && relay->turn < carrier->n_ranks)
        status = step(relay, false, error);
    if (!status && carrier->rank == 0 && relay->to->end)
        status = relay->to->end(relay->to->user, error);
    return status;
}

struct tri_sink par_relay_sink(struct par_relay *relay)
{
    return (struct tri_sink){.user = relay, .begin = begin, .take = take, .end = end};
}

enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error)
{
    for (int p = 0; p < relay->carrier->n_ranks; p++) {
        if (relay->out)
            free(relay->out[p].at);
        if (relay->in)
            free(relay->in[p].at);
    }
    free(relay->out);
    free(relay->in);
    free(relay->told);
    free(relay->tiles.at);
    *relay = (struct par_relay){.carrier = relay->carrier};
    return par_agree(relay->carrier, status, error);
}
