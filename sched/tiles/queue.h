/* A sink with a bounded queue. Tiles are copied, and a second thread passes them on in order, so that the thread that
 * makes tiles does not wait for a disk.
 *
 * If the queue is full, the caller blocks until there is space. A status returned by the target sink `to` is returned
 * to the caller with the next tile or at the end. The caller's thread calls `begin` and `end` of `to`; between these,
 * only the second thread calls `take`. If no thread can be started, the caller's thread calls `take` as well. */
#ifndef SCHED_TILES_QUEUE_H
#define SCHED_TILES_QUEUE_H

#include "ptriangle/tiles.h"

struct tri_monitor;
struct tri_thread;

struct par_queue {
    const struct tri_sink *to; /* borrowed */
    int64_t most_bytes;        /* limit of `bytes`; a single larger tile is accepted */
    int32_t n_attributes;      /* attributes of a vertex */
    struct tri_thread *thread; /* NULL: no second thread; it shares the fields below, protected by the monitor */
    struct tri_monitor *monitor; /* the lock, and the condition for which both threads wait */
    bool closing;              /* no more tiles will be added: the thread ends when the queue is empty */
    struct par_queued *first, *last; /* the queued tiles; NULL: none */
    int64_t bytes;             /* size of the queued tiles and of the one being passed on */
    enum tri_status status;    /* first error of `to`, after which tiles are dropped; or TRI_OK */
    struct tri_error error;    /* details of that error */
};

/* Initialises a queue. *queue must not move in memory afterwards. False: no memory. */
bool par_queue_begin(struct par_queue *queue, const struct tri_sink *to, int64_t most_bytes);

/* Returns the queue's sink, valid as long as the queue. Its functions return TRI_NO_MEMORY or the status of `to`. Its
 * `begin` starts the second thread; a second call of `begin` is passed on as well. */
struct tri_sink par_queue_sink(struct par_queue *queue);

/* Ends the thread. Queued tiles are dropped. */
void par_queue_free(struct par_queue *queue);

#endif
