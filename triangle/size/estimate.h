/* Estimates how many triangles refinement will make: in a mesh, in a triangle, and at which positions. tri_estimate
 * serves --dry-run, progress reports and the schedule (number and size of cells). tri_sample_work shows the schedule
 * where to divide cells. tri_size_demand, a lower bound, decides whether a request is refused. */
#ifndef TRIANGLE_SIZE_ESTIMATE_H
#define TRIANGLE_SIZE_ESTIMATE_H

#include "triangle/mesh/mesh.h"
#include "triangle/size/quality.h"

/* Estimates the final number of triangles: those needed for sizes (by integrals of 1 / h^2 for functions of the
 * caller) and those that the angle bound adds (crowd.h). The result may exceed what a mesh can hold. *sure: the
 * certain part, which is the existing triangles and those needed for sizes where these are not met yet. The mesh
 * must have been prepared for refinement (feature_size.h).
 *
 * O(triangles). The caller's functions are called for some 8,000 points, and never for more than 2^20 plus four for
 * each triangle. After a stop request (mesh->stop) they are no longer called and count for nothing. */
double tri_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality,
                    const struct tri_executor *executor, double *sure);

/* Returns a lower bound on the triangles needed for sizes, in the triangles that violate them: the sum of areas over
 * their bounds, plus a third, because no mesh reaches its bounds. Returns 0 without sizes. A length function of the
 * caller is called at most 2^20 times, about four times per triangle and at least 500 times. O(triangles). */
double tri_size_demand(const struct tri_mesh *mesh, const struct tri_quality *quality,
                       const struct tri_executor *executor);

/* Returns TRI_TOO_LARGE if sizes need more triangles than a mesh can hold. tri_refine and the schedule call this
 * first. O(triangles). */
enum tri_status tri_refine_check(const struct tri_mesh *mesh, const struct tri_quality *quality,
                                 const struct tri_executor *executor, struct tri_error *error);

/* Should refinement first reach the sizes with an easy angle bound, and the angles afterwards? Angles above
 * TRI_EASY_ANGLE are expensive to fix where triangles of different sizes meet. Area bounds make neighbours of
 * similar size, but features do not, and fixing angles there would be done twice. So the answer is yes if area
 * bounds need more than twice as many triangles as angles in the current mesh, or if sizes are functions.
 * O(triangles). */
bool tri_sizes_come_first(const struct tri_mesh *mesh, const struct tri_quality *quality,
                          const struct tri_executor *executor);

/* Returns a quick estimate of the work that one bad triangle makes. */
double tri_work_of(const struct tri_mesh *mesh, const struct tri_quality *quality, tri_triangle_id t);

/* Receives a point and the work (in triangles) around it. Returns false to stop. */
typedef bool tri_take_work(void *user, struct tri_point q, double work);

/* Distributes the work in samples of about `grain`, each with a position, in an order that depends on the mesh only.
 * Small amounts are combined. Returns false if `take` did. O(triangles + samples). The caller's functions are called
 * for at most 2^23 points plus four for each triangle. */
bool tri_sample_work(const struct tri_mesh *mesh, const struct tri_quality *quality, double grain,
                     const struct tri_executor *executor, tri_take_work *take, void *user);

#endif
