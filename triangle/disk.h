/* Diametral circles: what -D promises of every subsegment, and where to split one whose circle is not empty. */
#ifndef TRIANGLE_DISK_H
#define TRIANGLE_DISK_H

#include "triangle/split.h"

/* Does the apex of the triangle with this code lie strictly in the diametral circle of the subsegment? Exact. */
bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code);

/* Where to split a subsegment: at this fraction from its start. */
struct tri_disk_split {
    double fraction;
    tri_vertex_id level; /* the vertex that the point is level with; TRI_NONE: none */
    bool renews;         /* a new level beside an end that the vertex is level with but for rounding */
};

/* Is the subsegment long enough to be split for the sake of v in its circle, and does v lie beside it rather than on
 * it, as far as coordinates tell? */
bool tri_is_resolved_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_vertex_id v);

/* Does that apex, and do coordinates resolve a split because of it? Where is then in *split: see the rule in the .c
 * file. */
bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            struct tri_disk_split *split);

/* The places for a split, as tri_place_split; those from TRI_SPLIT_PLACES on are for a point level with a vertex alone,
 * and nearer to being so than the others. */
enum { TRI_COLUMNS = 9, TRI_DISK_PLACES = TRI_SPLIT_PLACES + 2 * TRI_COLUMNS };
bool tri_place_disk_split(const struct tri_mesh *mesh, const struct tri_subsegment *s,
                          const struct tri_disk_split *split, int choice, struct tri_point *p);

/* Does `at` lie in the diametral circle of neither part, if s is split at p? Exact. */
bool tri_leaves_disks_empty(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                            struct tri_point at);

/* The fraction of t that is level with p, a point on subsegment s; it may lie beyond t's ends. */
double tri_level_of(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                    const struct tri_subsegment *t);

/* Once s is split at p: is t to be split level with p? */
bool tri_takes_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                     const struct tri_subsegment *t);

/* And can it be, such that neither point lies in a circle of the other's subsegments? True, too, where it is not to
 * be. */
bool tri_has_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_point p,
                   const struct tri_subsegment *t);

/* Where it cannot: a fraction nearby, and the choice of its place (split.h), at which to split s so that t can; false:
 * none was found. */
bool tri_shift_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t,
                     double *fraction, int *choice);

/* Where s is split to renew a level (split->renews): sets the fraction to the next at which there is a place from which
 * the vertex lies in the circle of neither part, and that has a place on t level with it; t: the subsegment that will
 * be split level with it, NULL where there is none. The place is that of choice tri_renewal_place(*trial). False: there
 * is no other. *trial is 0 at first, one more than last time afterwards, and TRI_RENEWALS at most. */
enum { TRI_RENEWALS = 2 * 512 * TRI_PLACES };
bool tri_renew_level(const struct tri_mesh *mesh, const struct tri_subsegment *s, const struct tri_subsegment *t,
                     struct tri_disk_split *split, int *trial);

/* The choice of place in a trial: at all fractions those in fine steps, then at all those in coarse steps (split.c). */
static inline int tri_renewal_place(int trial)
{
    return trial % TRI_PLACES + (trial < TRI_RENEWALS / 2 ? 0 : 2 * TRI_PLACES);
}

/* Does the apex of a triangle beside the subsegment lie in its circle, and do coordinates resolve a split because of
 * it? */
bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, struct tri_disk_split *split);

#endif
