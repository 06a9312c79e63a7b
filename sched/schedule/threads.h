/* How many threads there can be, and how they are given work. */
#ifndef SCHED_SCHEDULE_THREADS_H
#define SCHED_SCHEDULE_THREADS_H

#include <stdbool.h>

#include "triangle/base/executor.h"

enum { PAR_MOST_THREADS = 1024 };

/* How many threads there will be where so many are asked for (<= 0: what OpenMP would use: OMP_NUM_THREADS, else all
 * cores): no more than PAR_MOST_THREADS, and no more than the system gives, since OpenMP's library ends the program
 * where it is refused a thread; in a child that was forked after the first call 1. Limits on processes and on address
 * space are found by trying, if more threads are asked for than there are processors, or `wary`; 20 microseconds a
 * thread. What is left after that, and is not found, is memory that runs out later, while that library makes its
 * threads; it then prints a line and calls exit(1). */
int par_threads(int asked, bool wary);

/* An executor that runs tasks on this many threads (<= 0: what OpenMP would use); it lives as long as *threads. The one
 * way in which anything in sched/ runs in parallel. */
struct tri_executor par_executor(int *threads);

#endif
