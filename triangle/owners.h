/* Proof at run time that calls which work on one mesh at once change different triangles: each marks what it changes.
 * For asserts in debug builds; where a mesh has no owners, everything is everybody's. */
#ifndef TRIANGLE_OWNERS_H
#define TRIANGLE_OWNERS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "triangle/ids.h"

/* One for each view of a mesh; they share the marks. */
struct tri_owners {
    int32_t *mark; /* [slots] who changed a triangle since the marks were cleared; 0: nobody */
    int32_t self;  /* > 0: who works on this view */
};

/* False: somebody else has changed the triangle. */
static inline bool tri_owners_claim(const struct tri_owners *owners, tri_triangle_id slot)
{
    if (!owners || owners->mark[slot] == owners->self)
        return true;
    bool was_free = owners->mark[slot] == 0;
    owners->mark[slot] = owners->self;
    return was_free;
}

#endif
