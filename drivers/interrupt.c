/* The handler does nothing but unlink() and raise(), which POSIX allows in handlers.
 *
 * INVARIANT: outside hold .. release, every temporary file there is stands in the set. */
#include "drivers/interrupt.h"

#include <signal.h>
#include <stddef.h>
#include <unistd.h>

static const struct tri_output_set *guarded;
static volatile sig_atomic_t held, waiting;

static void end_by(int number)
{
    for (int i = 0; i < guarded->n; i++)
        if (guarded->outputs[i].temporary)
            unlink(guarded->outputs[i].temporary);
    signal(number, SIG_DFL);
    raise(number);
}

static void handle(int number)
{
    if (held)
        waiting = number;
    else
        end_by(number);
}

static void catch(int number)
{
    struct sigaction action = {.sa_handler = handle}, old;
    sigemptyset(&action.sa_mask);
    if (sigaction(number, NULL, &old) == 0 && old.sa_handler != SIG_IGN)
        sigaction(number, &action, NULL); /* no SA_RESTART: opening a pipe that nobody reads must end */
}

static void guard(const struct tri_output_set *set)
{
    guarded = set;
    catch(SIGINT);
    catch(SIGTERM);
    catch(SIGHUP);
    signal(SIGXFSZ, SIG_IGN);
    signal(SIGPIPE, SIG_IGN);
}

static void hold(void) { held = 1; }

static void release(void)
{
    held = 0;
    if (waiting)
        end_by(waiting);
}

void interrupt_begin(struct tri_output_set *set)
{
    tri_outputs_begin(set);
    guard(set);
}

enum tri_status interrupt_open(struct tri_output_set *set, const char *path, struct tri_output **output,
                               struct tri_error *error)
{
    hold();
    enum tri_status status = tri_output_open(set, path, output, error);
    release();
    return status;
}

enum tri_status interrupt_finish(struct tri_output_set *set, enum tri_status status, struct tri_error *error)
{
    hold();
    if (status)
        tri_outputs_abort(set);
    else
        status = tri_outputs_commit(set, error);
    release();
    return status;
}
