/* How work in independent pieces is run: the one thing that this room asks of whoever owns threads.
 *
 * triangle/ knows no threads. What can be done in pieces is cut into numbered tasks and handed to a caller's executor;
 * a NULL executor stands for doing one task after another. No result may depend on the order in which tasks run. */
#ifndef TRIANGLE_EXECUTOR_H
#define TRIANGLE_EXECUTOR_H

#include <stddef.h>

struct tri_executor {
    /* Calls task(context, i) exactly once for every i in [0, n_tasks), in any order and on any threads, and returns
     * when all have returned; what they wrote is then visible to the caller. Tasks do not fail and do not call run. */
    void (*run)(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context);
    void *self;
};

static inline void tri_execute(const struct tri_executor *executor, size_t n_tasks,
                               void (*task)(void *context, size_t index), void *context)
{
    if (executor) {
        executor->run(executor->self, n_tasks, task, context);
        return;
    }
    for (size_t i = 0; i < n_tasks; i++)
        task(context, i);
}

#endif
