/* Positions of the points that split subsegments. For -D also decides whether a subsegment is split. */
#ifndef TRIANGLE_REFINE_SPLIT_H
#define TRIANGLE_REFINE_SPLIT_H

#include "triangle/cdt/crossing.h"

/* Returns where to split a subsegment, as a fraction of its length from its start: in the middle or, beside an acute
 * input vertex, at a power of two from that vertex, the one nearest to the middle. So subsegments that meet at a
 * small angle are split on common circles (concentric shells: Ruppert 1995), and do not encroach each other
 * endlessly. */
double tri_split_fraction(const struct tri_mesh *mesh, const struct tri_subsegment *s);

/* Is the subsegment from a to b long enough to be split? */
bool tri_can_split(const struct tri_mesh *mesh, struct tri_point a, struct tri_point b);

enum { TRI_SPLIT_PLACES = 4 * TRI_PLACES };

/* The ideal split point, rounded once: on the parent's line, and on the subsegment. */
struct tri_split_base {
    struct tri_point on_line, on_sub; /* on the parent's line; on the subsegment */
};

/* Returns the ideal split point at this fraction of the subsegment. */
struct tri_split_base tri_split_base(const struct tri_mesh *mesh, const struct tri_subsegment *s, double fraction);

/* Sets *p to candidate number `choice` (0 to TRI_SPLIT_PLACES - 1) for the split point, best candidates first. The
 * candidates lie around the base, at most about one resolution from it (crossing.h). Returns false if the boundary
 * could touch itself with this candidate, or if it is too far from the line: see split.c. */
bool tri_place_split(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_split_base *base,
                     int choice, struct tri_point *p);

/* --- diametral circles: the condition of -D, and where to split a subsegment whose circle is not empty */

/* Does the apex of the triangle of half-edge `code` lie strictly inside the diametral circle of the subsegment?
 * Exact. */
bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code);

/* Where to split a subsegment for -D. */
struct tri_disk_split {
    double fraction;     /* position as a fraction of the subsegment, from its start */
    tri_vertex_id level; /* the vertex with which the split point is level (split.c); TRI_NONE: none */
};

/* Can the vertex v, which lies in the subsegment's circle, cause a split? The subsegment must be long enough, and v
 * must lie beside it rather than on it, within the precision of coordinates. */
bool tri_is_resolved_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v);

/* Does the apex of the triangle of half-edge `code` lie in the diametral circle, and do coordinates resolve the
 * split that it causes? Sets *split by RULE in split.c. */
bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            struct tri_disk_split *split);

/* Returns the ideal split point for `split`. */
struct tri_split_base tri_disk_base(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                                    const struct tri_disk_split *split);

/* Candidates for the split point, as in tri_place_split. Candidates from TRI_SPLIT_PLACES on are only for points
 * level with a vertex, and are closer to that level than the others. */
enum { TRI_COLUMNS = 9, TRI_DISK_PLACES = TRI_SPLIT_PLACES + 2 * TRI_COLUMNS };
bool tri_place_disk_split(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                          const struct tri_disk_split *split, const struct tri_split_base *base, int choice,
                          struct tri_point *p);

/* If s is split at p, does `at` lie in neither part's diametral circle? Exact. */
bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at);

/* Does the apex of an adjacent triangle lie in the subsegment's diametral circle, and do coordinates resolve the
 * split that it causes? */
bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split);

#endif
