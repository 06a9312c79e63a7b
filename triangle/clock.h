/* Wall-clock seconds, for reports alone: no decision depends on them. */
#ifndef TRIANGLE_CLOCK_H
#define TRIANGLE_CLOCK_H

#include <time.h>

static inline double tri_seconds(void)
{
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

#endif
