/* The arrays of a tile as a list, for whoever copies, sends or keeps them and need not know what they are. */
#ifndef SCHED_TILES_TILE_ARRAYS_H
#define SCHED_TILES_TILE_ARRAYS_H

#include <stddef.h>

#include "ptriangle/tiles.h"

enum { PAR_TILE_CORNERS = 3, PAR_TILE_ENDS = 5, PAR_TILE_ARRAYS = 7 }; /* the lists of vertices; all */

struct par_array {
    const void *at;
    size_t bytes;
};

/* In the order of the struct. */
void par_tile_arrays(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS]);

/* Points the tile at them. */
void par_tile_point_at(struct tri_tile *tile, const struct par_array array[PAR_TILE_ARRAYS]);

/* Arrays that lie one behind the other are filled up to eight bytes each, so that all are aligned. */
static inline size_t par_padded(size_t n) { return (n + 7) / 8 * 8; }

/* --- a tile as bytes: its struct, then its arrays */

/* How many. */
size_t par_tile_bytes(const struct tri_tile *tile, int32_t n_attributes);

void par_tile_pack(char *to, const struct tri_tile *tile, int32_t n_attributes);

/* Points *tile at what is packed, of which there are n bytes at most, aligned as malloc does; returns how many it
 * takes, or 0: it is no tile. */
size_t par_tile_unpack(const char *bytes, size_t n, int32_t n_attributes, struct tri_tile *tile);

#endif
