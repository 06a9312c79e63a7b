/* Scans of a whole mesh that change nothing: which triangles need work, which remain bad, and for what reasons. */
#ifndef TRIANGLE_REFINE_CENSUS_H
#define TRIANGLE_REFINE_CENSUS_H

#include "triangle/refine/refine.h"

/* Lists the triangles from first to last - 1 that refinement should treat: triangles with a bad angle that is not
 * hopeless, with a bad size or, if conforming, with a subsegment that the triangle encroaches. Writes them in order
 * to found[last - first] and returns their number. Neighbours are not read, so they may be on another rank. Each
 * call computes the bounds anew, which costs more than judging one triangle. */
int32_t tri_find_work(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id first,
                      tri_triangle_id last, tri_triangle_id *found);

/* The same for the n triangles of an array. `found` may be the same array. */
int32_t tri_find_work_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                            const tri_triangle_id *triangle, int32_t n, tri_triangle_id *found);

/* Returns the corner with an obtuse angle, or -1 if there is none. An obtuse corner encroaches a subsegment opposite
 * to it. Exact. */
int tri_obtuse_corner(const struct tri_mesh *mesh, tri_triangle_id triangle);

/* Counts, by reason, the subsegments that -D could not fix: their diametral circle contains the apex of an adjacent
 * triangle. TRI_EXCUSE_PRECISION: within the precision of coordinates the apex lies on the subsegment, or no
 * coordinates are left for the split point. In the other cases the apex is level with an end except for rounding,
 * and the split would need too many parts. The reason is then the location: a small input angle, or a gap between
 * two close segments. If both sides have such an apex, the first reason of the enum counts. */
void tri_count_encroached(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_refine_report *report, int64_t count[TRI_EXCUSES]);

/* Counts the triangles that violate the bounds, by reason. Only the calling thread calls the caller's functions.
 * O(triangles). */
void tri_count_bad(const struct tri_mesh *mesh, const struct tri_quality *quality,
                   const struct tri_refine_report *report, const struct tri_executor *executor,
                   int64_t count[TRI_EXCUSES]);

/* The same for n triangles, each listed once; adds to the counts. The last count is for triangles without a known
 * reason. */
void tri_count_bad_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         const struct tri_refine_report *report, const tri_triangle_id *triangle, int32_t n,
                         int64_t count[TRI_EXCUSES + 1]);

/* Assigns a reason to the triangles without a known reason, from the report of the whole run. */
void tri_settle_counts(const struct tri_refine_report *report, const int64_t found[TRI_EXCUSES + 1],
                       int64_t count[TRI_EXCUSES]);

/* Lists the triangles that violate the bounds but cannot be improved; tri_find_work omits them. Writes them to
 * found[n_triangles] and returns their number. May call the caller's functions. O(triangles). */
int32_t tri_find_hopeless(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          tri_triangle_id *found);

#endif
