/* Where the point that splits a subsegment goes; under -D also, when it is split. */
#ifndef TRIANGLE_REFINE_SPLIT_H
#define TRIANGLE_REFINE_SPLIT_H

#include "triangle/cdt/crossing.h"

/* Where to split a subsegment, as a fraction from its start: in the middle or, beside an acute input vertex, at the
 * power of two nearest to the middle from there. So subsegments that meet at a small angle are split on common circles
 * (concentric shells: Ruppert 1995), and do not encroach each other for ever. */
double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s);

/* Is the subsegment from a to b long enough to be split? */
bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b);

enum { TRI_SPLIT_PLACES = 4 * TRI_PLACES };

/* The point that a subsegment is to be split at, rounded once: on its parent's line, and on the subsegment. */
struct tri_split_base {
    struct tri_point on_line, on_sub;
};

/* At this fraction of the subsegment. */
struct tri_split_base tri_split_base(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction);

/* *p: one of TRI_SPLIT_PLACES beside the base, up to about one resolution from it (crossing.h); choice: which one, the
 * best are the first. False where the place does not keep the boundary to itself, or is too far from the line: see
 * split.c. */
bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_split_base *base,
                     int choice, struct tri_point *p);

/* --- diametral circles: what -D promises of every subsegment, and where to split one whose circle is not empty */

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
 * *split: where the subsegment is split then, by the rule in split.c. */
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
