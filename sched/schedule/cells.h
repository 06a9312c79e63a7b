/* How large cells are. */
#ifndef SCHED_SCHEDULE_CELLS_H
#define SCHED_SCHEDULE_CELLS_H

/* Final triangles of a cell, where a mesh ends with about so many: one in 128, within limits. Small cells keep many
 * threads busy, large ones make fewer seams. (docs/performance.md) */
static inline double par_triangles_in_cell(double triangles)
{
    const double cells = 128, smallest = 8192, largest = 65536, share = triangles / cells;
    return share < smallest ? smallest : share > largest ? largest : share;
}

#endif
