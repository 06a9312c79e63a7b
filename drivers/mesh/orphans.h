/* Points that no triangle uses, left out of a stream of tiles: a solver's matrix would be singular at them. */
#ifndef DRIVERS_MESH_ORPHANS_H
#define DRIVERS_MESH_ORPHANS_H

#include <stdbool.h>

#include "ptriangle/tiles.h"

struct orphans {
    int64_t n, n_before; /* orphans; points before refinement, which makes no orphans */
    int32_t *kept;       /* [n_before + 1] how many of the points before each are none; malloc'ed */
};

/* Is this point one? */
bool orphans_have(const struct orphans *orphans, int64_t point);

/* The tile without them. Its arrays are those of `all`, or lie in *room, which is to be freed in any case. False: no
 * memory. */
bool orphans_leave_out(const struct orphans *orphans, const struct tri_tile *all, int32_t n_attributes,
                       struct tri_tile *tile, void **room);

#endif
