/* Where refinement must stop: small input angles, and features that cannot be resolved. */
#ifndef TRIANGLE_REFINE_SMALL_ANGLE_H
#define TRIANGLE_REFINE_SMALL_ANGLE_H

#include "triangle/refine/quality.h"

/* Where to split a subsegment, as a fraction from its start: in the middle or, beside an acute input vertex, at the
 * power of two nearest to the middle from there. So subsegments that meet at a small angle are split on common circles
 * (concentric shells: Ruppert 1995), and do not encroach each other for ever. */
double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s);

/* Is the subsegment from a to b long enough to be split? */
bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b);

/* How two parents meet. */
enum tri_corner {
    TRI_APART,         /* not at all, or they are the same */
    TRI_WIDE_CORNER,   /* at 60 degrees or more */
    TRI_NARROW_CORNER, /* at less */
    TRI_SPIKE          /* at so little that the space between is not filled: a quarter of a degree */
};
enum tri_corner tri_corner_between(const struct tri_mesh *mesh, tri_parent_id p, tri_parent_id q);

/* Does the vertex touch the parent, as far as coordinates tell: is it an end of it, or nearer than the square root of
 * limits.shortest2? */
bool tri_touches(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

/* Does the shortest edge of the triangle join two segments that touch? */
bool tri_crosses_angle(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the vertex lie on a parent? */
bool tri_is_on_parent(const struct tri_mesh *mesh, tri_vertex_id v);

/* The common end of a parent and a parent that vertex v lies on; TRI_NONE where there is none. O(parents at v). */
tri_vertex_id tri_common_end(const struct tri_mesh *mesh, tri_parent_id parent, tri_vertex_id v);

/* A bad angle that no point can mend, or that would only move it: see the rules in the .c file. */
bool tri_is_hopeless(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* How many points, to the order, would fill the space between two parents? The first runs through u, the second through
 * v, and they are nearest to each other there: as far apart as v is from the line of the first. The cost is the
 * integral of 1 / width along the space: Ruppert's integral of 1 / size^2 (1995), where each place is as wide as its
 * features. */
double tri_filling_cost(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                        struct tri_point v);

/* Will the space between two parents be filled, so that its width is a feature? Not where an end of one touches the
 * other, unless they meet at less than 60 degrees. u and v as above. */
bool tri_is_filled(const struct tri_mesh *mesh, tri_parent_id first, tri_parent_id second, struct tri_point u,
                   struct tri_point v);

/* About so many points it would take to fill the space between two parents that the shortest edge of the triangle
 * bridges; 0 where it bridges none. */
double tri_gap_cost(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle bridge a spike? */
bool tri_bridges_spike(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Does the shortest edge of the triangle bridge a spike, or a space between two parents that is too dear to fill? */
bool tri_is_narrow_gap(const struct tri_mesh *mesh, tri_triangle_id triangle, const struct tri_shape *shape);

/* Chooses which narrow spaces are filled, by their cost (mesh->limits): the parents at each vertex are listed.
 * O(triangles). */
void tri_choose_gaps(struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
