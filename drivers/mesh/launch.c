/* One of several tasks: whose words are heard, and how they part. */
#include "drivers/mesh/launch.h"

#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>
#include <unistd.h>

#include "drivers/interrupt.h"
#include "drivers/tasks.h"

static void fall_silent(void)
{
    if (!freopen("/dev/null", "w", stdout) || !freopen("/dev/null", "w", stderr))
        _Exit(EXIT_FAILURE);
}

enum tri_status launch_join(struct launch *launch, struct tri_error *error)
{
    int task, tasks = tasks_started(&task);
    *launch = (struct launch){0};
    if (tasks == 1)
        return TRI_OK;
    launch->voice = fcntl(STDERR_FILENO, F_DUPFD_CLOEXEC, STDERR_FILENO + 1); /* a closed one stays closed */
    if (task != 0)
        fall_silent();
    enum tri_status status = launch_ranks(launch, tasks, error);
    if (!status && task == 0 && launch->rank != 0) /* a launcher counts as it likes */
        fall_silent();
    return status;
}

/* Who has failed says so to all. */
static int agree_on_failure(struct launch *launch, int code, struct tri_error *error)
{
    if (code != EXIT_SUCCESS && !error->status)
        tri_fail(error, TRI_INTERNAL, NULL, 0, "task %d has failed", launch->rank);
    enum tri_status agreed = par_agree(launch->carrier, code == EXIT_SUCCESS ? TRI_OK : error->status, error);
    return code == EXIT_SUCCESS && agreed ? EXIT_FAILURE : code;
}

/* Every task comes here, whatever the tasks have agreed on before, so all can be asked once more. */
int launch_agree(struct launch *launch, int code, struct tri_error *error)
{
    enum { FIRST_STOP = 124 };
    struct par_carrier *carrier = launch->carrier;
    if (!carrier)
        return code;
    code = agree_on_failure(launch, code, error);
    const int64_t mine = code;
    bool told = !carrier->lost && carrier->gather(carrier->self, &mine, 1, carrier->of_each);
    for (int p = 0; told && p < carrier->n_ranks; p++)
        if (carrier->of_each[p] >= FIRST_STOP)
            return (int)carrier->of_each[p];
    return code;
}

/* Sleeps so many tenths of a second. False: a signal has come before the time is over. */
static bool pause_for(int tenths)
{
    const struct timespec time = {tenths / 10, tenths % 10 * 100000000L};
    return nanosleep(&time, NULL) == 0;
}

/* When this task aborts, the launcher kills the others, and task 0 may say nothing, or only that it was asked to end.
 * If task 0 has met the same loss, it has told of it: this task waits until task 0 has ended all. Likewise every task
 * waits for the tasks with lower numbers, up to LAST of them, and whoever is ended meanwhile is silent. After its line
 * a task waits for the launcher to pass the line on: the launcher of MPICH drops words that it has not read when a task
 * ends. */
static void tell_loss(const struct launch *launch, bool told)
{
    enum { ENDING = 10, EACH = 20, LAST = 5, READING = 5 };
    const int before = (launch->rank < LAST ? launch->rank : LAST) - 1;
    if (launch->rank > 0 ? pause_for(ENDING + EACH * before) : !told)
        dprintf(launch->voice, "ptriangle: task %d cannot reach the others\n", launch->rank);
    (void)pause_for(READING);
}

int launch_leave(struct launch *launch, int code, struct tri_error *error)
{
    if (!launch->carrier)
        return code;
    const bool told = code != EXIT_SUCCESS;
    interrupt_told(); /* a task that has left with a failure makes the launcher end those that are still about to */
    code = agree_on_failure(launch, code, error);
    if (launch->carrier->lost)
        tell_loss(launch, told);
    launch_end(launch);
    return code;
}
