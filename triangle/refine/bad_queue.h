/* The queue of triangles to refine.
 *
 * Triangles with a bad angle wait in buckets: urgent ones in the first bucket (refine.c defines urgent), the others
 * by their shortest edge, shortest first. This order settles the surroundings of the smallest features before larger
 * triangles are judged. At 33 degrees the mesh has 13% fewer triangles than with the worst angle first. A bucket
 * spans a quarter of an octave of the squared length and is first in, first out. It is a list of blocks, because
 * scattered single entries would each cost a cache miss when pushed and another when popped.
 *
 * Triangles that are only too large are served first in, first out, which spreads sizes evenly, but within a window.
 * If the window is full, its older half moves to a stack; if it is empty, entries return from the stack. So the work
 * stays in the cache regardless of the size of the mesh. An entry holds a triangle and its generation: if
 * the mesh has another generation for that triangle, the entry is stale. Two of three entries for sizes are stale when
 * popped, because earlier points were inserted nearby. They are filtered in batches, so the loop has no unpredictable
 * branch. */
#ifndef TRIANGLE_REFINE_BAD_QUEUE_H
#define TRIANGLE_REFINE_BAD_QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/mesh/mesh.h"
#include "triangle/tunables.h"

enum { TRI_URGENT_BUCKET = 0, TRI_BUCKETS = 512, TRI_BLOCK = 31, TRI_BATCH = 16 };

struct tri_entry {
    tri_triangle_id t; /* the triangle */
    uint32_t generation;     /* generation number of the triangle when the entry was pushed */
};

/* Consecutive entries of one bucket. */
struct tri_block {
    struct tri_entry entry[TRI_BLOCK]; /* in the order in which they were pushed */
    int32_t next; /* index of the next block; -1: none */
};

struct tri_bucket {
    int32_t first, last; /* block to pop from; block to push to; only valid if count > 0 */
    int32_t begin, end;  /* next entry to pop from the first block; next free entry of the last block */
    int32_t count;       /* entries in the bucket */
};

struct tri_bad_queue {
    struct tri_block *block; /* pool of blocks of all buckets */
    int32_t n_blocks, block_capacity, free_block; /* blocks used; allocated; first of the free list, -1: none */
    struct tri_bucket bucket[TRI_BUCKETS];        /* bad angles, by urgency and shortest edge */
    uint64_t filled[TRI_BUCKETS / 64]; /* bit b % 64 of word b / 64: bucket b is not empty */
    int64_t n_angles;                  /* entries in all buckets */

    struct tri_entry *window; /* ring buffer of TRI_WINDOW entries */
    uint32_t head, tail;      /* tail - head entries wait in the ring */
    struct tri_entry batch[TRI_BATCH]; /* entries popped from the ring that were not stale */
    int32_t next, n_batch;    /* batch[next .. n_batch - 1] are to be popped next */
    struct tri_entry *cold;   /* stack of entries that did not fit into the window */
    int64_t n_cold, cold_capacity;     /* entries on the stack; allocated */
};

/* Initialises a queue whose bytes are all zero. Returns false if memory ran out. */
bool tri_bad_queue_init(struct tri_bad_queue *queue);
void tri_bad_queue_free(struct tri_bad_queue *queue);

/* Pushes an entry into a bucket from 0 to TRI_BUCKETS - 1. The lowest bucket is popped first. Returns false if
 * memory ran out. Amortised O(1). */
bool tri_bad_queue_push_angle(struct tri_bad_queue *queue, struct tri_entry entry, int bucket);

/* Moves the older half of a full window to the stack. Returns false if memory ran out. */
bool tri_bad_queue_spill(struct tri_bad_queue *queue);

/* Pushes the entry if it is bad. To avoid an unpredictable branch, the entry is always written, but counted only if
 * it is bad. */
static inline bool tri_bad_queue_push_size(struct tri_bad_queue *queue, struct tri_entry entry, bool is_bad)
{
    if (queue->tail - queue->head == TRI_WINDOW && !tri_bad_queue_spill(queue))
        return false;
    queue->window[queue->tail % TRI_WINDOW] = entry;
    queue->tail += is_bad;
    return true;
}

/* Returns the bucket that holds the median of the entries that are not urgent, or the first such bucket if there are
 * no entries. O(buckets). */
int tri_bad_queue_median(const struct tri_bad_queue *queue);

/* Pops the next entry from the buckets below `limit`. Returns false if they are empty. Prefetches from `mesh` the
 * data that the following entry will need. */
bool tri_bad_queue_pop_angle(struct tri_bad_queue *queue, int limit, const struct tri_mesh *mesh,
                             struct tri_entry *entry);

/* Pops the next entry, bad angles first. Returns false if the queue is empty. */
bool tri_bad_queue_pop(struct tri_bad_queue *queue, const struct tri_mesh *mesh, struct tri_entry *entry);

#endif
