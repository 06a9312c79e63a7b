/* What is counted while a schedule runs. */
#include <stdlib.h>

#include "sched/schedule/phase.h"

void par_report_free(struct par_report *report)
{
    par_partition_free(&report->partition);
    free(report->blocks);
    report->blocks = NULL;
    report->n_blocks = report->block_capacity = 0;
}

int32_t par_block_of(const struct par_report *report, const struct tri_mesh *mesh, tri_triangle_id t, int *phase)
{
    for (*phase = 0; report->partition.x && *phase < PAR_PHASES; ++*phase) {
        int32_t block = par_owner_of(&report->partition, *phase, mesh, t);
        if (block != TRI_NONE)
            return block;
    }
    *phase = -1;
    return TRI_NONE;
}

void par_add_points(struct tri_refine_report *sum, const struct tri_refine_report *add)
{
    sum->inserted_free += add->inserted_free;
    sum->inserted_on_segments += add->inserted_on_segments;
}

void par_add_up(struct tri_refine_report *sum, const struct tri_refine_report *add)
{
    par_add_points(sum, add);
    sum->gated += add->gated;
    sum->fenced += add->fenced;
    for (int k = 0; k < TRI_EXCUSES; k++)
        sum->given_up[k] += add->given_up[k];
    sum->hit_limit |= add->hit_limit;
}

void par_forget_deferred(struct par_report *report) { report->total.gated = report->total.fenced = 0; }
