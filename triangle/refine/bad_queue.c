/* Buckets are linked lists of blocks from one pool. Sizes wait in a ring buffer, with a stack for older entries. */
#include "triangle/refine/bad_queue.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"

enum { MASK = TRI_WINDOW - 1, HALF = TRI_WINDOW / 2, NIL = -1, MOST_BLOCKS = INT32_MAX / TRI_BLOCK };

bool tri_bad_queue_init(struct tri_bad_queue *queue)
{
    queue->free_block = NIL;
    queue->window = malloc(TRI_WINDOW * sizeof *queue->window);
    return queue->window;
}

void tri_bad_queue_free(struct tri_bad_queue *queue)
{
    free(queue->block);
    free(queue->window);
    free(queue->cold);
    queue->block = NULL;
    queue->window = queue->cold = NULL;
}

static int32_t allocate_block(struct tri_bad_queue *queue)
{
    int32_t block = queue->free_block;
    if (block != NIL)
        queue->free_block = queue->block[block].next;
    else if (queue->n_blocks < MOST_BLOCKS &&
             tri_grow(&queue->block, &queue->block_capacity, queue->n_blocks + 1, sizeof *queue->block))
        block = queue->n_blocks++;
    if (block != NIL)
        queue->block[block].next = NIL;
    return block;
}

/* Appends a block to the bucket. Returns false if memory ran out. */
static bool append_block(struct tri_bad_queue *queue, struct tri_bucket *bucket)
{
    int32_t block = allocate_block(queue);
    if (block == NIL)
        return false;
    if (bucket->count == 0) {
        bucket->first = block;
        bucket->begin = 0;
    } else {
        queue->block[bucket->last].next = block;
    }
    bucket->last = block;
    bucket->end = 0;
    return true;
}

bool tri_bad_queue_push_angle(struct tri_bad_queue *queue, struct tri_entry entry, int b)
{
    assert(b >= 0 && b < TRI_BUCKETS);
    struct tri_bucket *bucket = &queue->bucket[b];
    if ((bucket->count == 0 || bucket->end == TRI_BLOCK) && !append_block(queue, bucket))
        return false;
    queue->block[bucket->last].entry[bucket->end++] = entry;
    bucket->count++;
    queue->n_angles++;
    queue->filled[b / 64] |= UINT64_C(1) << b % 64;
    return true;
}

bool tri_bad_queue_spill(struct tri_bad_queue *queue)
{
    if (!tri_grow_far(&queue->cold, &queue->cold_capacity, queue->n_cold + HALF, sizeof *queue->cold))
        return false;
    for (int i = 0; i < HALF; i++)
        queue->cold[queue->n_cold++] = queue->window[queue->head++ & MASK];
    return true;
}

static void refill_window(struct tri_bad_queue *queue)
{
    int64_t n = queue->n_cold < HALF ? queue->n_cold : HALF;
    assert(queue->head == queue->tail);
    queue->n_cold -= n;
    for (int64_t i = 0; i < n; i++)
        queue->window[queue->tail++ & MASK] = queue->cold[queue->n_cold + i];
}

static int lowest_bit(uint64_t word)
{
    int bit = 0;
    for (int half = 32; half > 0; half /= 2)
        if (!(word & ((UINT64_C(1) << half) - 1))) {
            word >>= half;
            bit += half;
        }
    return bit;
}

/* Consecutive entries of a bucket are ordered by edge length, so their triangles are scattered in memory. Prefetches
 * the surroundings of the next triangle and, for the entry after it, the triangle alone. */
static void fetch_ahead(const struct tri_bad_queue *queue, const struct tri_bucket *bucket, const struct tri_mesh *mesh)
{
    const struct tri_entry *soon = &queue->block[bucket->first].entry[bucket->begin];
    if (bucket->count > 1 && bucket->begin + 1 < TRI_BLOCK)
        __builtin_prefetch(&mesh->tri[soon[1].t]);
    const struct tri_triangle *t = &mesh->tri[soon->t];
    if (t->generation != soon->generation || !tri_is_live(t))
        return;
    for (int k = 0; k < 3; k++) {
        __builtin_prefetch(&mesh->xy[t->v[k]]);
        __builtin_prefetch(&mesh->feature[t->v[k]]);
        if (t->n[k] >= 0)
            __builtin_prefetch(&mesh->tri[tri_of(t->n[k])]);
    }
}

/* Frees the bucket's first block. All its entries have been popped. */
static void free_first_block(struct tri_bad_queue *queue, struct tri_bucket *bucket)
{
    int32_t block = bucket->first;
    bucket->first = queue->block[block].next;
    bucket->begin = 0;
    queue->block[block].next = queue->free_block;
    queue->free_block = block;
}

static void pop_first_entry(struct tri_bad_queue *queue, int b, struct tri_entry *entry)
{
    struct tri_bucket *bucket = &queue->bucket[b];
    assert(bucket->count > 0);
    *entry = queue->block[bucket->first].entry[bucket->begin++];
    bucket->count--;
    queue->n_angles--;
    if (bucket->count == 0 || bucket->begin == TRI_BLOCK)
        free_first_block(queue, bucket);
    if (bucket->count == 0)
        queue->filled[b / 64] &= ~(UINT64_C(1) << b % 64);
}

bool tri_bad_queue_pop_angle(struct tri_bad_queue *queue, int limit, const struct tri_mesh *mesh,
                             struct tri_entry *entry)
{
    for (int word = 0; 64 * word < limit; word++) {
        if (!queue->filled[word])
            continue;
        int b = 64 * word + lowest_bit(queue->filled[word]);
        if (b >= limit)
            return false;
        pop_first_entry(queue, b, entry);
        if (queue->bucket[b].count > 0)
            fetch_ahead(queue, &queue->bucket[b], mesh);
        return true;
    }
    return false;
}

/* Moves the next entries from the window to the batch, and drops stale ones. */
static void filter_batch(struct tri_bad_queue *queue, const struct tri_triangle *tri)
{
    uint32_t waiting = queue->tail - queue->head, n = waiting < TRI_BATCH ? waiting : TRI_BATCH;
    int32_t kept = 0;
    for (uint32_t i = 0; i < n; i++) {
        struct tri_entry entry = queue->window[queue->head++ & MASK];
        queue->batch[kept] = entry;
        kept += tri[entry.t].generation == entry.generation;
    }
    queue->next = 0;
    queue->n_batch = kept;
}

bool tri_bad_queue_pop(struct tri_bad_queue *queue, const struct tri_mesh *mesh, struct tri_entry *entry)
{
    if (queue->n_angles > 0)
        return tri_bad_queue_pop_angle(queue, TRI_BUCKETS, mesh, entry);
    while (queue->next == queue->n_batch) {
        if (queue->head == queue->tail && queue->n_cold > 0)
            refill_window(queue);
        if (queue->head == queue->tail)
            return false;
        filter_batch(queue, mesh->tri);
    }
    *entry = queue->batch[queue->next++];
    return true;
}

int tri_bad_queue_median(const struct tri_bad_queue *queue)
{
    const int64_t all = queue->n_angles - queue->bucket[TRI_URGENT_BUCKET].count;
    int64_t below = 0;
    int bucket = TRI_URGENT_BUCKET + 1; /* the loop ends at the last entry at the latest */
    while (all > 0 && 2 * (below += queue->bucket[bucket].count) < all)
        bucket++;
    return bucket;
}
