/* Segments into a Delaunay triangulation: the constrained Delaunay triangulation of a PSLG. */
#ifndef TRIANGLE_CDT_CONSTRAIN_H
#define TRIANGLE_CDT_CONSTRAIN_H

#include "triangle/mesh/mesh.h"
#include "triangle/tunables.h"

struct tri_constrain_report {
    int32_t crossings; /* vertices made where segments cross */
    int32_t bent;      /* times a segment runs through a vertex within rounding of it, or of a crossing */
    int32_t skipped;   /* segments with an end outside the points, or two equal ends */
    int64_t looked_at; /* triangles, in search of what segments meet */
};

/* Makes every segment of the PSLG (whose points are the mesh's first vertices) a chain of subsegments, whose vertices
 * are at most TRI_SEGMENT_ASTRAY * 2^-52 * (the largest coordinate of the segment's ends) off its line. Vertices on a
 * segment, and within rounding of it, split it; crossing segments are cut at a new vertex, which takes marker and
 * interpolated attributes of the segment that comes first; where segments overlap the first non-zero marker wins. The
 * result is constrained Delaunay, ties broken by coordinates. Each subsegment has a parent of its own.
 * TRI_BAD_INPUT, naming the segment, where a chain cannot be kept that near to its line (thousands of near coincidences
 * at one place). Expected near O(crossed edges) per segment. */
enum tri_status tri_constrain(struct tri_mesh *mesh, const struct tri_pslg *pslg, struct tri_constrain_report *report,
                              struct tri_error *error);

#endif
