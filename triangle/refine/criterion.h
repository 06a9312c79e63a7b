/* Which triangles are bad: the criterion that the refinement loop works for, and its census counts.
 *
 * Nothing here changes the mesh. */
#ifndef TRIANGLE_REFINE_CRITERION_H
#define TRIANGLE_REFINE_CRITERION_H

#include "triangle/size/asked.h"

struct tri_criterion {
    struct tri_asked asked;
    struct tri_bounds bounds; /* for the angle that is worked for now, which may be below the one that is asked for */
};

enum tri_badness { TRI_GOOD, TRI_BAD_SIZE, TRI_BAD_ANGLE };

/* Both are borrowed. */
struct tri_criterion tri_criterion_for(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* A bad angle counts before a bad size. */
enum tri_badness tri_judge(const struct tri_criterion *criterion, const struct tri_triangle *t,
                           const struct tri_shape *shape);

/* -Y, -YY: must the subsegment not be split? */
bool tri_is_protected(const struct tri_quality *quality, const struct tri_subsegment *s);

/* Lower than the shortest edge that coordinates can carry: splitting a subsegment beside it would chase the
 * rounding. */
bool tri_is_flat(const struct tri_mesh *mesh, const struct tri_shape *shape);

#endif
