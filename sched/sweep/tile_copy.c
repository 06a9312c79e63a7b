/* Arrays of one tile. */
#include "sched/sweep/tile_copy.h"

#include <stdlib.h>
#include <string.h>

static void *array(int32_t n, size_t item) { return malloc((size_t)n * item + 1); }

bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t n_vertices,
                           int32_t n_triangles, int32_t n_segments)
{
    *copy = (struct par_tile_copy){
        .points = array(n_vertices, sizeof *copy->points),
        .attributes = array(n_vertices, (size_t)mesh->n_attributes * sizeof *copy->attributes),
        .point_markers = array(n_vertices, sizeof *copy->point_markers),
        .corners = array(n_triangles, sizeof *copy->corners),
        .regions = array(n_triangles, sizeof *copy->regions),
        .ends = array(n_segments, sizeof *copy->ends),
        .segment_markers = array(n_segments, sizeof *copy->segment_markers),
    };
    return copy->points && copy->attributes && copy->point_markers && copy->corners && copy->regions && copy->ends &&
           copy->segment_markers;
}

void par_tile_copy_free(struct par_tile_copy *copy)
{
    free(copy->points);
    free(copy->attributes);
    free(copy->point_markers);
    free(copy->corners);
    free(copy->regions);
    free(copy->ends);
    free(copy->segment_markers);
    *copy = (struct par_tile_copy){0};
}

void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t v, int32_t to)
{
    size_t n = (size_t)mesh->n_attributes;
    tri_mesh_place(mesh, v, copy->points[to]);
    copy->point_markers[to] = mesh->vertex_markers[v];
    if (n > 0)
        memcpy(copy->attributes + (size_t)to * n, mesh->attributes + (size_t)v * n, n * sizeof *copy->attributes);
}

void par_tile_copy_show(const struct par_tile_copy *copy, struct tri_tile *tile)
{
    tile->points = (const double(*)[2])copy->points;
    tile->point_markers = copy->point_markers;
    tile->attributes = copy->attributes;
    tile->corners = (const int64_t(*)[3])copy->corners;
    tile->regions = copy->regions;
    tile->ends = (const int64_t(*)[2])copy->ends;
    tile->segment_markers = copy->segment_markers;
}
