/* A counting sort by column. */
#include "sched/tiles/ahead.h"

#include <assert.h>
#include <stdlib.h>

/* The number of the first odd column that reaches beyond x: column 2 i + 1. */
static int32_t column_beyond(const struct par_partition *p, double x, int32_t n_odd)
{
    int32_t low = 0, high = n_odd - 1; /* the last one reaches to infinity */
    while (low < high) {
        int32_t middle = low + (high - low) / 2;
        if (x < par_fence(p, 2 * middle + 1, 0).x_max)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

static double right_end(const struct tri_mesh *mesh, tri_triangle_id t)
{
    const tri_vertex_id *v = mesh->tri[t].v;
    double a = mesh->xy[v[0]].x, b = mesh->xy[v[1]].x, c = mesh->xy[v[2]].x;
    double most = a > b ? a : b;
    return most > c ? most : c;
}

bool par_ahead_make(struct par_ahead *ahead, const struct par_run *run, const struct par_partition *partition)
{
    const struct par_ids *list = &run->worklist;
    int32_t n_odd = (partition->n_columns - 1) / 2;
    size_t n = (size_t)list->n + 1;
    assert(run->key.n == 0);
    *ahead = (struct par_ahead){malloc(n * sizeof *ahead->item), malloc(n * sizeof *ahead->key),
                                calloc((size_t)n_odd + 2, sizeof *ahead->start), n_odd};
    int32_t *column = malloc(n * sizeof *column), *start = ahead->start;
    bool memory = ahead->item && ahead->key && start && column;
    for (int32_t i = 0; memory && i < list->n; i++) {
        column[i] = column_beyond(partition, right_end(run->mesh, list->item[i]), n_odd);
        start[column[i] + 2]++;
    }
    for (int32_t i = 0; memory && i < n_odd; i++)
        start[i + 2] += start[i + 1];
    for (int32_t i = 0; memory && i < list->n; i++) {
        int32_t at = start[column[i] + 1]++;
        ahead->item[at] = list->item[i];
        ahead->key[at] = (uint64_t)i;
    }
    free(column);
    return memory;
}

void par_ahead_free(struct par_ahead *ahead)
{
    free(ahead->item);
    free(ahead->key);
    free(ahead->start);
    *ahead = (struct par_ahead){0};
}

bool par_ahead_give(const struct par_ahead *ahead, struct par_run *run, int32_t odd)
{
    int32_t i = odd / 2;
    if (i >= ahead->n_odd)
        return true;
    int32_t first = ahead->start[i];
    return par_merge_worklist(run, ahead->item + first, ahead->key + first, ahead->start[i + 1] - first);
}
