/* Triangles outside go: in concavities and holes. Then regions spread. */
#ifndef TRIANGLE_CDT_CARVE_H
#define TRIANGLE_CDT_CARVE_H

#include "triangle/cdt/why_empty.h"
#include "triangle/mesh/mesh.h"

struct tri_carve_report {
    int32_t between;       /* hole points that lie between faces */
    struct tri_empty why;  /* nothing is left */
};

struct tri_carve_options {
    bool keep_hull;     /* the convex hull stays whole: its edges count as segments (-c) */
    bool ignore_holes;  /* (-O) */
    bool spread_regions;
    bool even_odd;      /* segments tell what is inside: see below */
    struct tri_carve_report *report; /* NULL: nobody asks */
};

/* Removes what is reachable from outside the hull, or from a hole point, without crossing a segment; then gives every
 * triangle the last region whose point reaches it (mesh->regions[k + 1] is region k of the PSLG). Points outside the
 * mesh are ignored. So are holes between faces: exactly on a subsegment or at an end of one, as it runs in the mesh (a
 * segment may lead through a vertex that lies nearly on it). Which face is meant is not known there, and nothing is
 * taken in doubt. Segment markers pass to vertices that have none. Triangles and subsegments are compact afterwards,
 * subsegments in the order of their input segments, hull edges last, each with a parent of its own. O(triangles), and
 * what it takes to locate the points (locate.h).
 *
 * even_odd: what has an even depth goes, too. The depth of a triangle is the least number of barriers on a way to it
 * from outside; a barrier is a subsegment along which an odd number of input segments run. So rings may lie in rings,
 * and where two polygons share a border, each with a segment of its own there, that is none. THEOREM. Where barriers
 * are closed rings, whatever they cross (at each vertex an even number of barriers ends), this is the even-odd rule:
 * any closed way crosses an even number of them, so that all ways to a triangle have the same parity. Otherwise: a
 * barrier with one triangle's component on both sides changes nothing (a dangling one), nor does one between two
 * components of one depth (across a ring). With keep_hull, hull edges along which no segment runs are barriers. */
enum tri_status tri_carve(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_carve_options *options,
                          struct tri_error *error);

/* The marker for those of the two vertices that have marker 0. */
void tri_mark_ends(struct tri_mesh *mesh, const tri_vertex_id v[2], int32_t marker);

/* The marker of a subsegment for every vertex at it that has marker 0. */
void tri_mark_vertices(struct tri_mesh *mesh);

/* Marker 1 for every boundary subsegment and boundary vertex that has marker 0. */
void tri_mark_boundary(struct tri_mesh *mesh);

#endif
