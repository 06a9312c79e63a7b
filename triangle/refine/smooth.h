/* Vertices that refinement has placed move to where the triangles around them are best. */
#ifndef TRIANGLE_REFINE_SMOOTH_H
#define TRIANGLE_REFINE_SMOOTH_H

#include "triangle/base/executor.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

/* Does a run end with smoothing? Bounds on areas, the caller's test, -D and -S hold for vertices where they are. */
bool tri_wants_smoothing(const struct tri_quality *quality);

/* A pass at work. */
struct tri_smooth;

/* The mesh and the bounds are borrowed. TRI_NO_MEMORY. O(triangles). */
enum tri_status tri_smooth_new(struct tri_smooth **smooth, struct tri_mesh *mesh, const struct tri_quality *quality,
                               struct tri_error *error);
void tri_smooth_free(struct tri_smooth *smooth);

/* What became of the vertices of a call. */
struct tri_smooth_count {
    int32_t left;  /* whose triangles do not all lie in the fence */
    int32_t moved;
};

/* Moves these n vertices, in their order, and flips edges around them until they are Delaunay. vertex[] then begins
 * with those that are left. fence NULL: the plane. Calls with disjoint fences may run at the same time
 * (triangle/refine/refine.h, serialisation). TRI_NO_MEMORY, TRI_STOPPED: the mesh is valid. */
enum tri_status tri_smooth_some(struct tri_smooth *smooth, tri_vertex_id *vertex, int32_t n,
                                const struct tri_fence *fence, struct tri_smooth_count *count,
                                struct tri_error *error);

/* The last step: every edge is Delaunay again, also where two fences met. */
enum tri_status tri_smooth_end(struct tri_smooth *smooth, const struct tri_executor *executor, struct tri_error *error);

/* May the vertex move at all? */
static inline bool tri_is_movable(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->on[v] == TRI_VERTEX_FREE;
}

/* All vertices of a mesh, quality->passes times, or until none moves. */
enum tri_status tri_smooth_all(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_error *error);

#endif
