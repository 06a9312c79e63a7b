/* Wall-clock seconds, for reports alone: no decision depends on them. */
#ifndef SCHED_CLOCK_H
#define SCHED_CLOCK_H

#include <time.h>

static inline double par_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
