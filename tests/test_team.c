/* Tasks on a team's threads: each task runs once, even if no threads can be created, and the caller sees the tasks'
   results. */
#include "allocations.h"

#include <limits.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdatomic.h>
#include <stddef.h>
#include <stdlib.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmocka.h>
#ifdef _OPENMP
#include <omp.h>
#endif

#include "sched/schedule/threads.h"
#include "triangle/base/system.h"

enum { MOST = 1000 };

struct counts {
    int of[MOST]; /* [task] number of times it has run; not atomic, so that ThreadSanitizer detects missing ordering */
};

static void count(void *context, size_t index) { ((struct counts *)context)->of[index]++; }

/* Asserts of cmocka may only run on the main thread. */
static bool is_each_run_once(const struct tri_executor *executor, size_t n)
{
    struct counts counts = {{0}};
    bool once = true;
    executor->run(executor->self, n, count, &counts);
    for (size_t i = 0; i < MOST; i++)
        once = once && counts.of[i] == (i < n);
    return once;
}

static bool are_jobs_done(int threads, int n_jobs)
{
    struct par_team team = {.threads = threads};
    const struct tri_executor executor = par_executor(&team);
    bool done = true;
    for (int i = 0; i < n_jobs; i++)
        done = is_each_run_once(&executor, (size_t)i % 7 == 0 ? MOST : (size_t)i % 7) && done;
    par_team_end(&team);
    return done;
}

static void test_each_task_runs_once(void **state)
{
    (void)state;
    for (int threads = 1; threads <= 6; threads++)
        assert_true(are_jobs_done(threads, 2000));
    assert_true(are_jobs_done(PAR_MOST_THREADS, 20));
}

struct meeting {
    atomic_int here;
    int left[3]; /* [task] not atomic */
};

/* All threads run at the same time if the system grants them: each task waits for the others. One ends later. */
static void wait_for_all(void *context, size_t index)
{
    struct meeting *meeting = context;
    atomic_fetch_add(&meeting->here, 1);
    while (atomic_load(&meeting->here) < 3)
        (void)tri_pause(1e-4);
    if (index == 0)
        (void)tri_pause(1e-3);
    meeting->left[index] = 1;
}

static void test_threads_work_side_by_side(void **state)
{
    (void)state;
    struct par_team team = {.threads = 3};
    const struct tri_executor executor = par_executor(&team);
    for (int i = 0; i < 20; i++) {
        struct meeting meeting = {0};
        executor.run(executor.self, 3, wait_for_all, &meeting);
        assert_int_equal(meeting.left[0] + meeting.left[1] + meeting.left[2], 3);
    }
    par_team_end(&team);
}

static void *run_caller(void *done)
{
    *(bool *)done = are_jobs_done(3, 500);
    return NULL;
}

static void test_callers_have_teams_of_their_own(void **state)
{
    (void)state;
    enum { CALLERS = 4 };
    bool done[CALLERS] = {false};
    struct tri_thread *caller[CALLERS];
    for (int i = 0; i < CALLERS; i++)
        assert_non_null(caller[i] = tri_thread_start(run_caller, &done[i]));
    for (int i = 0; i < CALLERS; i++) {
        tri_thread_join(caller[i]);
        assert_true(done[i]);
    }
}

#ifdef __has_feature
#define IS_CHECKED_FOR_RACES __has_feature(thread_sanitizer)
#else
#define IS_CHECKED_FOR_RACES 0
#endif

/* A forked child has no threads of its parent. ThreadSanitizer does not let it create new ones. */
static void test_a_forked_child_makes_its_own(void **state)
{
    (void)state;
    struct par_team team = {.threads = 3};
    const struct tri_executor executor = par_executor(&team);
    int status = -1;
    if (IS_CHECKED_FOR_RACES)
        skip();
    assert_true(is_each_run_once(&executor, MOST));
    const pid_t child = fork();
    assert_true(child >= 0);
    if (child == 0) {
        alarm(60); /* instead of waiting endlessly */
        _exit(are_jobs_done(3, 50) ? 0 : 1);
    }
    assert_int_equal(waitpid(child, &status, 0), child);
    assert_true(WIFEXITED(status) && WEXITSTATUS(status) == 0);
    assert_true(is_each_run_once(&executor, MOST));
    par_team_end(&team);
}

static void test_without_memory_the_caller_works_alone(void **state)
{
    (void)state;
    for (int64_t k = 1; k <= 12; k++) {
        support_calls = 0;
        support_fail_ever_after = k % 2 == 0;
        support_fail_at = k;
        const bool done = are_jobs_done(3, 10);
        support_fail_at = INT64_MAX;
        assert_true(done);
    }
}

static void count_threads(void *context, size_t index) { ((int *)context)[index] = par_threads(0, false); }

static void test_the_number_of_threads_is_predicted(void **state)
{
    (void)state;
    int asked[3] = {0};
    struct par_team team = {.threads = 3};
    const struct tri_executor executor = par_executor(&team);
    executor.run(executor.self, 3, count_threads, asked); /* the team's other threads use the other processors */
    par_team_end(&team);
    for (int i = 0; i < 3; i++)
        assert_int_equal(asked[i], 1);
    assert_false(par_team_works());
    assert_int_equal(par_threads(1, true), 1);
    assert_int_equal(par_threads(3, false), 3);
    assert_in_range(par_threads(INT_MAX, true), 1, PAR_MOST_THREADS);
#ifdef _OPENMP
    omp_set_num_threads(3);
    assert_int_equal(par_threads(0, false), 3);
    int found[2] = {0};
#pragma omp parallel for num_threads(2) schedule(static, 1)
    for (int i = 0; i < 2; i++)
        found[i] = par_threads(0, false);
    assert_int_equal(found[0], 1);
    assert_int_equal(found[1], 1);
#else
    setenv("OMP_NUM_THREADS", "3,2", 1);
    assert_int_equal(par_threads(0, false), 3);
    setenv("OMP_NUM_THREADS", "none", 1);
    assert_int_equal(par_threads(0, false), tri_processors());
    unsetenv("OMP_NUM_THREADS");
#endif
    assert_true(par_threads(-1, false) >= 1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_each_task_runs_once),
        cmocka_unit_test(test_threads_work_side_by_side),
        cmocka_unit_test(test_callers_have_teams_of_their_own),
        cmocka_unit_test(test_a_forked_child_makes_its_own),
        cmocka_unit_test(test_without_memory_the_caller_works_alone),
        cmocka_unit_test(test_the_number_of_threads_is_predicted),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
