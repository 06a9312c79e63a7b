#include "drivers/mesh/orphans.h"

#include <stdlib.h>
#include <string.h>

/* How many of them come before point i. */
static int64_t before(const struct orphans *o, int64_t i)
{
    int64_t low = 0, high = o->n;
    while (low < high) {
        const int64_t middle = low + (high - low) / 2;
        if (o->number[middle] < i)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static void rename_all(const struct orphans *o, const int64_t *from, int64_t *to, size_t n)
{
    for (size_t i = 0; i < n; i++)
        to[i] = from[i] - before(o, from[i]);
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
    int64_t *corners = *room, *ends = corners + n_corners, k = before(o, all->first_vertex);
    double(*points)[2] = (double(*)[2])(ends + n_ends), *attributes = points[v];
    int32_t *markers = (int32_t *)(attributes + v * width);
    rename_all(o, all->corners ? all->corners[0] : NULL, corners, n_corners);
    rename_all(o, all->ends ? all->ends[0] : NULL, ends, n_ends);
    tile->first_vertex -= k;
    tile->n_vertices = 0;
    for (size_t i = 0; i < v; i++) {
        if (k < o->n && o->number[k] == all->first_vertex + (int64_t)i) {
            k++;
            continue;
        }
        const size_t to = (size_t)tile->n_vertices++;
        memcpy(points[to], all->points[i], sizeof *points);
        markers[to] = all->point_markers[i];
        if (width > 0)
            memcpy(attributes + to * width, all->attributes + i * width, width * sizeof *attributes);
    }
    tile->points = (const double(*)[2])points;
    tile->point_markers = markers;
    tile->attributes = attributes;
    tile->corners = (const int64_t(*)[3])corners;
    tile->ends = (const int64_t(*)[2])ends;
    return true;
}
