#include "drivers/mesh/orphans.h"

#include <stdlib.h>
#include <string.h>

static int64_t renamed(const struct orphans *o, int64_t i) { return i < o->n_before ? o->kept[i] : i - o->n; }

bool orphans_have(const struct orphans *o, int64_t i) { return renamed(o, i) == renamed(o, i + 1); }

static const int64_t *rename_all(const struct orphans *o, const int64_t *from, int64_t *to, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = renamed(o, from[i]);
    return to;
}

bool orphans_leave_out(const struct orphans *o, const struct tri_tile *all, int32_t n_attributes,
                       struct tri_tile *tile, void **room)
{
    const size_t v = (size_t)all->n_vertices, n_corners = 3 * (size_t)all->n_triangles,
                 n_ends = 2 * (size_t)all->n_segments, width = (size_t)n_attributes;
    *tile = *all;
    *room = o->n > 0 ? malloc((n_corners + n_ends + v * (3 + width) + 1) * sizeof(int64_t)) : NULL;
    if (o->n == 0 || !*room)
        return o->n == 0;
    int64_t *corners = *room, *ends = corners + n_corners;
    double(*points)[2] = (double(*)[2])(ends + n_ends), *attributes = points[v];
    int32_t *markers = (int32_t *)(attributes + v * width);
    tile->corners = (const int64_t(*)[3])rename_all(o, (const int64_t *)all->corners, corners, n_corners);
    tile->ends = (const int64_t(*)[2])rename_all(o, (const int64_t *)all->ends, ends, n_ends);
    tile->first_vertex = renamed(o, all->first_vertex);
    tile->n_vertices = 0;
    for (size_t i = 0; i < v; i++) {
        if (orphans_have(o, all->first_vertex + (int64_t)i))
            continue;
        const size_t to = (size_t)tile->n_vertices++;
        memcpy(points[to], all->points[i], sizeof *points);
        markers[to] = all->point_markers[i];
        for (size_t k = 0; k < width; k++)
            attributes[to * width + k] = all->attributes[i * width + k];
    }
    tile->points = (const double(*)[2])points;
    tile->point_markers = markers;
    tile->attributes = attributes;
    return true;
}
