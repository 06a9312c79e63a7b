/* What launchers (mpirun, srun) tell their tasks by the environment. */
#ifndef DRIVERS_TASKS_H
#define DRIVERS_TASKS_H

/* How many tasks have been started, of which this is number *task, from 0; without a launcher 1. */
int tasks_started(int *task);

#endif
