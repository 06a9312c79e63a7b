/* The threads of a call: how many there can be, and the team that works on what a call hands out in tasks.
 *
 * A team lives as long as the call that made it, and its threads sleep while there is nothing to do: nothing of it is
 * left behind for a fork, or for other threads that call as well. They are made by OpenMP
 * where the build has it, so that its settings hold (OMP_PROC_BIND, OMP_PLACES, OMP_STACKSIZE), else by the system. */
#ifndef SCHED_SCHEDULE_THREADS_H
#define SCHED_SCHEDULE_THREADS_H

#include <stdbool.h>

#include "triangle/base/executor.h"

enum { PAR_MOST_THREADS = 1024 };

/* How many threads there will be if so many are asked for: at most PAR_MOST_THREADS. <= 0: one, if the caller is in a
 * parallel region of OpenMP or in a task of a team; else OMP_NUM_THREADS, if it is set; else one for each processor of
 * this process. `wary`, or with OpenMP more than there are processors: at most as many as the system gives, which is
 * found by trying, at 20 microseconds a thread. For OpenMP's library ends the program if it is refused a thread: it
 * prints a line and calls exit(1), which can still happen if memory runs out later. */
int par_threads(int asked, bool wary);

/* Is this thread at work on a task? */
bool par_team_works(void);

struct par_team {
    int threads;           /* >= 1, the caller's one among them, as par_threads says */
    struct par_crew *crew; /* the other ones; NULL: not needed yet, or refused: the caller works alone */
};

/* Runs tasks on the threads of the team, which are made when they are first needed; about 20 microseconds each. The
 * executor lives as long as *team, and serves one caller at a time. The one way in which anything in sched/ runs in
 * parallel. */
struct tri_executor par_executor(struct par_team *team);

/* Ends the team's threads and frees all it has. */
void par_team_end(struct par_team *team);

#endif
