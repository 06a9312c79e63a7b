/* The threads of a call: how many there can be, and the team of threads that runs its tasks.
 *
 * A team exists only during the call that made it, and its threads sleep when there are no tasks. After
 * the call, no remaining thread can disturb a fork or a call on another thread. In builds with OpenMP, its runtime
 * starts the threads, so its settings apply (OMP_PROC_BIND, OMP_PLACES, OMP_STACKSIZE). */
#ifndef SCHED_SCHEDULE_THREADS_H
#define SCHED_SCHEDULE_THREADS_H

#include <stdbool.h>

#include "triangle/base/executor.h"

enum { PAR_MOST_THREADS = 1024 };

/* Returns the number of threads to use if `asked` are requested, at most PAR_MOST_THREADS. asked <= 0: one thread if
 * the caller is in a parallel region of OpenMP or in a task of a team; otherwise OMP_NUM_THREADS, if set; otherwise one
 * for each processor of this process.
 *
 * If `wary` is set, or, with OpenMP, if more threads than processors are requested, the function starts that many
 * threads for a moment, at about 20 microseconds each, and returns at most the number that the system allows. The
 * reason is that the OpenMP runtime ends the program if it cannot start a thread: it prints a line and calls exit(1).
 * That can still happen if memory runs out later. */
int par_threads(int asked, bool wary);

/* Returns whether this thread is running a task of a team. */
bool par_team_works(void);

/* A team: the calling thread and its helper threads. Belongs to the thread that set it up. */
struct par_team {
    int threads;           /* >= 1, including the calling thread, as par_threads returns it */
    struct par_crew *crew; /* the other threads; NULL: not needed yet, or the system refused them, and the caller works
                              alone */
};

/* Returns an executor that runs tasks on the threads of the team. The threads are started when they are first needed,
 * at about 20 microseconds each. The executor lives as long as *team and serves one caller at a time. Everything in
 * sched/ that runs in parallel runs on such an executor. */
struct tri_executor par_executor(struct par_team *team);

/* Ends the team's threads and frees their memory. The team may be used again; it then starts new threads. */
void par_team_end(struct par_team *team);

#endif
