/* Which triangles are bad: the criterion that the refinement loop works for, and its census counts.
 *
 * Nothing here changes the mesh. */
#ifndef TRIANGLE_REFINE_CRITERION_H
#define TRIANGLE_REFINE_CRITERION_H

#include "triangle/refine/quality.h"
#include "triangle/refine/refine.h"

struct tri_criterion {
    const struct tri_mesh *mesh;
    const struct tri_refine_options *options;
    struct tri_bounds bounds; /* for the angle that is worked for now, which may be below that of the options */
    double area2;             /* twice the bound that options have for all areas, in the mesh's units; infinity: none */
};

enum tri_badness { TRI_GOOD, TRI_BAD_SIZE, TRI_BAD_ANGLE };

/* What these options ask for, and the same for areas alone. Both are borrowed. */
struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_refine_options *options);
struct tri_criterion tri_criterion_of_areas(const struct tri_mesh *mesh, const struct tri_refine_options *options);

/* The smaller of the bound for all areas and that of a region. */
double tri_area2_in_region(const struct tri_criterion *criterion, tri_region_id region);

/* Twice the largest area allowed in a region, in the mesh's units; infinity where there is no bound. */
static inline double tri_area2_bound(const struct tri_criterion *criterion, tri_region_id region)
{
    return criterion->options->region_areas ? tri_area2_in_region(criterion, region) : criterion->area2;
}

/* Does the caller's size test, asked of a mesh with this unit, refuse the triangle? Where scale is not 1 it is asked
 * about the triangle shrunk about its centroid, to 1 / scale of its area: so a test for a mesh `scale` times coarser
 * is made of any. */
bool tri_is_refused(const struct tri_refine_options *options, double unit, struct tri_point a, struct tri_point b,
                    struct tri_point c, double scale);

/* The same for a triangle with these corners, at options->area_scale. Only where there is a test. */
bool tri_is_unsuitable(const struct tri_criterion *criterion, const tri_vertex_id v[3]);

/* Does the triangle break a bound on sizes, or does the size test refuse it? */
bool tri_is_too_large(const struct tri_criterion *criterion, const struct tri_triangle *t,
                      const struct tri_shape *shape);

/* Does this call take a triangle with these corners (options->urgent)? */
bool tri_is_urgent(const struct tri_criterion *criterion, const tri_vertex_id v[3]);

/* A bad angle counts before a bad size. What is not urgent is good. */
enum tri_badness tri_judge(const struct tri_criterion *criterion, const struct tri_triangle *t,
                           const struct tri_shape *shape);

/* -Y, -YY: must the subsegment not be split? */
bool tri_is_protected(const struct tri_refine_options *options, const struct tri_subsegment *s);

/* Lower than the shortest edge that coordinates can carry: splitting a subsegment beside it would chase the
 * rounding. */
bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape);

#endif
