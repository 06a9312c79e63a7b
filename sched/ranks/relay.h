/* Tiles of all ranks in one place: a sink on each rank, from which rank 0 hands on everything in order, as if one
 * process had made it. The others keep their own tiles until it is their turn, or, where there is not room for all,
 * wait with handing them out; they come in batches, so that rank 0 never holds more than its own part and a batch.
 *
 * One batch after the other moves, and all ranks take part in each of these steps: whoever waits for its turn does so
 * within `take`, whoever has none left, within `end`. So all have done the same steps when `end` returns. */
#ifndef SCHED_RANKS_RELAY_H
#define SCHED_RANKS_RELAY_H

#include "ptriangle/tiles.h"
#include "sched/ranks/carrier.h"

struct par_relay {
    struct par_carrier *carrier;
    const struct tri_sink *to;      /* of rank 0; else unused */
    size_t most_bytes;              /* of a batch, to a tile's size; 0: the default */
    size_t room;                    /* bytes that another rank keeps before it waits, to a tile's size; 0: any number */
    int32_t n_attributes;
    struct par_bytes tiles;         /* the rest is the relay's */
    size_t sent;                    /* bytes of them */
    int turn;                       /* whose batches are on their way */
    struct par_bytes *out, *in;     /* [n_ranks] */
};

struct tri_sink par_relay_sink(struct par_relay *relay);

/* Collective, after the ranks have handed out all tiles to their sinks: an agreement on the status of that. All that is
 * kept is freed in any case. */
enum tri_status par_relay_finish(struct par_relay *relay, enum tri_status status, struct tri_error *error);

#endif
