/* What one call of refinement may touch while others work beside it. */
#ifndef TRIANGLE_MESH_FENCE_H
#define TRIANGLE_MESH_FENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/base/ids.h"
#include "triangle/geometry/point.h"

/* A half-open box; a triangle is owned if all its corners lie in it. */
struct tri_fence {
    double x_min, y_min, x_max, y_max; /* x_min <= x < x_max */
};

static inline bool tri_fence_holds(const struct tri_fence *f, struct tri_point q)
{
    return q.x >= f->x_min && q.x < f->x_max && q.y >= f->y_min && q.y < f->y_max;
}

/* Proof at run time that calls which work on one mesh at once change different triangles: each marks what it changes.
 * For asserts in debug builds; a call without owners changes what it likes. One for each call; they share the marks. */
struct tri_owners {
    int32_t *mark; /* [triangles] who changed a triangle since the marks were cleared; 0: nobody */
    int32_t self;  /* > 0: who makes this call */
};

/* False: somebody else has changed the triangle. */
static inline bool tri_owners_claim(const struct tri_owners *owners, tri_triangle_id triangle)
{
    if (!owners || owners->mark[triangle] == owners->self)
        return true;
    bool was_free = owners->mark[triangle] == 0;
    owners->mark[triangle] = owners->self;
    return was_free;
}

#endif
