/* Removes the triangles outside the domain, in concavities and holes. Then assigns regions. */
#ifndef TRIANGLE_CDT_CARVE_H
#define TRIANGLE_CDT_CARVE_H

#include "triangle/cdt/why_empty.h"
#include "triangle/mesh/mesh.h"

struct tri_carve_report {
    int32_t between;       /* number of hole points that lie on the border between faces */
    struct tri_empty why;  /* the reason, if no triangle is left */
};

struct tri_carve_options {
    bool keep_hull;     /* keep the convex hull: its edges count as segments (-c) */
    bool ignore_holes;  /* ignore hole points (-O) */
    bool spread_regions; /* assign regions by the region points of the PSLG */
    bool even_odd;       /* the even-odd rule defines the domain: see below */
    int32_t n_open;      /* number of segments, the last ones, which have no effect on the domain and on regions. With
                            even_odd an even number of them must run along each subsegment */
    struct tri_carve_report *report; /* NULL: no report */
};

/* Removes all triangles reachable from outside the hull, or from a hole point, without crossing a segment. Then assigns
 * each triangle the last region whose point reaches it (mesh->regions[k + 1] is region k of the PSLG). Points outside
 * the mesh are ignored. Hole points between faces are ignored as well, because it is not clear which face is meant:
 * these lie exactly on a subsegment of the mesh or at an end of one. (A segment may run through a vertex that lies
 * almost on it.) Unmarked vertices get the markers of their segments. Afterwards triangles and subsegments are compact.
 * Subsegments are in the order of their input segments, hull edges last, each with its own parent. O(triangles), plus
 * the cost of locating the points (locate.h).
 *
 * even_odd: also removes the triangles of even depth. The depth of a triangle is the least number of barriers on a path
 * to it from outside; a barrier is a subsegment along which an odd number of input segments run. So rings may be
 * nested, and a border shared by two polygons, each with its own segment there, is not a barrier.
 *
 * THEOREM. If barriers form closed rings, which may cross (an even number of barriers ends at each vertex), this is the
 * even-odd rule: a closed path crosses an even number of barriers, so all paths to a triangle have the same parity. In
 * other cases, a barrier with the same component on both sides (a dangling one) has no effect, nor has one between two
 * components of equal depth (across a ring). With keep_hull, hull edges without a segment are barriers. */
enum tri_status tri_carve(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_carve_options *options,
                          struct tri_error *error);

/* Sets the marker of the two vertices if it is 0. */
void tri_mark_ends(struct tri_mesh *mesh, const tri_vertex_id v[2], int32_t marker);

/* Sets the markers of vertices that are 0 to the marker of a subsegment that ends there. */
void tri_mark_vertices(struct tri_mesh *mesh);

/* Sets the markers of boundary subsegments and boundary vertices that are 0 to 1. */
void tri_mark_boundary(struct tri_mesh *mesh);

#endif
