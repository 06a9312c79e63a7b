/* What is outside goes: concavities, holes; then regions spread. */
#ifndef TRIANGLE_CARVE_H
#define TRIANGLE_CARVE_H

#include "triangle/mesh.h"

#ifdef __cplusplus
extern "C" {
#endif

struct tri_carve_options {
    bool keep_hull;     /* the convex hull stays whole: its edges count as segments (-c) */
    bool ignore_holes;  /* (-O) */
    bool spread_regions;
};

/* Removes what is reachable from outside the hull, or from a hole point, without crossing a segment; then gives every
 * triangle the last region whose point reaches it (mesh->regions[k + 1] is region k of the PSLG). Points outside the
 * mesh are ignored. Segment markers pass to vertices that have none. Slots and subsegments are compact afterwards,
 * subsegments in the order of their input segments, hull edges last, each with a parent of its own. O(triangles), and
 * what it takes to locate the points (locate.h). */
enum tri_status tri_carve(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_carve_options *options,
                          struct tri_error *error);

/* Marker 1 for every boundary subsegment and boundary vertex that has marker 0. */
void tri_mark_boundary(struct tri_mesh *mesh);

#ifdef __cplusplus
}
#endif

#endif
