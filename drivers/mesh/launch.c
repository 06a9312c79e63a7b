/* One of several tasks: whose words are heard, and how they part. */
#include "drivers/mesh/launch.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "drivers/interrupt.h"
#include "drivers/start.h"
#include "triangle/base/system.h"

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
    launch->voice = tri_standard_error_again();
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

static void say_loss(const struct launch *launch)
{
    char line[80];
    snprintf(line, sizeof line, "ptriangle: task %d cannot reach the others\n", launch->rank);
    (void)tri_write_next(launch->voice, line, strlen(line));
}

/* When this task aborts, the launcher kills the others, and task 0 may say nothing, or only that it was asked to end.
 * If task 0 has met the same loss, it has told of it: this task waits until task 0 has ended all. Likewise every task
 * waits for the tasks with lower numbers, up to LAST of them, and whoever is ended meanwhile is silent. After its line
 * a task waits for the launcher to pass the line on: the launcher of MPICH drops words that it has not read when a task
 * ends. */
static void tell_loss(const struct launch *launch, bool told)
{
    enum { ENDING = 10, EACH = 20, LAST = 5, READING = 5 }; /* tenths of a second, but for LAST */
    const int before = (launch->rank < LAST ? launch->rank : LAST) - 1;
    if (launch->rank > 0 ? tri_pause((ENDING + EACH * before) / 10.0) : !told)
        say_loss(launch);
    (void)tri_pause(READING / 10.0);
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
