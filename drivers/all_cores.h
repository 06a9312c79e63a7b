/* An executor of as many tasks at a time as OpenMP has threads; without it one after another. */
#ifndef DRIVERS_ALL_CORES_H
#define DRIVERS_ALL_CORES_H

#include "triangle/executor.h"

extern const struct tri_executor all_cores;

#endif
