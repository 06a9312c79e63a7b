/* The triangles that wait to be refined.
 *
 * Two kinds. Those whose angle is bad wait in buckets, one for the urgent ones, which come first (refine.c says which),
 * the others by their shortest edge, shortest first: what grows out of the smallest features is settled before larger
 * triangles are asked, and the mesh comes out smaller (by 13% at 33 degrees against worst
 * angle first). Within a bucket (a quarter of an octave of the squared length) first come, first served. A bucket is a
 * list of blocks: where many wait, entries that lie one by one anywhere in memory each cost a miss of the cache when
 * they come, and another when they go. Those that are only too large wait first in, first out, which spreads sizes
 * evenly, but in a window: when it is full its older half goes to a stack and is taken back when the window has run
 * empty. So the work stays where the cache is, for any size of mesh.
 *
 * An entry names a triangle, and which life of its number it was in; whoever takes an entry compares. Two of three
 * entries for sizes are out of date when their turn comes, for the points before them were inserted nearby. So these
 * leave the window in batches, of which those are kept that are up to date: a loop without a branch that depends on it,
 * which could not be predicted. */
#ifndef TRIANGLE_REFINE_BAD_QUEUE_H
#define TRIANGLE_REFINE_BAD_QUEUE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/mesh/mesh.h"
#include "triangle/tunables.h"

enum { TRI_URGENT_BUCKET = 0, TRI_BUCKETS = 512, TRI_BLOCK = 31, TRI_BATCH = 16 };

struct tri_entry {
    tri_triangle_id t;
    uint32_t life;
};

/* Entries of one bucket that were pushed one after the other. */
struct tri_block {
    struct tri_entry entry[TRI_BLOCK];
    int32_t next; /* block; -1: none */
};

struct tri_bucket {
    int32_t first, last; /* block that is served, and that is filled; only where count > 0 */
    int32_t begin, end;  /* entry of the first that is served next, and of the last that is filled next */
    int32_t count;       /* entries */
};

struct tri_bad_queue {
    struct tri_block *block; /* pool of the buckets' blocks */
    int32_t n_blocks, block_capacity, free_block;
    struct tri_bucket bucket[TRI_BUCKETS];
    uint64_t filled[TRI_BUCKETS / 64]; /* bit b % 64 of word b / 64: bucket b holds something */
    int64_t n_angles;                  /* entries in all buckets */

    struct tri_entry *window; /* ring of TRI_WINDOW */
    uint32_t head, tail;      /* tail - head entries wait in the ring */
    struct tri_entry batch[TRI_BATCH]; /* taken from the ring, and found to be up to date */
    int32_t next, n_batch;    /* batch[next .. n_batch - 1] are still to be served */
    struct tri_entry *cold;   /* stack of what the window had no room for */
    int64_t n_cold, cold_capacity;
};

/* The queue is all zero. False: no memory. */
bool tri_bad_queue_init(struct tri_bad_queue *queue);
void tri_bad_queue_free(struct tri_bad_queue *queue);

/* bucket: 0 .. TRI_BUCKETS - 1, the lowest is served first. False where memory ran out. Amortised O(1). */
bool tri_bad_queue_push_angle(struct tri_bad_queue *queue, struct tri_entry entry, int bucket);

/* Moves the older half of a full window to the stack. */
bool tri_bad_queue_spill(struct tri_bad_queue *queue);

/* Pushes the entry if it is bad, which nobody can predict: it is written in any case, and counted if so. */
static inline bool tri_bad_queue_push_size(struct tri_bad_queue *queue, struct tri_entry entry, bool is_bad)
{
    if (queue->tail - queue->head == TRI_WINDOW && !tri_bad_queue_spill(queue))
        return false;
    queue->window[queue->tail % TRI_WINDOW] = entry;
    queue->tail += is_bad;
    return true;
}

/* The bucket that holds the median of the entries that are not urgent; the first such bucket where there is none.
 * O(buckets). */
int tri_bad_queue_median(const struct tri_bad_queue *queue);

/* Takes the next entry from the buckets below `limit`. False where none waits there. mesh: what entries speak of, of
 * which that is fetched ahead which the entry after this one will need. */
bool tri_bad_queue_pop_angle(struct tri_bad_queue *queue, int limit, const struct tri_mesh *mesh,
                             struct tri_entry *entry);

/* Takes the next entry: bad angles first. False where nothing waits. */
bool tri_bad_queue_pop(struct tri_bad_queue *queue, const struct tri_mesh *mesh, struct tri_entry *entry);

#endif
