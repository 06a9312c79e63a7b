/* What launchers (mpirun, srun) tell their tasks by the environment. */
#ifndef DRIVERS_TASKS_H
#define DRIVERS_TASKS_H

#include <stdbool.h>

/* How many tasks have been started, of which this is number *task, from 0; without a launcher 1. */
int tasks_started(int *task);

/* So many processors are there, and so many threads run or wait for one (first word behind the averages of
 * /proc/loadavg, this one among them): does every second processor have other work? False: not known. */
bool tasks_is_busy(const char *loadavg, long processors);

/* One of several tasks, and a process on a busy machine, does not let threads spin where they wait: cores have others
 * to run, which would wait for those that spin. OpenMP's library takes that from the environment when it is loaded,
 * before main(): so the program starts itself anew, once, as the same process, unless the caller has told how to wait.
 * To be called before anything else; argv: that of main(). Costs a millisecond, and some microseconds where there is
 * nothing to do. Returns there, and where there is no way. */
void tasks_wait_idly(char **argv);

#endif
