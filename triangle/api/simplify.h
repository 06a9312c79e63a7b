/* Simplifies the chains of a PSLG before meshing.
 *
 * METHOD. Visvalingam & Whyatt, Line generalisation by repeated elimination of points, Cartographic Journal 30, 1993:
 * of all corners whose triangle with both neighbours is smaller than L^2 / 2, the one with the smallest triangle is
 * removed first. A corner at a segment shorter than L is removed as well, unless that makes an angle below 30 degrees.
 * TOPOLOGY. A corner stays if its closed triangle contains another point, a hole point or a region point. It also stays
 * if the new segment would come nearer than L / 10 to one of these, and less than half as near as the old segments.
 * Segments that meet others only at common ends can then meet nothing new (compare Saalfeld, Cartography and Geographic
 * Information Science 26, 1999). All others, found by triangulation, keep their ends and the points on them.
 * CORNERS. A point can be removed if exactly two segments end there, both with the same marker, and if its own marker
 * is 0, that marker, or that of both neighbours.
 * ISLANDS. A closed chain whose points could all be removed, and which encloses less than L^2 with its remaining
 * corners, is removed with the hole points and region points inside, unless other points lie inside. */
#ifndef TRIANGLE_API_SIMPLIFY_H
#define TRIANGLE_API_SIMPLIFY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/pslg.h"

struct tri_simplify_report {
    int32_t corners;     /* removed points, without those of islands */
    int32_t islands;     /* removed closed chains */
    int32_t island_points; /* removed points of these */
    int32_t holes, regions; /* removed hole points, and region points */
    int32_t shorter;     /* segments that are still shorter than L */
};

/* Simplifies the PSLG. min_edge: L, above 0, in its units. The remaining points, segments, holes and regions keep their
 * order. Segments that a mesh skips are removed. After an error the PSLG can only be freed. TRI_BAD_INPUT: as for
 * tri_generate, or none of its segments remains; TRI_TOO_LARGE, TRI_NO_MEMORY, TRI_STOPPED. Expected O(n log n) for n
 * points that are spread evenly. */
enum tri_status tri_simplify(struct tri_pslg *pslg, double min_edge, const struct tri_executor *executor,
                             const struct tri_stop *stop, struct tri_simplify_report *report, struct tri_error *error);

#endif
