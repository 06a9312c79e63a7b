/* How many threads there can be. */
#ifndef SCHED_THREADS_H
#define SCHED_THREADS_H

#include <stdbool.h>

enum { PAR_MOST_THREADS = 1024 };

/* As many as asked for (<= 0: what OpenMP would use: OMP_NUM_THREADS, else all cores), but no more than
 * PAR_MOST_THREADS. In a child that was forked after the first call: 1. */
int par_threads_wanted(int asked);

/* The same, but no more than the system gives: OpenMP's library ends the program where it is refused a thread. Limits
 * on processes and on address space are found by trying, if more threads are asked for than there are processors, or
 * `wary`; 20 microseconds a thread. What is left after that, and is not found, is memory that runs out later, while
 * that library makes its threads; it then prints a line and calls exit(1). */
int par_threads(int asked, bool wary);

#endif
