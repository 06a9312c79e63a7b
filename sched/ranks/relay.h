/* Tiles of all ranks in one place: a sink on each rank, from which rank 0 hands on everything in order, as if one
 * process had made it. Ranks but the first keep their own tiles until it is their turn; they come in pieces, so that no
 * rank ever holds more than its own part and a piece. */
#ifndef SCHED_RANKS_RELAY_H
#define SCHED_RANKS_RELAY_H

#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"

struct par_relay {
    struct par_carrier *carrier;
    const struct tri_sink *to;      /* of rank 0; else unused */
    size_t most_bytes;              /* of a piece, to a tile's size; 0: the default */
    int32_t n_attributes;
    struct par_bytes tiles;
};

struct tri_sink par_relay_sink(struct par_relay *relay);

/* Collective, after the ranks have handed out all tiles to their sinks; an agreement on the status of that is its first
 * act. All that is kept is freed in any case. */
enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error);

#endif
