/* Diametral circles: what -D promises of every subsegment, and where to split one whose circle is not empty. */
#ifndef TRIANGLE_REFINE_DISK_H
#define TRIANGLE_REFINE_DISK_H

#include "triangle/refine/split.h"

/* Does the apex of the triangle with this code lie strictly in the diametral circle of the subsegment? Exact. */
bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code);

/* Where to split a subsegment: at this fraction from its start. */
struct tri_disk_split {
    double fraction;
    tri_vertex_id level; /* the vertex that the point is level with; TRI_NONE: none */
};

/* Is the subsegment long enough to be split for the sake of v in its circle, and does v lie beside it rather than on
 * it, as far as coordinates tell? */
bool tri_is_resolved_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v);

/* Does the apex of the triangle with this code lie in the circle, and do coordinates resolve a split because of it?
 * *split: where the subsegment is split then, by the rule in disk.c. */
bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            struct tri_disk_split *split);

/* What all places for a split begin at. */
struct tri_split_base tri_disk_base(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                                    const struct tri_disk_split *split);

/* The places for a split, as tri_place_split has them. Places from TRI_SPLIT_PLACES on are only for a point level with
 * a vertex, and are nearer to the level than the others. */
enum { TRI_COLUMNS = 9, TRI_DISK_PLACES = TRI_SPLIT_PLACES + 2 * TRI_COLUMNS };
bool tri_place_disk_split(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                          const struct tri_disk_split *split, const struct tri_split_base *base, int choice,
                          struct tri_point *p);

/* Does `at` lie in the diametral circle of neither part, if s is split at p? Exact. */
bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at);

/* Does the apex of a triangle beside the subsegment lie in its circle, and do coordinates resolve a split because of
 * it? */
bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split);

#endif
