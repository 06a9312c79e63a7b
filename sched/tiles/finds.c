/* Sorts the ids found by all shares by row, with a counting sort. */
#include "sched/tiles/finds.h"

#include <assert.h>
#include <stdlib.h>
#include <string.h>

#include "sched/schedule/deal.h"
#include "sched/tunables.h"

bool par_finds_begin(struct par_finds *finds, int32_t n_rows)
{
    *finds = (struct par_finds){.n_rows = n_rows};
    finds->count = calloc((size_t)PAR_FIND_SHARES * (size_t)n_rows, sizeof *finds->count);
    finds->start = malloc(((size_t)n_rows + 1) * sizeof *finds->start);
    return finds->count && finds->start;
}

void par_finds_forget(struct par_finds *finds)
{
    const struct par_finds kept = {.n_rows = finds->n_rows, .start = finds->start, .n = finds->n};
    for (int s = 0; s < PAR_FIND_SHARES; s++) {
        free(finds->found[s].item);
        free(finds->notes[s].item);
        free(finds->runs[s].item);
        free(finds->gaps[s].item);
    }
    free(finds->count);
    free(finds->item);
    free(finds->note);
    *finds = kept;
}

void par_finds_free(struct par_finds *finds)
{
    par_finds_forget(finds);
    free(finds->start);
}

/* Copies the ids of one share, and their notes, to their rows. */
static void deal_share(void *context, size_t share)
{
    struct par_finds *finds = context;
    const struct par_runs *runs = &finds->runs[share];
    const int32_t *from = finds->found[share].item, *note = finds->notes[share].item;
    int32_t *at = finds->count + share * (size_t)finds->n_rows;
    assert(!note || finds->notes[share].n == finds->found[share].n);
    for (int32_t i = 0; i < runs->n; i++) {
        const struct par_span span = runs->item[i];
        memcpy(finds->item + at[span.row], from, (size_t)span.n * sizeof *from);
        if (note)
            memcpy(finds->note + at[span.row], note, (size_t)span.n * sizeof *note);
        at[span.row] += span.n;
        from += span.n;
        note += note ? span.n : 0;
    }
    free(finds->notes[share].item);
    finds->notes[share] = (struct par_ids){0};
}

bool par_finds_deal(struct par_finds *finds, const struct tri_executor *executor)
{
    int32_t noted = 0;
    for (size_t share = 0; share < PAR_FIND_SHARES; share++)
        noted += finds->notes[share].n;
    finds->n = par_add_up_counts(finds->count, PAR_FIND_SHARES, finds->n_rows, finds->start);
    finds->item = malloc(((size_t)finds->n + 1) * sizeof *finds->item);
    finds->note = malloc(((size_t)noted + 1) * sizeof *finds->note);
    if (!finds->item || !finds->note)
        return false;
    tri_execute(executor, PAR_FIND_SHARES, deal_share, finds);
    return true;
}

bool par_finds_add_gaps(struct par_finds *finds, size_t share, const struct par_ids *list)
{
    bool memory = true;
    for (int32_t i = 0; memory && i < list->n; i++)
        memory = par_ranges_add(&finds->gaps[share], list->item[i]);
    return memory;
}

bool par_finds_give(const struct par_finds *finds, struct par_ranges *to)
{
    int32_t n = 0;
    for (int s = 0; s < PAR_FIND_SHARES; s++)
        n += finds->gaps[s].n;
    assert(to->dealt == 0);
    if (!par_ranges_reserve(to, n))
        return false;
    to->n = 0;
    for (int is_long = 0; is_long < 2; is_long++) /* the last ranges are dealt first, and long ones are faster */
        for (int s = 0; s < PAR_FIND_SHARES; s++)
            for (int32_t i = 0; i < finds->gaps[s].n; i++) {
                const struct par_range gap = finds->gaps[s].item[i];
                if (is_long == (gap.end - gap.next >= PAR_LEAST_RANGE))
                    to->item[to->n++] = gap;
            }
    return true;
}
