/* One table of what a tile is made of. */
#include "sched/tiles/tile_arrays.h"

#include <string.h>

void par_tile_arrays(const struct tri_tile *tile, int32_t n_attributes, struct par_array array[PAR_TILE_ARRAYS])
{
    const size_t v = (size_t)tile->n_vertices, t = (size_t)tile->n_triangles, s = (size_t)tile->n_segments;
    array[0] = (struct par_array){tile->points, v * sizeof *tile->points};
    array[1] = (struct par_array){tile->point_markers, v * sizeof *tile->point_markers};
    array[2] = (struct par_array){tile->attributes, v * (size_t)n_attributes * sizeof *tile->attributes};
    array[PAR_TILE_CORNERS] = (struct par_array){tile->corners, t * sizeof *tile->corners};
    array[4] = (struct par_array){tile->regions, t * sizeof *tile->regions};
    array[PAR_TILE_ENDS] = (struct par_array){tile->ends, s * sizeof *tile->ends};
    array[6] = (struct par_array){tile->segment_markers, s * sizeof *tile->segment_markers};
}

void par_tile_point_at(struct tri_tile *tile, const struct par_array array[PAR_TILE_ARRAYS])
{
    tile->points = (const double(*)[2])array[0].at;
    tile->point_markers = array[1].at;
    tile->attributes = array[2].at;
    tile->corners = (const int64_t(*)[3])array[PAR_TILE_CORNERS].at;
    tile->regions = array[4].at;
    tile->ends = (const int64_t(*)[2])array[PAR_TILE_ENDS].at;
    tile->segment_markers = array[6].at;
}

size_t par_tile_bytes(const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    size_t n = par_padded(sizeof *tile);
    par_tile_arrays(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++)
        n += par_padded(array[k].bytes);
    return n;
}

/* Filled up with zeros. */
static char *append(char *to, const void *bytes, size_t n)
{
    if (n > 0)
        memcpy(to, bytes, n);
    memset(to + n, 0, par_padded(n) - n);
    return to + par_padded(n);
}

void par_tile_pack(char *to, const struct tri_tile *tile, int32_t n_attributes)
{
    struct par_array array[PAR_TILE_ARRAYS];
    par_tile_arrays(tile, n_attributes, array);
    to = append(to, tile, sizeof *tile);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++)
        to = append(to, array[k].at, array[k].bytes);
}

size_t par_tile_unpack(const char *bytes, size_t n, int32_t n_attributes, struct tri_tile *tile)
{
    struct par_array array[PAR_TILE_ARRAYS];
    size_t at = par_padded(sizeof *tile);
    if (n < at)
        return 0;
    memcpy(tile, bytes, sizeof *tile);
    if (tile->n_vertices < 0 || tile->n_triangles < 0 || tile->n_segments < 0)
        return 0;
    par_tile_arrays(tile, n_attributes, array);
    for (int k = 0; k < PAR_TILE_ARRAYS; k++) {
        if (n - at < par_padded(array[k].bytes))
            return 0;
        array[k].at = bytes + at;
        at += par_padded(array[k].bytes);
    }
    par_tile_point_at(tile, array);
    return at;
}
