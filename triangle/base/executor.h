/* The interface for running independent pieces of work, on threads that the caller owns.
 *
 * triangle/ starts no threads. Work that can be divided is cut into numbered tasks and passed to the caller's executor.
 * A NULL executor runs one task after another. No result may depend on the order in which tasks run. */
#ifndef TRIANGLE_BASE_EXECUTOR_H
#define TRIANGLE_BASE_EXECUTOR_H

#include <stddef.h>
#include <stdint.h>

struct tri_executor {
    /* Calls task(context, i) exactly once for every i in [0, n_tasks), in any order and on any threads. Returns when
     * all tasks have returned; their writes are then visible to the caller. Tasks do not fail and do not call run. */
    void (*run)(void *self, size_t n_tasks, void (*task)(void *context, size_t index), void *context);
    void *self; /* first argument of run */
};

static inline void tri_execute(const struct tri_executor *executor, size_t n_tasks,
                               void (*task)(void *context, size_t index), void *context)
{
    if (executor && n_tasks > 1) {
        executor->run(executor->self, n_tasks, task, context);
        return;
    }
    for (size_t i = 0; i < n_tasks; i++)
        task(context, i);
}

/* Work on n items is cut into shares of about TRI_WORTH_A_TASK items, at most TRI_MOST_SHARES. */
enum { TRI_MOST_SHARES = 64, TRI_WORTH_A_TASK = 1 << 15 };

struct tri_range {
    int32_t first, last; /* items first .. last - 1 */
};

static inline size_t tri_shares(int32_t n)
{
    size_t shares = (size_t)n / TRI_WORTH_A_TASK + 1, most = TRI_MOST_SHARES;
    return shares < most ? shares : most;
}

/* The items of share i when n items are cut into `shares` parts whose sizes differ by at most one item. */
static inline struct tri_range tri_share_of(size_t i, size_t shares, int32_t n)
{
    int64_t k = (int64_t)i, of = (int64_t)shares;
    struct tri_range range = {(int32_t)(n * k / of), (int32_t)(n * (k + 1) / of)};
    return range;
}

/* The items of share i, for i < tri_shares(n). */
static inline struct tri_range tri_share(size_t i, int32_t n) { return tri_share_of(i, tri_shares(n), n); }

#endif
