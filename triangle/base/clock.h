/* Seconds, for reports alone: no decision depends on them. */
#ifndef TRIANGLE_BASE_CLOCK_H
#define TRIANGLE_BASE_CLOCK_H

#include <time.h>

static inline double tri_seconds_by(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* On the clock. */
static inline double tri_seconds(void) { return tri_seconds_by(CLOCK_MONOTONIC); }

/* Of processor time that this thread has had: others at work do not count. */
static inline double tri_thread_seconds(void) { return tri_seconds_by(CLOCK_THREAD_CPUTIME_ID); }

#endif
