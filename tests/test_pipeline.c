/* Items may be made in any order. The caller's thread consumes all of them in sequence, each from a slot of its own. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include <cmocka.h>
#include <pthread.h>

#include "sched/tiles/pipeline.h"
#include "sched/schedule/threads.h"
#include "triangle/base/status.h"

enum { N = 500, SLOTS = 5 };

struct trial {
    pthread_t caller;
    int32_t slot[SLOTS]; /* number of the item that each slot holds */
    int32_t n_taken;
    int32_t fails_at; /* number of the item whose making fails; N: none */
    bool in_order, by_caller;
};

static enum tri_status make(void *context, int32_t i, int32_t slot, struct tri_error *error)
{
    struct trial *t = context;
    if (i == t->fails_at)
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "number %d", (int)i);
    for (volatile int32_t k = 0; k < i * 7919 % 5000; k++) /* makes some items slower than others */
        ;
    t->slot[slot] = i;
    return TRI_OK;
}

static enum tri_status take(void *context, int32_t i, int32_t slot, struct tri_error *error)
{
    struct trial *t = context;
    (void)error;
    t->in_order = t->in_order && i == t->n_taken++ && t->slot[slot] == i;
    t->by_caller = t->by_caller && pthread_equal(pthread_self(), t->caller);
    return TRI_OK;
}

static enum tri_status run(struct trial *t, int threads, int32_t n_slots, struct tri_error *error)
{
    struct par_team team = {.threads = threads};
    const struct tri_executor executor = par_executor(&team);
    const struct par_pipeline p = {N, n_slots, threads, make, take, t};
    t->caller = pthread_self();
    t->in_order = t->by_caller = true;
    const enum tri_status status = par_pipeline_run(&p, threads > 1 ? &executor : NULL, error);
    par_team_end(&team);
    return status;
}

static void all_items_are_consumed_in_order(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 4; threads++)
        for (int32_t n_slots = 1; n_slots <= SLOTS; n_slots++) {
            struct trial t = {.fails_at = N};
            assert_int_equal(run(&t, threads, n_slots, NULL), TRI_OK);
            assert_int_equal(t.n_taken, N);
            assert_true(t.in_order && t.by_caller);
        }
}

static void a_failure_ends_the_pipeline(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 3; threads++) {
        struct trial t = {.fails_at = N / 2};
        struct tri_error error = {0};
        assert_int_equal(run(&t, threads, SLOTS, &error), TRI_NO_MEMORY);
        assert_non_null(strstr(error.text, "number 250"));
        assert_true(t.in_order && t.n_taken <= N / 2);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(all_items_are_consumed_in_order),
                                       cmocka_unit_test(a_failure_ends_the_pipeline)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
