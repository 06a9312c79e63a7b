/* Vertices that refinement has placed move to where the triangles around them are best. */
#ifndef TRIANGLE_REFINE_SMOOTH_H
#define TRIANGLE_REFINE_SMOOTH_H

#include "triangle/base/executor.h"
#include "triangle/refine/star.h"
#include "triangle/size/quality.h"

/* Does a run end with smoothing? Bounds on areas, the caller's test, -D and -S hold for vertices where they are. */
bool tri_wants_smoothing(const struct tri_quality *quality);

/* The mesh and the bounds are borrowed. TRI_NO_MEMORY. O(triangles). */
enum tri_status tri_smooth_new(struct tri_smooth **smooth, struct tri_mesh *mesh, const struct tri_quality *quality,
                               struct tri_error *error);
void tri_smooth_free(struct tri_smooth *smooth);

/* What became of the vertices of a call. */
struct tri_smooth_count {
    int32_t left;  /* with a rim vertex of another block */
    int32_t moved;
};

enum tri_smooth_pass {
    TRI_SMOOTH_MOVE, /* moves vertices to better places */
    TRI_SMOOTH_FLIP  /* flips edges to bring degrees near six (degrees.h) */
};

/* Do flips by degree come before this pass of moves (0, 1, ..)? */
bool tri_flips_degrees(const struct tri_quality *quality, int pass);

/* Treats these n vertices, in their order, and flips edges around them until they are Delaunay. vertex[] then begins
 * with those that are left. A call changes only vertices, and flips only edges between vertices, whose home is this
 * block: so calls for different blocks may run at the same time. Without homes there is one block. TRI_NO_MEMORY,
 * TRI_STOPPED: the mesh is valid. */
enum tri_status tri_smooth_some(struct tri_smooth *smooth, enum tri_smooth_pass pass, tri_vertex_id *vertex, int32_t n,
                                int32_t block, struct tri_smooth_count *count,
                                struct tri_error *error);

/* The last step: every edge is Delaunay again, also where two blocks met. */
enum tri_status tri_smooth_end(struct tri_smooth *smooth, const struct tri_executor *executor, struct tri_error *error);

/* May the vertex move at all? */
static inline bool tri_is_movable(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->on[v] == TRI_VERTEX_FREE;
}

/* All vertices of a mesh, quality->passes times, or until none moves. */
enum tri_status tri_smooth_all(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_error *error);

#endif
