/* Arrays of one tile. */
#include "sched/tiles/tile_copy.h"

#include <stdlib.h>
#include <string.h>

static void *array(int32_t n, size_t item) { return malloc((size_t)n * item + 1); }

static bool has_room(const struct par_tile_copy *copy, const int32_t n[3])
{
    return copy->points && n[0] <= copy->room[0] && n[1] <= copy->room[1] && n[2] <= copy->room[2];
}

/* A little more than is asked for, since the next tile is about as large. */
static int32_t more(int32_t n, int32_t room) { return n > room ? n + n / 16 : room; }

bool par_tile_copy_reserve(struct par_tile_copy *copy, const struct tri_mesh *mesh, int32_t n_vertices,
                           int32_t n_triangles, int32_t n_segments)
{
    const int32_t n[3] = {n_vertices, n_triangles, n_segments};
    if (has_room(copy, n))
        return true;
    const int32_t v = more(n[0], copy->room[0]), t = more(n[1], copy->room[1]), s = more(n[2], copy->room[2]);
    par_tile_copy_free(copy);
    *copy = (struct par_tile_copy){
        .points = array(v, sizeof *copy->points),
        .attributes = array(v, (size_t)mesh->n_attributes * sizeof *copy->attributes),
        .point_markers = array(v, sizeof *copy->point_markers),
        .corners = array(t, sizeof *copy->corners),
        .regions = array(t, sizeof *copy->regions),
        .ends = array(s, sizeof *copy->ends),
        .segment_markers = array(s, sizeof *copy->segment_markers),
        .room = {v, t, s},
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
