/* One smoothing pass moves each vertex to the point that minimises the sum of 1 / q over its triangles, and flips
 * edges until they are Delaunay. star.h defines the quality q and derives the point. From the second pass on, flips
 * that improve the degrees of vertices come first (degrees.h).
 *
 * INVARIANT. Input vertices and vertices on segments do not move. A move is made only if all triangles keep their
 * orientation (tested exactly), none violates the angle bound, the sum decreases, and the smallest q does not
 * decrease or stays good. Delaunay flips increase the smallest angle of two triangles (Lawson 1977), so angle bounds
 * stay satisfied. */
#include "triangle/refine/smooth.h"

#include <assert.h>
#include <stdlib.h>

#include "triangle/base/grow.h"
#include "triangle/cdt/flip.h"
#include "triangle/refine/degrees.h"
#include "triangle/tunables.h"

bool tri_wants_smoothing(const struct tri_quality *quality)
{
    return quality->passes > 0 && quality->max_area <= 0 && !quality->region_areas && !quality->unsuitable &&
           !quality->conforming && quality->max_steiner < 0;
}

static void find_corners(struct tri_smooth *r)
{
    const struct tri_mesh *mesh = r->mesh;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        r->corner[v] = TRI_NONE;
    for (tri_triangle_id t = 0; t < mesh->n_triangles; t++)
        for (int k = 0; k < 3 && tri_is_live(&mesh->tri[t]); k++)
            r->corner[mesh->tri[t].v[k]] = t;
}

enum tri_status tri_smooth_new(struct tri_smooth **smooth, struct tri_mesh *mesh, const struct tri_quality *quality,
                              struct tri_error *error)
{
    struct tri_smooth *r = malloc(sizeof *r);
    const size_t n = (size_t)mesh->n_vertices + 1;
    const bool flips = quality->passes > 1;
    bool room = r != NULL;
    if (room) {
        *r = (struct tri_smooth){mesh, tri_bounds_of(quality, tri_worked_angle(quality)).sin2, NULL,
                                 tri_mesh_extra(mesh, n * sizeof *r->corner),
                                 flips ? tri_mesh_extra(mesh, n * sizeof *r->degree) : NULL,
                                 flips ? tri_mesh_extra(mesh, n * sizeof *r->ideal) : NULL};
        room = r->corner && (!flips || (r->degree && r->ideal && tri_degrees_count(r)));
    }
    *smooth = room ? r : NULL;
    if (!room) {
        tri_smooth_free(r);
        return tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    }
    find_corners(r);
    return TRI_OK;
}

void tri_smooth_free(struct tri_smooth *smooth)
{
    if (smooth) {
        tri_mesh_extra_free(smooth->mesh, smooth->corner);
        tri_mesh_extra_free(smooth->mesh, smooth->degree);
        tri_mesh_extra_free(smooth->mesh, smooth->ideal);
    }
    free(smooth);
}

/* Moves one vertex to a better place and counts the move. Returns false if memory ran out. */
static bool move_vertex(const struct tri_smooth *r, struct tri_flips *flips, tri_vertex_id v,
                        const struct tri_star *star, struct tri_smooth_count *count)
{
    struct tri_point x = r->mesh->xy[v];
    if (!tri_star_find_place(r, star, 0, &x) || !tri_star_is_oriented(star, x))
        return true;
    r->mesh->xy[v] = x;
    count->moved++;
    return tri_star_touch(star, flips) && tri_flip_legalise(flips);
}

enum tri_status tri_smooth_some(struct tri_smooth *r, enum tri_smooth_pass pass, tri_vertex_id *vertex, int32_t n,
                                int32_t block, struct tri_smooth_count *count, struct tri_error *error)
{
    struct tri_flips flips = {.mesh = r->mesh, .corner = r->corner, .degree = r->degree, .ties_stay = true,
                              .home = block < 0 ? NULL : r->home, .block = block};
    enum tri_status status = TRI_OK;
    uint32_t step = 0;
    *count = (struct tri_smooth_count){0};
    for (int32_t i = 0; !status && i < n; i++) {
        const tri_vertex_id v = vertex[i];
        struct tri_star star;
        bool is_here, room = true;
        assert(tri_is_movable(r->mesh, v));
        if (tri_stop_is_due(r->mesh->stop, &step))
            status = tri_fail_stopped(error);
        else if (tri_star_find(r, v, block, &star, &is_here))
            room = pass == TRI_SMOOTH_MOVE ? move_vertex(r, &flips, v, &star, count)
                                           : tri_degrees_improve(r, &flips, v, &star);
        else if (!is_here)
            vertex[count->left++] = v;
        if (!room)
            status = tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for flips");
    }
    tri_flips_free(&flips);
    return status;
}

enum tri_status tri_smooth_end(struct tri_smooth *r, const struct tri_executor *executor, struct tri_error *error)
{
    return tri_flip_to_delaunay(r->mesh, executor, error);
}

int32_t tri_list_movable(const struct tri_mesh *mesh, tri_vertex_id *vertex)
{
    int32_t n = 0;
    for (tri_vertex_id v = 0; v < mesh->n_vertices; v++)
        if (tri_is_movable(mesh, v))
            vertex[n++] = v;
    return n;
}

enum tri_status tri_smooth_all(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_error *error)
{
    struct tri_smooth *r = NULL;
    tri_vertex_id *vertex = malloc(((size_t)mesh->n_vertices + 1) * sizeof *vertex);
    enum tri_status status = vertex ? tri_smooth_new(&r, mesh, quality, error)
                                    : tri_fail(error, TRI_NO_MEMORY, NULL, 0, "out of memory for smoothing");
    struct tri_smooth_count count = {.moved = 1};
    for (int pass = 0; !status && count.moved > 0 && pass < quality->passes; pass++) {
        if (pass > 0)
            status = tri_smooth_some(r, TRI_SMOOTH_FLIP, vertex, tri_list_movable(mesh, vertex), -1, &count, error);
        if (!status)
            status = tri_smooth_some(r, TRI_SMOOTH_MOVE, vertex, tri_list_movable(mesh, vertex), -1, &count, error);
    }
    status = status ? status : tri_smooth_end(r, NULL, error);
    tri_smooth_free(r);
    free(vertex);
    return status;
}
