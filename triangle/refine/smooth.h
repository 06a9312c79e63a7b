/* Smoothing: moves vertices that refinement has inserted, to improve the triangles around them. */
#ifndef TRIANGLE_REFINE_SMOOTH_H
#define TRIANGLE_REFINE_SMOOTH_H

#include "triangle/base/executor.h"
#include "triangle/refine/star.h"
#include "triangle/size/quality.h"

/* Does a run end with smoothing? Not with area bounds, the caller's size test, -D or -S, because these hold only for
 * the unmoved vertices. */
bool tri_wants_smoothing(const struct tri_quality *quality);

/* The mesh and the bounds are borrowed. Returns TRI_NO_MEMORY if memory ran out. O(triangles). */
enum tri_status tri_smooth_new(struct tri_smooth **smooth, struct tri_mesh *mesh, const struct tri_quality *quality,
                               struct tri_error *error);
void tri_smooth_free(struct tri_smooth *smooth);

/* Counts the outcomes for the vertices of one call. */
struct tri_smooth_count {
    int32_t left;  /* vertices left for later, since a neighbour belongs to another block */
    int32_t moved; /* vertices that were moved */
};

enum tri_smooth_pass {
    TRI_SMOOTH_MOVE, /* moves vertices to better places */
    TRI_SMOOTH_FLIP  /* flips edges to bring degrees near six (degrees.h); before each pass of moves but the first */
};

/* Treats n vertices in the given order, and flips the edges around them until they are Delaunay. On return, vertex[]
 * starts with the count->left vertices left for later. A call changes only vertices of this block, and flips only edges
 * whose four corners belong to it (smooth->home), so calls for different blocks may run at the same time. block < 0:
 * there is no limit. After TRI_NO_MEMORY or TRI_STOPPED the mesh is valid. */
enum tri_status tri_smooth_some(struct tri_smooth *smooth, enum tri_smooth_pass pass, tri_vertex_id *vertex, int32_t n,
                                int32_t block, struct tri_smooth_count *count, struct tri_error *error);

/* Ends the pass: makes all edges Delaunay again, including edges across the border of two blocks. */
enum tri_status tri_smooth_end(struct tri_smooth *smooth, const struct tri_executor *executor, struct tri_error *error);

/* May the vertex be moved? Vertices of the input and on segments may not. */
static inline bool tri_is_movable(const struct tri_mesh *mesh, tri_vertex_id v)
{
    return mesh->on[v] == TRI_VERTEX_FREE;
}

/* Lists the vertices that may be moved, in ascending order; vertex[] has room for all. Returns how many there are. */
int32_t tri_list_movable(const struct tri_mesh *mesh, tri_vertex_id *vertex);

/* Smooths all vertices of a mesh, in at most quality->passes passes or until no vertex moves. */
enum tri_status tri_smooth_all(struct tri_mesh *mesh, const struct tri_quality *quality, struct tri_error *error);

#endif
