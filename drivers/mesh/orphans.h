/* Removes points that no triangle uses from a stream of tiles. With such points the matrix of a solver would be
 * singular. */
#ifndef DRIVERS_MESH_ORPHANS_H
#define DRIVERS_MESH_ORPHANS_H

#include <stdbool.h>

#include "ptriangle/tiles.h"

struct orphans {
    int64_t n, n_before; /* number of orphans; number of points before refinement, which makes no orphans */
    int32_t *kept;       /* [n_before + 1] number of points before each point that are no orphans; malloc'ed */
};

/* Returns true if this point is an orphan. */
bool orphans_have(const struct orphans *orphans, int64_t point);

/* Returns the tile without orphans. Its arrays are those of `all`, or lie in *room, which the caller frees in any case.
 * False: no memory. */
bool orphans_leave_out(const struct orphans *orphans, const struct tri_tile *all, int32_t n_attributes,
                       struct tri_tile *tile, void **room);

#endif
