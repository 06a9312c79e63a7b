/* What launchers (mpirun, srun) tell their tasks by the environment. */
#ifndef DRIVERS_TASKS_H
#define DRIVERS_TASKS_H

/* How many tasks have been started, of which this is number *task, from 0; without a launcher 1. */
int tasks_started(int *task);

/* One of several tasks does not let threads spin where they wait: cores may have other tasks to run, which would wait
 * for those that spin. OpenMP's library takes that from the environment when it is loaded, before main(): so the
 * program starts itself anew, once, as the same process, unless the caller has told how to wait. To be called before
 * anything else; argv: that of main(). Costs a millisecond. Returns where there is nothing to do, or no way. */
void tasks_wait_idly(char **argv);

#endif
