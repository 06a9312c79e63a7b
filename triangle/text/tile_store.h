/* Tiles kept in files until all are there, for formats that can only be written then: a sink, and afterwards the whole
 * mesh as a grid, whose rows are read where they lie. In memory are a few megabytes of it at a time.
 *
 * The files have no names: nothing is left of them, however the process ends. They take 20 bytes a point, and 8 for
 * each attribute, 28 a triangle and 20 a segment; and 8 a triangle while those of several regions are grouped; and 10 a
 * triangle, 12 a point and 12 a segment where a mesh is cut into parts. */
#ifndef TRIANGLE_TEXT_TILE_STORE_H
#define TRIANGLE_TEXT_TILE_STORE_H

#include "ptriangle/tiles.h"
#include "triangle/mesh/grid.h"

struct tri_tile_store;

/* The files will be in this folder; borrowed. The sink may be told of the beginning again: then what it has taken is
 * forgotten. TRI_NO_MEMORY; of the sink also TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_new(struct tri_tile_store **store, const char *folder, struct tri_sink *sink,
                                   struct tri_error *error);

/* What has been taken, once the sink was told of the end; as long as the store lives. Without neighbours and edges.
 * Rows may be asked for by any thread, and best in their order. TRI_CANNOT_WRITE. */
enum tri_status tri_tile_store_grid(struct tri_tile_store *store, bool markers, struct tri_grid *grid,
                                    struct tri_error *error);

/* NULL is fine. */
void tri_tile_store_free(struct tri_tile_store *store);

#endif
