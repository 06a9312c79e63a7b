/* Inserts segments into a Delaunay triangulation, which makes it the constrained Delaunay triangulation of a PSLG. */
#ifndef TRIANGLE_CDT_CONSTRAIN_H
#define TRIANGLE_CDT_CONSTRAIN_H

#include "triangle/mesh/mesh.h"
#include "triangle/tunables.h"

struct tri_constrain_report {
    int32_t crossings; /* vertices inserted where segments cross */
    int32_t bent;      /* how often a segment was led through a vertex within rounding of the segment or a crossing */
    int32_t skipped;   /* segments with an end out of range, or two equal ends */
    int64_t looked_at; /* triangles visited in search of obstacles */
};

/* Makes every segment of the PSLG a chain of subsegments. The PSLG's points are the mesh's first vertices. Vertices of
 * a chain lie within TRI_SEGMENT_ASTRAY * 2^-52 * (the largest coordinate of the segment's ends) of the segment's line.
 * Vertices on a segment, or within rounding of it, split it. Crossing segments are cut at a new vertex, which gets the
 * marker and the interpolated attributes of the segment that comes first. If segments overlap, the first non-zero
 * marker wins. The result is constrained Delaunay, with ties broken by coordinates. Each subsegment has its own parent.
 * Returns TRI_BAD_INPUT, naming the segment, if a chain cannot be kept this near to its line (thousands of near
 * coincidences at one place). Expected near O(crossed edges) per segment. */
enum tri_status tri_constrain(struct tri_mesh *mesh, const struct tri_pslg *pslg, struct tri_constrain_report *report,
                              struct tri_error *error);

#endif
