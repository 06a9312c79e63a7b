/* The part of a mesh that one call of refinement may change while other calls run in parallel. */
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

/* A run-time check that calls working on one mesh in parallel change different triangles: each call marks the triangles
 * that it changes. Used by asserts in debug builds. A call without owners may change any triangle. Each call has its
 * own struct; all share the marks. */
struct tri_owners {
    int32_t *mark; /* [triangles] number of the call that changed it; 0: unchanged since the marks were cleared */
    int32_t self;  /* number of this call, > 0 */
};

/* Marks the triangle as changed by this call. Returns false if another call has changed it. */
static inline bool tri_owners_claim(const struct tri_owners *owners, tri_triangle_id triangle)
{
    if (!owners || owners->mark[triangle] == owners->self)
        return true;
    bool was_free = owners->mark[triangle] == 0;
    owners->mark[triangle] = owners->self;
    return was_free;
}

#endif
