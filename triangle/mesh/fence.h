/* What one call of refinement may touch while others work beside it. */
#ifndef TRIANGLE_MESH_FENCE_H
#define TRIANGLE_MESH_FENCE_H

#include <stdbool.h>

#include "triangle/geometry/point.h"

/* A half-open box; a triangle is owned if all its corners lie in it. */
struct tri_fence {
    double x_min, y_min, x_max, y_max; /* x_min <= x < x_max */
};

static inline bool tri_fence_holds(const struct tri_fence *f, struct tri_point q)
{
    return q.x >= f->x_min && q.x < f->x_max && q.y >= f->y_min && q.y < f->y_max;
}

#endif
