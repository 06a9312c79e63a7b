/* What the system tells a program of itself: its own path, and by launchers (mpirun, srun) which of several tasks it
 * is. */
#ifndef DRIVERS_TASKS_H
#define DRIVERS_TASKS_H

#include <stdbool.h>

enum { OWN_PATH = 4096 };

/* The path of the program's executable, by whatever links it was found. False: the system does not tell. */
bool own_path(char path[OWN_PATH]);

/* How many tasks have been started, of which this is number *task, from 0; without a launcher 1. */
int tasks_started(int *task);

/* Does every second processor have other work? loadavg: the text of /proc/loadavg, whose first word behind the averages
 * tells how many threads run or wait for a processor, this one among them. False: not known. */
bool tasks_is_busy(const char *loadavg, long processors);

/* One of several tasks, and a process on a busy machine, does not let waiting threads spin: other threads would wait
 * for the cores on which they spin. OpenMP's library reads from the environment how threads wait when it is loaded,
 * before main(). So the program starts itself anew, once, as the same process, unless the caller has told how to wait.
 * To be called before anything else; argv: that of main(). A new start costs a millisecond. Where none is needed or
 * possible the function returns, after some microseconds. */
void tasks_wait_idly(char **argv);

#endif
