/* An input that one rank has read, on all ranks. */
#ifndef DRIVERS_MESH_SHARED_INPUT_H
#define DRIVERS_MESH_SHARED_INPUT_H

#include "drivers/mesh/stages.h"
#include "sched/ranks/carrier.h"

/* Collective: all that is read into *run by rank 0 (figure, triangles, base) comes to all. status: whether it has read
 * it. TRI_NO_MEMORY. */
enum tri_status shared_input(struct par_carrier *carrier, struct run *run, enum tri_status status,
                             struct tri_error *error);

#endif
