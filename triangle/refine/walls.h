/* Subsegments that must not be split, in a tree of boxes: which of them keep a point out is found without a search for
 * its cavity, which beside a long wall may be all the triangles that lie along it. */
#ifndef TRIANGLE_REFINE_WALLS_H
#define TRIANGLE_REFINE_WALLS_H

#include "triangle/mesh/cavity.h"
#include "triangle/refine/criterion.h"
#include "triangle/tunables.h"

struct tri_walls;

/* To be freed. NULL if some subsegment may be split, and where there is no memory. O(n log n) for n subsegments. */
struct tri_walls *tri_walls_new(const struct tri_criterion *criterion);
void tri_walls_free(struct tri_walls *walls);

/* A wall for which p, proposed by triangle t with this shortest edge, squared, is refused; TRI_NONE: only a search can
 * tell. O(log n) where p lies in few circles of walls. */
tri_sub_id tri_wall_before(const struct tri_walls *walls, tri_triangle_id t, struct tri_point p, double shortest);

/* Does p see the wall between a and b under so wide an angle that it encroaches it? */
static inline bool tri_is_in_lens(struct tri_relative a, struct tri_relative b, double lens_cos2)
{
    const double dot = a.x * b.x + a.y * b.y;
    return dot < 0 && dot * dot > lens_cos2 * a.l * b.l;
}

/* If so, may it for a triangle with this shortest edge, squared, since the wall must not be split? area2: their cross
 * product. See docs/theory.md, protected walls. */
static inline bool tri_is_tolerated(struct tri_relative a, struct tri_relative b, double area2, double shortest)
{
    const double x = b.x - a.x, y = b.y - a.y;
    return area2 * area2 > TRI_CLEARANCE * TRI_CLEARANCE * shortest * (x * x + y * y);
}

#endif
