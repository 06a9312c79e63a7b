/* A sink behind a queue: tiles are copied, and another thread hands them on in their order, so that whoever makes them
 * does not wait for a disk.
 *
 * The queue is bounded: who hands out tiles faster than they are taken waits. What `to` returns comes back with the
 * next tile or at the end. `to` is told of the beginning and the end by the caller's thread, and between them of tiles
 * by the other one alone. Where there are no more threads, all is done by the caller's. */
#ifndef SCHED_TILES_QUEUE_H
#define SCHED_TILES_QUEUE_H

#include "ptriangle/tiles.h"

struct tri_monitor;
struct tri_thread;

struct par_queue {
    const struct tri_sink *to; /* borrowed */
    int64_t most_bytes;        /* that wait; one tile may be larger */
    int32_t n_attributes;
    struct tri_thread *thread; /* NULL: there is none; what follows is shared with it, inside the monitor */
    struct tri_monitor *monitor;
    bool closing;              /* no more tiles come: it ends when none is left */
    struct par_queued *first, *last;
    int64_t bytes;             /* of the tiles that wait, and of the one that is handed on */
    enum tri_status status;    /* what `to` has said; tiles are dropped from then on */
    struct tri_error error;
};

/* *queue may not move. False: no memory. */
bool par_queue_begin(struct par_queue *queue, const struct tri_sink *to, int64_t most_bytes);

/* Its sink; lives as long as the queue. TRI_NO_MEMORY, and what `to` says. A second beginning is handed on, too. */
struct tri_sink par_queue_sink(struct par_queue *queue);

/* Ends the thread; tiles that wait are dropped. */
void par_queue_free(struct par_queue *queue);

#endif
