/* Buckets of linked lists over one pool; a ring with a stack behind it. */
#include "triangle/bad_queue.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/grow.h"

enum { MASK = TRI_WINDOW - 1, HALF = TRI_WINDOW / 2, NIL = -1 };

bool tri_bad_queue_init(struct tri_bad_queue *queue)
{
    *queue = (struct tri_bad_queue){.free_node = NIL};
    for (int b = 0; b < TRI_BUCKETS; b++)
        queue->first[b] = queue->last[b] = NIL;
    queue->window = malloc(TRI_WINDOW * sizeof *queue->window);
    return queue->window;
}

void tri_bad_queue_free(struct tri_bad_queue *queue)
{
    free(queue->node);
    free(queue->window);
    free(queue->cold);
    *queue = (struct tri_bad_queue){0};
}

static int32_t take_node(struct tri_bad_queue *queue)
{
    if (queue->free_node != NIL) {
        int32_t node = queue->free_node;
        queue->free_node = queue->node[node].next;
        return node;
    }
    bool room = tri_grow(&queue->node, &queue->node_capacity, queue->n_nodes + 1, sizeof *queue->node);
    return room ? queue->n_nodes++ : NIL;
}

bool tri_bad_queue_push_angle(struct tri_bad_queue *queue, struct tri_entry entry, int bucket)
{
    int32_t node = take_node(queue);
    assert(bucket >= 0 && bucket < TRI_BUCKETS);
    if (node == NIL)
        return false;
    queue->node[node] = (struct tri_node){entry, NIL};
    if (queue->first[bucket] == NIL)
        queue->first[bucket] = node;
    else
        queue->node[queue->last[bucket]].next = node;
    queue->last[bucket] = node;
    queue->count[bucket]++;
    queue->filled[bucket / 64] |= UINT64_C(1) << bucket % 64;
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

static void refill(struct tri_bad_queue *queue)
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

/* The entries behind one that is taken lie scattered, being in order of their edges: what the point of the next will
 * look at is fetched while that of this one is worked on, and the triangle of the one after it. */
static void fetch_ahead(const struct tri_bad_queue *queue, int32_t node, const struct tri_mesh *mesh)
{
    if (node == NIL)
        return;
    const struct tri_node *soon = &queue->node[node];
    const struct tri_triangle *t = &mesh->tri[soon->entry.t];
    if (soon->next != NIL)
        __builtin_prefetch(&mesh->tri[queue->node[soon->next].entry.t]);
    if (t->life != soon->entry.life || !tri_is_live(t))
        return;
    for (int k = 0; k < 3; k++) {
        __builtin_prefetch(&mesh->xy[t->v[k]]);
        __builtin_prefetch(&mesh->feature[t->v[k]]);
        if (t->n[k] >= 0)
            __builtin_prefetch(&mesh->tri[tri_of(t->n[k])]);
    }
}

bool tri_bad_queue_pop_angle(struct tri_bad_queue *queue, int limit, const struct tri_mesh *mesh,
                             struct tri_entry *entry)
{
    for (int word = 0; 64 * word < limit; word++) {
        if (!queue->filled[word])
            continue;
        int bucket = 64 * word + lowest_bit(queue->filled[word]);
        if (bucket >= limit)
            return false;
        int32_t node = queue->first[bucket];
        assert(node != NIL && queue->count[bucket] > 0);
        *entry = queue->node[node].entry;
        queue->first[bucket] = queue->node[node].next;
        queue->count[bucket]--;
        if (queue->first[bucket] == NIL)
            queue->filled[word] &= ~(UINT64_C(1) << bucket % 64);
        queue->node[node].next = queue->free_node;
        queue->free_node = node;
        fetch_ahead(queue, queue->first[bucket], mesh);
        return true;
    }
    return false;
}

/* Of the next entries in the window, those that are up to date. */
static void take_batch(struct tri_bad_queue *queue, const struct tri_triangle *tri)
{
    uint32_t waiting = queue->tail - queue->head, n = waiting < TRI_BATCH ? waiting : TRI_BATCH;
    int32_t kept = 0;
    for (uint32_t i = 0; i < n; i++) {
        struct tri_entry entry = queue->window[queue->head++ & MASK];
        queue->batch[kept] = entry;
        kept += tri[entry.t].life == entry.life;
    }
    queue->next = 0;
    queue->n_batch = kept;
}

bool tri_bad_queue_pop(struct tri_bad_queue *queue, const struct tri_mesh *mesh, struct tri_entry *entry)
{
    if (tri_bad_queue_pop_angle(queue, TRI_BUCKETS, mesh, entry))
        return true;
    while (queue->next == queue->n_batch) {
        if (queue->head == queue->tail && queue->n_cold > 0)
            refill(queue);
        if (queue->head == queue->tail)
            return false;
        take_batch(queue, mesh->tri);
    }
    *entry = queue->batch[queue->next++];
    return true;
}

int tri_bad_queue_median(const struct tri_bad_queue *queue)
{
    int64_t all = 0, below = 0;
    int bucket = TRI_URGENT_BUCKET + 1; /* ends at the latest with the last entry */
    for (int b = bucket; b < TRI_BUCKETS; b++)
        all += queue->count[b];
    while (all > 0 && 2 * (below += queue->count[bucket]) < all)
        bucket++;
    return bucket;
}
