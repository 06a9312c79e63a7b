/* Looking over a whole mesh without changing it: what is there to do, can it be done, what has been left, and why. */
#ifndef TRIANGLE_REFINE_CENSUS_H
#define TRIANGLE_REFINE_CENSUS_H

#include "triangle/refine/refine.h"

/* found[last - first] receives, in order, the triangles from first to last - 1 at which the loop has something to do:
 * an angle that is bad and not hopeless, a bad size, or, if conforming, a subsegment that the triangle encroaches.
 * Returns how many. Neighbours are not looked at: they may be elsewhere. Each call works the bounds out anew, which
 * costs more than to judge a triangle. */
int32_t tri_find_work(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id first,
                      tri_triangle_id last, tri_triangle_id *found);

/* The same among these n triangles. found may be the array they are in. */
int32_t tri_find_work_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                            const tri_triangle_id *triangle, int32_t n, tri_triangle_id *found);

/* The corner at which a triangle is obtuse, so that it encroaches a subsegment that lies opposite; -1: none. Exact. */
int tri_obtuse_corner(const struct tri_mesh *mesh, tri_triangle_id triangle);

/* Counts, by reason, the subsegments that -D could not mend: an apex beside them lies in their diametral circle.
 * TRI_EXCUSE_PRECISION: the vertex lies on the subsegment as far as coordinates tell, or coordinates have no place for
 * the split. Else the vertex is level with an end but for rounding, and the split would take too many parts: the reason
 * is the place, at a small angle of the input or between segments near to each other. Where both sides have such a
 * vertex, the first reason counts. */
void tri_count_encroached(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_refine_report *report, int64_t count[TRI_EXCUSES]);

/* Counts the triangles that violate the bounds, by reason. The calling thread alone asks the caller's functions.
 * O(triangles). */
void tri_count_bad(const struct tri_mesh *mesh, const struct tri_quality *quality,
                   const struct tri_refine_report *report, const struct tri_executor *executor,
                   int64_t count[TRI_EXCUSES]);

/* The same of n triangles alone, each of which is listed once; adds to the counts. The last count is of triangles that
 * have no reason of their own. */
void tri_count_bad_among(const struct tri_mesh *mesh, const struct tri_quality *quality,
                         const struct tri_refine_report *report, const tri_triangle_id *triangle, int32_t n,
                         int64_t count[TRI_EXCUSES + 1]);

/* Counts with a reason for all, by the report of the whole run. */
void tri_settle_counts(const struct tri_refine_report *report, const int64_t found[TRI_EXCUSES + 1],
                       int64_t count[TRI_EXCUSES]);

/* found[n_triangles] receives the triangles that violate the bounds but cannot be improved: what
 * tri_find_work leaves out. Returns how many. The caller's functions are asked. O(triangles). */
int32_t tri_find_hopeless(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          tri_triangle_id *found);

#endif
