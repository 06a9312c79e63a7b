/* One lock, one condition. INVARIANT under the lock: `bytes` is the total size of the queued tiles and of the tile that
 * is being passed on. */
#include "sched/tiles/queue.h"

#include <assert.h>
#include <stdlib.h>

#include "sched/tiles/tile_arrays.h"
#include "triangle/base/status.h"
#include "triangle/base/system.h"

struct par_queued {
    struct par_queued *next; /* NULL: last in the queue */
    int64_t bytes;           /* size of this struct and the packed tile */
    struct tri_tile tile;    /* its arrays point into the packed tile, which follows this struct in memory */
};

/* Returns a copy of the tile; NULL: no memory. */
static struct par_queued *copy_of(const struct tri_tile *tile, int32_t n_attributes)
{
    const size_t n = par_tile_bytes(tile, n_attributes);
    struct par_queued *copy = malloc(sizeof *copy + n);
    if (!copy)
        return NULL;
    *copy = (struct par_queued){.bytes = (int64_t)(sizeof *copy + n)};
    par_tile_pack((char *)(copy + 1), tile, n_attributes);
    par_tile_unpack((const char *)(copy + 1), n, n_attributes, &copy->tile);
    return copy;
}

/* --- the thread */

/* Removes and returns the first tile of the queue, after waiting for one; NULL: no more tiles will be added. Called
 * under the lock. */
static struct par_queued *next_of(struct par_queue *q)
{
    while (!q->first && !q->closing)
        tri_monitor_wait(q->monitor);
    struct par_queued *next = q->first;
    if (next)
        q->first = next->next;
    if (!q->first)
        q->last = NULL;
    return next;
}

/* The thread: passes tiles to the target sink. */
static void *pass_tiles_on(void *user)
{
    struct par_queue *q = user;
    struct tri_error error = {0};
    struct par_queued *next;
    tri_monitor_enter(q->monitor);
    while ((next = next_of(q))) {
        const bool wanted = q->status == TRI_OK;
        tri_monitor_leave(q->monitor);
        const enum tri_status status = wanted ? q->to->take(q->to->user, &next->tile, &error) : TRI_OK;
        const int64_t bytes = next->bytes;
        free(next);
        tri_monitor_enter(q->monitor);
        q->bytes -= bytes;
        if (status) {
            q->status = status;
            q->error = error;
        }
        tri_monitor_wake(q->monitor);
    }
    tri_monitor_leave(q->monitor);
    return NULL;
}

/* Ends the thread after all queued tiles have been passed on. drop: after the current tile; the others are dropped. */
static void end_thread(struct par_queue *q, bool drop)
{
    if (!q->thread)
        return;
    tri_monitor_enter(q->monitor);
    q->closing = true;
    if (drop && !q->status)
        q->status = TRI_STOPPED;
    tri_monitor_wake(q->monitor);
    tri_monitor_leave(q->monitor);
    tri_thread_join(q->thread);
    q->thread = NULL;
    q->closing = false;
    assert(!q->first && q->bytes == 0);
}

/* --- the sink */

/* Returns the status of the target sink so far. */
static enum tri_status status_so_far(const struct par_queue *q, struct tri_error *error)
{
    if (q->status && error)
        *error = q->error;
    return q->status;
}

/* Begins a stream and starts the thread. Tiles of an earlier stream are dropped. */
static enum tri_status begin(void *user, const struct tri_stream *stream, struct tri_error *error)
{
    struct par_queue *q = user;
    end_thread(q, true);
    q->status = TRI_OK;
    q->n_attributes = stream->n_attributes;
    enum tri_status status = q->to->begin ? q->to->begin(q->to->user, stream, error) : TRI_OK;
    if (!status)
        q->thread = tri_thread_start(pass_tiles_on, q);
    return status;
}

/* Appends a copied tile to the queue, after waiting for space. */
static enum tri_status add(struct par_queue *q, struct par_queued *copy, struct tri_error *error)
{
    tri_monitor_enter(q->monitor);
    while (!q->status && q->bytes > 0 && q->bytes + copy->bytes > q->most_bytes)
        tri_monitor_wait(q->monitor);
    const enum tri_status status = status_so_far(q, error);
    if (!status) {
        *(q->last ? &q->last->next : &q->first) = copy;
        q->last = copy;
        q->bytes += copy->bytes;
        tri_monitor_wake(q->monitor);
    }
    tri_monitor_leave(q->monitor);
    if (status)
        free(copy);
    return status;
}

/* Queues a copy of the tile. Without a thread, passes the tile on at once. */
static enum tri_status take(void *user, const struct tri_tile *tile, struct tri_error *error)
{
    struct par_queue *q = user;
    if (!q->thread)
        return q->to->take(q->to->user, tile, error);
    struct par_queued *copy = copy_of(tile, q->n_attributes);
    if (copy)
        return add(q, copy, error);
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "no memory for a tile of %d triangles", (int)tile->n_triangles);
}

/* Ends the stream after all queued tiles have been passed on. */
static enum tri_status end(void *user, struct tri_error *error)
{
    struct par_queue *q = user;
    end_thread(q, false);
    enum tri_status status = status_so_far(q, error);
    return status || !q->to->end ? status : q->to->end(q->to->user, error);
}

/* --- the queue */

bool par_queue_begin(struct par_queue *queue, const struct tri_sink *to, int64_t most_bytes)
{
    *queue = (struct par_queue){.to = to, .most_bytes = most_bytes, .monitor = tri_monitor_new()};
    return queue->monitor;
}

struct tri_sink par_queue_sink(struct par_queue *queue) { return (struct tri_sink){queue, begin, take, end}; }

void par_queue_free(struct par_queue *queue)
{
    end_thread(queue, true);
    tri_monitor_free(queue->monitor);
}
