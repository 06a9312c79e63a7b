/* What refinement has to know of the input before it inserts its first point: found once, by tri_refine_prepare, and
 * kept with the mesh. */
#ifndef TRIANGLE_REFINE_GROUNDWORK_H
#define TRIANGLE_REFINE_GROUNDWORK_H

#include <stdbool.h>
#include <stdint.h>

#include "triangle/base/executor.h"
#include "triangle/base/ids.h"
#include "triangle/base/status.h"
#include "triangle/geometry/point.h"

struct tri_mesh;

/* Which parents end at each vertex that there was when they were listed. The parents at vertex v are
 * parent[start[v] .. start[v + 1]); where they are more than TRI_MANY_PARENTS, in order of direction. */
struct tri_incidence {
    tri_parent_id *parent; /* [2 * n_parents] */
    int32_t *start;        /* [n_vertices + 1] */
    int32_t n_vertices;    /* 0: not listed yet */
};

enum { TRI_MANY_PARENTS = 16 };

/* Where refinement leaves a bad triangle as it is. */
struct tri_limits {
    double shortest2;       /* square of the shortest edge that coordinates of this size can carry */
    double dearest_gap;     /* narrow spaces between parents that would cost more points than this are not filled */
    double gap_points;      /* about so many points those that are filled take */
};

/* What limits.shortest2 will be. O(input vertices). */
double tri_shortest_edge2(const struct tri_mesh *mesh);

/* Makes the mesh ready for refinement: lists the parents at each vertex, estimates feature sizes, sets the limits, and
 * marks the input vertices at which two subsegments meet at less than 60 degrees inside the mesh (TRI_VERTEX_ACUTE). To
 * be called after carving, before the first point; a mesh that is ready stays as it is. O(triangles). */
enum tri_status tri_refine_prepare(struct tri_mesh *mesh, const struct tri_executor *executor, struct tri_error *error);

/* Lists the parents at each vertex, in the arrays that tri_refine_prepare has made; called again when vertices get
 * other numbers. O(vertices + parents log parents) at most. */
void tri_incidence_fill(struct tri_mesh *mesh);

/* Is the direction from o to a before that to b, counter-clockwise from that of the axis of x? */
bool tri_turns_before(struct tri_point o, struct tri_point a, struct tri_point b);

/* The end of a parent that is not vertex v. */
struct tri_point tri_far_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

#endif
