/* Heads tell how much follows; they are read to be checked, too. */
#include "sched/checkpoint/carry_halt.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"

static enum tri_status no_memory(struct tri_error *error)
{
    return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for the state of a checkpoint");
}

static void carry_arrays(struct par_state_file *f, const struct tri_pause *pause)
{
    struct tri_pause_array array[TRI_PAUSE_ARRAYS];
    tri_pause_arrays(pause, array);
    for (int k = 0; k < TRI_PAUSE_ARRAYS; k++)
        par_carry(f, array[k].at, array[k].bytes);
}

/* The head with arrays of its own. */
static enum tri_status receive(struct tri_pause **pause, const struct tri_pause *head, struct tri_error *error)
{
    *pause = malloc(sizeof **pause);
    if (!*pause)
        return no_memory(error);
    **pause = *head;
    if (tri_pause_reserve(*pause))
        return TRI_OK;
    free(*pause);
    *pause = NULL;
    return no_memory(error);
}

enum tri_status par_carry_pause(struct par_state_file *f, struct tri_pause **pause,
                                const struct par_carried_counts *counts, int64_t n_listed, struct tri_error *error)
{
    struct tri_pause head;
    enum tri_status status = TRI_OK;
    if (f->way == PAR_WRITE)
        tri_pause_head(*pause, &head);
    par_carry_head(f, &head, sizeof head);
    f->failed = f->failed || !tri_pause_is_head(&head, counts->triangles, counts->subs, n_listed);
    if (!f->failed && f->way == PAR_READ)
        status = receive(pause, &head, error);
    if (!f->failed && !status)
        carry_arrays(f, f->way == PAR_CHECK ? &head : *pause);
    return status;
}

/* Of one block. */
struct block_head {
    int64_t block, n_worklist, expected, pauses, progress, paused, n_left;
    int64_t n_ranges[PAR_KINDS], current[PAR_KINDS];
    double on_segments, seconds;
    struct tri_refine_report report;
};

static struct block_head head_of(const struct par_halted *b)
{
    struct block_head h = {.block = b->block, .n_worklist = b->n_worklist, .expected = b->expected,
                           .pauses = b->pauses, .progress = b->progress, .paused = b->pause != NULL,
                           .n_left = b->left.n, .on_segments = b->room.on_segments, .seconds = b->seconds,
                           .report = b->report};
    for (int k = 0; k < PAR_KINDS; k++) {
        h.n_ranges[k] = b->room.ranges[k].n;
        h.current[k] = b->room.current[k];
    }
    return h;
}

static bool is_count(int64_t n) { return n >= 0 && n <= INT32_MAX; }

static bool is_head(const struct block_head *h, const struct par_carried_counts *counts)
{
    bool is = h->block >= 0 && h->block < counts->blocks && h->n_worklist > 0 && is_count(h->n_worklist) &&
              is_count(h->expected) && is_count(h->pauses) && is_count(h->n_left) && h->progress >= PAR_READY &&
              h->progress <= PAR_ENDED && (!h->paused || h->progress == PAR_READY || h->progress == PAR_FULL);
    for (int k = 0; k < PAR_KINDS; k++)
        is = is && is_count(h->n_ranges[k]) && h->current[k] >= 0 && h->current[k] <= h->n_ranges[k];
    return is;
}

/* The block as its head tells of it, with room for what follows. What it has it has from here on. */
static bool set_block(struct par_halted *b, const struct block_head *h, struct par_room *spare)
{
    *b = (struct par_halted){.block = (int32_t)h->block, .n_worklist = (int32_t)h->n_worklist,
                             .expected = (int32_t)h->expected, .pauses = (int32_t)h->pauses,
                             .progress = (enum par_progress)h->progress, .seconds = h->seconds, .report = h->report,
                             .room = {.on_segments = h->on_segments}};
    bool memory = tri_grow(&b->left.item, &b->left.capacity, (int32_t)h->n_left, sizeof *b->left.item);
    b->left.n = memory ? (int32_t)h->n_left : 0;
    for (int k = 0; memory && k < PAR_KINDS; k++) {
        struct par_ranges *own = &b->room.ranges[k], *from = &spare->ranges[k];
        const int32_t n = (int32_t)h->n_ranges[k];
        b->room.current[k] = (int32_t)h->current[k];
        memory = n <= INT32_MAX - from->n - from->dealt && par_ranges_reserve(own, n) &&
                 par_ranges_reserve(from, from->n + from->dealt + n);
        own->n = memory ? n : 0;
        from->dealt += own->n;
    }
    return memory;
}

static enum tri_status carry_block(struct par_state_file *f, struct par_halted *b, struct par_room *spare,
                                   const struct par_carried_counts *counts, int64_t *n_worklist,
                                   struct tri_error *error)
{
    struct block_head h = {0};
    if (f->way == PAR_WRITE)
        h = head_of(b);
    par_carry_head(f, &h, sizeof h);
    f->failed = f->failed || !is_head(&h, counts);
    if (f->failed)
        return TRI_OK;
    *n_worklist += h.n_worklist;
    struct par_halted none = {0}, *to = f->way == PAR_CHECK ? &none : b;
    if (f->way == PAR_READ && !set_block(b, &h, spare))
        return no_memory(error);
    par_carry(f, to->left.item, (size_t)h.n_left * sizeof *to->left.item);
    for (int k = 0; k < PAR_KINDS; k++)
        par_carry(f, to->room.ranges[k].item, (size_t)h.n_ranges[k] * sizeof *to->room.ranges[k].item);
    return h.paused ? par_carry_pause(f, &to->pause, counts, h.n_worklist, error) : TRI_OK;
}

/* *n_worklist: of all blocks. */
static enum tri_status carry_blocks(struct par_state_file *f, struct par_halt *halt, struct par_room *spare,
                                    const struct par_carried_counts *counts, int64_t n_blocks, int64_t *n_worklist,
                                    struct tri_error *error)
{
    enum tri_status status = TRI_OK;
    for (int64_t i = 0; !status && !f->failed && i < n_blocks; i++) {
        status = carry_block(f, f->way == PAR_CHECK ? NULL : &halt->block[i], spare, counts, n_worklist, error);
        if (f->way == PAR_READ)
            halt->n_blocks++;
    }
    f->failed = f->failed || !is_count(*n_worklist);
    return status;
}

enum tri_status par_carry_halt(struct par_state_file *f, struct par_halt *halt, struct par_room *spare,
                               const struct par_carried_counts *counts, int64_t n_blocks, struct tri_error *error)
{
    int64_t n_worklist = 0;
    assert(f->way != PAR_READ || halt->n_blocks == 0);
    if (f->way == PAR_READ) {
        halt->block = calloc((size_t)n_blocks + 1, sizeof *halt->block);
        if (!halt->block)
            return no_memory(error);
    }
    enum tri_status status = carry_blocks(f, halt, spare, counts, n_blocks, &n_worklist, error);
    if (status || f->failed)
        return status;
    if (f->way == PAR_READ) {
        halt->worklist = malloc(((size_t)n_worklist + 1) * sizeof *halt->worklist);
        halt->n_worklist = (int32_t)n_worklist;
        if (!halt->worklist)
            return no_memory(error);
    }
    par_carry(f, halt->worklist, (size_t)n_worklist * sizeof *halt->worklist);
    return TRI_OK;
}
