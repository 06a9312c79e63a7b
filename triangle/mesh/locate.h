/* In which face of the segments does a point lie? */
#ifndef TRIANGLE_MESH_LOCATE_H
#define TRIANGLE_MESH_LOCATE_H

#include <stdint.h>

#include "triangle/base/status.h"
#include "triangle/mesh/mesh.h"

/* One step of a visibility walk to q: the triangle across an edge of t that q lies behind, TRI_NONE where that is the
 * boundary, t itself where it holds q. In a constrained triangulation such a walk may go in circles: so the edge that
 * is tried first turns with the number of the step. */
tri_triangle_id tri_step_towards(const struct tri_mesh *mesh, tri_triangle_id t, int64_t step, struct tri_point q);

/* The triangle that holds q (TRI_NONE outside the hull, which is convex), by a walk from triangle t. */
tri_triangle_id tri_walk_to(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* A subsegment that is an edge of triangle t and has q on it; TRI_NONE if there is none. */
tri_sub_id tri_sub_under(const struct tri_mesh *mesh, tri_triangle_id t, struct tri_point q);

/* For each of n points, in the mesh's coordinates and anywhere in the plane, a triangle of the face that holds it: one
 * that is reached from it without crossing a subsegment; TRI_NONE outside. Of a point on a subsegment any face at it
 * may be told. The mesh fills its convex hull. O((triangles + n) log(triangles + n)) at worst, whatever the shapes;
 * near O(n log n) in a good triangulation. */
enum tri_status tri_locate_faces(const struct tri_mesh *mesh, const struct tri_point *points, int32_t n,
                                 tri_triangle_id *faces, struct tri_error *error);

/* The sweep line of a plane sweep: non-crossing segments in their order along it, from bottom to top.
 *
 * A treap over segment numbers, threaded from bottom to top. Priorities are a hash of the number, so that the shape is
 * the same in every run. "Below" means before in the order of y on the sweep line; the line is vertical, tilted by a
 * hair so that points of equal x are met from bottom to top, and vertical segments need no special case. */

struct tri_sweep_line_node {
    int32_t up, down[2]; /* tree: parent, children below and above; -1: none */
    int32_t next[2];     /* thread: the segment just below, just above; -1: none */
};

struct tri_sweep_line {
    struct tri_sweep_line_node *node; /* [n] */
    int32_t root;            /* -1: empty */
};

/* An empty order for segments 0 .. n - 1. TRI_NO_MEMORY. */
enum tri_status tri_sweep_line_init(struct tri_sweep_line *order, int32_t n);
void tri_sweep_line_clear(struct tri_sweep_line *order);

/* The segment just above s, or the lowest of all if s is -1; -1: none. */
int32_t tri_sweep_line_above(const struct tri_sweep_line *order, int32_t s);

/* Puts segment s just above segment `below`, or lowest of all if that is -1. O(log n) expected. */
void tri_sweep_line_insert(struct tri_sweep_line *order, int32_t s, int32_t below);
void tri_sweep_line_remove(struct tri_sweep_line *order, int32_t s);

#endif
