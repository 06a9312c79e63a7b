/* Arrays of one tile. */
#include "sched/tiles/tile_copy.h"

#include <stdlib.h>
#include <string.h>

/* The next array of so many items in the block. */
static void *array(char **at, int32_t n, size_t item)
{
    void *here = *at;
    *at += (size_t)n * item;
    return here;
}

/* Wide numbers first, so that all are aligned. */
bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t n_vertices,
                           int32_t n_triangles, int32_t n_segments)
{
    const size_t a = (size_t)mesh->n_attributes * sizeof *copy->attributes;
    const size_t v = sizeof *copy->points + a + sizeof(int32_t);
    const size_t t = sizeof *copy->corners + sizeof(int32_t), s = sizeof *copy->ends + sizeof(int32_t);
    const size_t size = (size_t)n_vertices * v + (size_t)n_triangles * t + (size_t)n_segments * s;
    if (!copy->block || size > copy->size) {
        free(copy->block);
        copy->size = size + size / 16; /* the next tile is about as large */
        copy->block = malloc(copy->size + 1);
    }
    if (!copy->block)
        return false;
    char *at = copy->block;
    copy->points = array(&at, n_vertices, sizeof *copy->points);
    copy->attributes = array(&at, n_vertices, a);
    copy->corners = array(&at, n_triangles, sizeof *copy->corners);
    copy->ends = array(&at, n_segments, sizeof *copy->ends);
    copy->point_markers = array(&at, n_vertices, sizeof *copy->point_markers);
    copy->regions = array(&at, n_triangles, sizeof *copy->regions);
    copy->segment_markers = array(&at, n_segments, sizeof *copy->segment_markers);
    return true;
}

void par_tile_copy_free(struct par_tile_copy *copy)
{
    free(copy->block);
    *copy = (struct par_tile_copy){0};
}

void par_tile_copy_vertex(const struct par_tile_copy *copy, const struct tri_mesh *mesh, tri_vertex_id v, int32_t to)
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
