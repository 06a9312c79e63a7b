/* Gathers the tiles of all ranks on rank 0. Each rank has a sink; rank 0 passes all tiles to its own sink in order, as
 * if one process had made the mesh. The other ranks buffer their tiles until it is their turn. A rank whose buffer is
 * full blocks in `take`. Tiles are sent in batches, so rank 0 holds at most its own part and one batch.
 *
 * Batches are sent one at a time. Each batch is a collective step: a rank that waits for its turn takes part from
 * within `take`, and a rank without further tiles from within `end`. All ranks have done the same number of steps when
 * `end` returns. */
#ifndef SCHED_RANKS_RELAY_H
#define SCHED_RANKS_RELAY_H

#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"

struct par_relay {
    struct par_carrier *carrier;
    const struct tri_sink *to;      /* rank 0: receives all tiles; unused on other ranks */
    size_t most_bytes;              /* size of a batch, exceeded by less than a tile; 0: default */
    size_t room;                    /* bytes that a rank > 0 buffers before it blocks; 0: no limit */
    int32_t n_attributes;
    struct par_bytes tiles;         /* buffered, packed; this and the rest are private */
    size_t sent;                    /* bytes of `tiles` that have been sent */
    int turn;                       /* the rank that sends its batches now */
    struct par_bytes *out, *in;     /* [n_ranks] */
};

struct tri_sink par_relay_sink(struct par_relay *relay);

/* Collective, after the ranks have passed all tiles to their sinks: agrees on the status of that. Always frees the
 * buffers. */
enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error);

#endif
