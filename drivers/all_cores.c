#include "drivers/all_cores.h"

static void run_tasks(void *self, size_t n, void (*task)(void *context, size_t i), void *context)
{
    (void)self;
#pragma omp parallel for schedule(dynamic)
    for (size_t i = 0; i < n; i++)
        task(context, i);
}

const struct tri_executor all_cores = {run_tasks, NULL};
