/* Diametral circles: what -D promises of every subsegment, and where to split one whose circle is not empty. */
#ifndef TRIANGLE_DISK_H
#define TRIANGLE_DISK_H

#include "triangle/mesh.h"

/* Does the apex of the triangle with this code lie strictly in the diametral circle of the subsegment? Exact. */
bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code);

/* Where to split a subsegment: at this fraction from its start. */
struct tri_disk_split {
    double fraction;
    tri_vertex_id level; /* the vertex that the point is level with; TRI_NONE: none */
};

/* Does that apex, and do coordinates resolve a split because of it? Where is then in *split: see the rule in the .c
 * file. */
bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            struct tri_disk_split *split);

/* Does `at` lie in the diametral circle of neither part, if s is split at p? Exact. */
bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at);

/* Once s is split at p: can t, where it is to be split level with p, be split such that neither point lies in a circle
 * of the other's subsegments? True, too, where it is not to be split, or they are parts of segments without a common
 * end. */
bool tri_has_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                   const struct tri_subsegment *t);

/* Where it cannot: a fraction nearby, and the choice of its place (split.h), at which to split s so that t can; false:
 * none was found. */
bool tri_shift_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t,
                     double *fraction, int *choice);

/* Does the apex of a triangle beside the subsegment lie in its circle, and do coordinates resolve a split because of
 * it? */
bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split);

#endif
