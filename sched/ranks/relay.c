/* A sink that sends tiles to rank 0. Tiles are sent as bytes in the format of sched/tiles/tile_arrays.h. */
#include "sched/ranks/relay.h"

#include <stdlib.h>

#include "sched/tiles/tile_arrays.h"
#include "sched/tunables.h"

/* Appends a tile to the buffered ones. False: no memory. */
static bool pack_tile(struct par_relay *relay, const struct tri_tile *tile)
{
    const size_t n = par_tile_bytes(tile, relay->n_attributes);
    if (!par_bytes_reserve(&relay->tiles, n))
        return false;
    par_tile_pack(relay->tiles.at + relay->tiles.n, tile, relay->n_attributes);
    relay->tiles.n += n;
    return true;
}

/* --- batches */

/* Returns the size in bytes of the next batch: whole tiles that have not been sent, until the batch is full. */
static size_t next_batch(const struct par_relay *relay)
{
    size_t most = relay->most_bytes > 0 ? relay->most_bytes : PAR_RELAY_BYTES, n = 0;
    struct tri_tile tile;
    while (relay->sent + n < relay->tiles.n && n < most)
        n += par_tile_unpack(relay->tiles.at + relay->sent + n, relay->tiles.n - relay->sent - n, relay->n_attributes,
                             &tile);
    return n;
}

/* Rank 0: unpacks the tiles of a batch and passes them to the caller's sink in order. Not collective. */
static enum tri_status hand_on(struct par_relay *relay, const struct par_bytes *batch, struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    struct tri_tile tile;
    for (size_t at = 0; !status && at < batch->n;) {
        const size_t n = par_tile_unpack(batch->at + at, batch->n - at, relay->n_attributes, &tile);
        if (n == 0)
            return tri_fail(error, TRI_INTERNAL, NULL, 0, "another rank has sent an invalid tile");
        status = relay->to->take(relay->to->user, &tile, error);
        at += n;
    }
    return status;
}

/* Collective: the rank whose turn it is sends its next batch to rank 0, which passes it on. The turn moves to the next
 * rank with the sender's last batch. ends: this rank's tiles are complete. */
static enum tri_status step(struct par_relay *relay, bool ends, struct tri_error *error)
{
    const int rank = relay->carrier->rank, turn = relay->turn;
    enum tri_status status = TRI_OK;
    int64_t last = 0;
    if (rank == turn) {
        const size_t n = next_batch(relay);
        status = par_bytes_add(&relay->out[0], relay->tiles.at + relay->sent, n) ? TRI_OK : par_ranks_no_memory(error);
        relay->sent += n;
        last = ends && relay->sent == relay->tiles.n;
    }
    status = par_gather(relay->carrier, &last, 1, relay->carrier->of_each, status, error);
    relay->turn += !status && relay->carrier->of_each[turn] != 0;
    status = par_swap(relay->carrier, PAR_MOVE_TILES, relay->out, relay->in, status, error);
    if (status)
        return status;
    if (rank == 0)
        status = hand_on(relay, &relay->in[turn], error);
    par_bytes_free(&relay->in[turn], 1);
    return status;
}

/* Ranks > 0: takes part in steps until it is this rank's turn, then sends all buffered tiles. Steps are collective. */
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

static enum tri_status begin_stream(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct par_relay *relay = user;
    struct tri_stream one = *stream;
    const size_t n = (size_t)relay->carrier->n_ranks;
    relay->n_attributes = stream->n_attributes;
    relay->turn = 1;
    relay->out = calloc(n, sizeof *relay->out);
    relay->in = calloc(n, sizeof *relay->in);
    if (!relay->out || !relay->in)
        return par_ranks_no_memory(error);
    one.n_ranks = 1; /* the sink sees one process */
    one.first_vertex = one.first_triangle = one.first_segment = NULL;
    if (relay->carrier->rank > 0 || !relay->to->begin)
        return TRI_OK;
    return relay->to->begin(relay->to->user, &one, error);
}

static enum tri_status take_tile(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct par_relay *relay = user;
    if (relay->carrier->rank == 0)
        return relay->to->take(relay->to->user, tile, error);
    if (!pack_tile(relay, tile))
        return par_ranks_no_memory(error);
    return relay->room == 0 || relay->tiles.n < relay->room ? TRI_OK : send_all(relay, false, error);
}

static enum tri_status end_stream(void *user, struct tri_error *error)
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
    return (struct tri_sink){.user = relay, .begin = begin_stream, .take = take_tile, .end = end_stream};
}

enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error)
{
    par_bytes_free(relay->out, relay->carrier->n_ranks);
    par_bytes_free(relay->in, relay->carrier->n_ranks);
    free(relay->out);
    free(relay->in);
    free(relay->tiles.at);
    *relay = (struct par_relay){.carrier = relay->carrier};
    return par_agree(relay->carrier, status, error);
}
