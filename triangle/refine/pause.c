#include "triangle/refine/pause.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "triangle/base/grow.h"

void tri_pause_arrays(const struct tri_pause *p, struct tri_pause_array array[TRI_PAUSE_ARRAYS])
{
    const struct tri_bad_queue *q = &p->queue;
    array[0] = (struct tri_pause_array){q->block, (size_t)q->n_blocks * sizeof *q->block};
    array[1] = (struct tri_pause_array){q->window, TRI_WINDOW * sizeof *q->window};
    array[2] = (struct tri_pause_array){q->cold, (size_t)q->n_cold * sizeof *q->cold};
    array[3] = (struct tri_pause_array){p->encroached, (size_t)p->n_encroached * sizeof *p->encroached};
}

static void forget_arrays(struct tri_pause *p)
{
    p->queue.block = NULL;
    p->queue.window = p->queue.cold = NULL;
    p->encroached = NULL;
    p->queue.block_capacity = p->encroached_capacity = 0;
    p->queue.cold_capacity = 0;
}

void tri_pause_head(const struct tri_pause *pause, struct tri_pause *head)
{
    memcpy(head, pause, sizeof *head);
    forget_arrays(head);
}

static bool is_block(const struct tri_bad_queue *q, int32_t block)
{
    return block >= -1 && (block == 0 || block < q->n_blocks);
}

static bool is_bucket(const struct tri_bad_queue *q, const struct tri_bucket *b)
{
    return is_block(q, b->first) && is_block(q, b->last) && b->begin >= 0 && b->begin < TRI_BLOCK && b->end >= 0 &&
           b->end <= TRI_BLOCK && b->count >= 0 && b->count <= (int64_t)TRI_BLOCK * q->n_blocks;
}

static bool is_queue(const struct tri_bad_queue *q)
{
    bool is = q->n_blocks >= 0 && is_block(q, q->free_block) && q->tail - q->head <= TRI_WINDOW && q->n_cold >= 0 &&
              q->n_cold <= INT32_MAX && q->next >= 0 && q->next <= q->n_batch && q->n_batch <= TRI_BATCH;
    for (int b = 0; is && b < TRI_BUCKETS; b++)
        is = is_bucket(q, &q->bucket[b]);
    return is;
}

bool tri_pause_is_head(const struct tri_pause *h, int64_t n_triangles, int64_t n_subs, int64_t n_worklist)
{
    const bool is_place = h->stage >= 0 && h->stage <= TRI_PAUSE_LAST_STAGE && h->step >= 0 &&
                          h->step <= TRI_PAUSE_LAST_STEP && h->limit >= 0 && h->limit <= TRI_BUCKETS;
    return is_place && is_queue(&h->queue) &&
           h->n_worklist <= n_worklist && h->next_listed >= 0 && h->next_listed <= h->n_worklist &&
           h->n_encroached >= 0 &&
           (!h->in_hand || (h->hand.t >= 0 && h->hand.t < n_triangles)) && (h->n_encroached == 0 || n_subs > 0) &&
           h->report.inserted_free >= 0 && h->report.inserted_on_segments >= 0;
}

bool tri_pause_reserve(struct tri_pause *h)
{
    struct tri_bad_queue *q = &h->queue;
    forget_arrays(h);
    q->window = malloc(TRI_WINDOW * sizeof *q->window);
    if (q->window && tri_grow(&q->block, &q->block_capacity, q->n_blocks, sizeof *q->block) &&
        tri_grow_far(&q->cold, &q->cold_capacity, q->n_cold, sizeof *q->cold) &&
        tri_grow(&h->encroached, &h->encroached_capacity, h->n_encroached, sizeof *h->encroached))
        return true;
    tri_pause_free(h);
    return false;
}

void tri_pause_free(struct tri_pause *p)
{
    tri_bad_queue_free(&p->queue);
    free(p->encroached);
    p->encroached = NULL;
    p->n_encroached = p->encroached_capacity = 0;
}

void tri_pause_drop(struct tri_pause **pause)
{
    if (*pause)
        tri_pause_free(*pause);
    free(*pause);
    *pause = NULL;
}
