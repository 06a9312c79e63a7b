/* Diametral circles: what -D promises of every subsegment, and where to split one whose circle is not empty. */
#ifndef TRIANGLE_DISK_H
#define TRIANGLE_DISK_H

#include "triangle/mesh.h"

/* Does the apex of the triangle with this code lie strictly in the diametral circle of the subsegment? Exact. */
bool tri_is_in_diametral_disk(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code);

/* Does that apex, and do coordinates resolve a split because of it? Where to split is then *fraction, from the start:
 * see the rule in the .c file. */
bool tri_is_encroached_from(const struct tri_mesh *mesh, const struct tri_subsegment *s, tri_halfedge code,
                            double *fraction);

/* Does the apex of a triangle beside the subsegment lie in its circle, and do coordinates resolve a split because of
 * it? */
bool tri_is_encroached(const struct tri_mesh *mesh, const struct tri_subsegment *s, double *fraction);

#endif
