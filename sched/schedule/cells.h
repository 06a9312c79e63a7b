/* How large cells are. */
#ifndef SCHED_SCHEDULE_CELLS_H
#define SCHED_SCHEDULE_CELLS_H

#include "sched/tunables.h"

/* Final triangles of a cell, where a mesh ends with about so many. */
static inline double par_triangles_in_cell(double triangles)
{
    const double share = triangles / PAR_CELLS_WANTED;
    return share < PAR_SMALLEST_CELL ? PAR_SMALLEST_CELL : share > PAR_LARGEST_CELL ? PAR_LARGEST_CELL : share;
}

#endif
