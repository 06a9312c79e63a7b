/* How many triangles refinement will make: in a mesh, in a triangle, and where. tri_estimate is read by --dry-run, by
 * progress, and by the schedule, for the number and size of its cells; tri_sample_work says where cells are cut;
 * tri_size_demand, the certain part, is what refusals read. */
#ifndef TRIANGLE_SIZE_ESTIMATE_H
#define TRIANGLE_SIZE_ESTIMATE_H

#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

/* Estimates the number of triangles that refinement will end with: those that sizes ask for, by integrals of 1 / h^2
 * where sizes are the caller's functions, and those that angles ask for beside them (crowd.h). It may be more than any
 * mesh can hold. *sure: the certain part: the triangles that there are, and those that sizes ask for where they are not
 * met yet. The mesh has been made ready for refinement (feature_size.h).
 * O(triangles); the caller's functions are asked at some 8,000 places, never at more than 2^20 beside four for each
 * triangle. Once a stop is asked for (mesh->stop), they are not asked any more, and count for nothing. */
double tri_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality,
                    const struct tri_executor *executor, double *sure);

/* The least number of triangles that the sizes ask for, in triangles that violate them: the sum of areas over their
 * bounds, and a third more, since no mesh fills its bounds; 0 without sizes. Lengths of a caller's function are looked
 * at by at most 2^20 calls, about four for each triangle and 500 at least. O(triangles). */
double tri_size_demand(const struct tri_mesh *mesh, const struct tri_quality *quality,
                       const struct tri_executor *executor);

/* TRI_TOO_LARGE where the sizes ask for more triangles than one mesh can hold; tri_refine asks first, and so does a
 * schedule. O(triangles). */
enum tri_status tri_refine_check(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_executor *executor, struct tri_error *error);

/* Should refinement reach the sizes first, with an easy angle bound, and the angles afterwards? Angles above
 * TRI_EASY_ANGLE are dear to mend where triangles of different sizes meet. Area bounds make neighbours of similar size;
 * features do not, and mending there would be done twice. So the answer is yes where areas ask for more than twice as
 * many triangles as angles, in the mesh as it is, and where sizes are functions of the caller. O(triangles). */
bool tri_sizes_come_first(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_executor *executor);

/* The work that one bad triangle makes, at a glance. */
double tri_work_of(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id t);

/* Takes a place and the work (triangles) that lies about there. False: it cannot. */
typedef bool tri_take_work(void *user, struct tri_point q, double work);

/* Hands out the work in pieces of about `grain`, each with its place, in an order that the mesh decides; small ones are
 * gathered. False: `take` said so. O(triangles + pieces); the caller's functions are asked at no more than 2^23 places
 * beside four for each triangle. */
bool tri_sample_work(const struct tri_mesh *mesh, const struct tri_quality *quality, double grain,
                     const struct tri_executor *executor, tri_take_work *take, void *user);

#endif
