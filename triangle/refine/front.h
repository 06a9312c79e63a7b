/* Points over a front: near-equilateral triangles for sizes that are lengths of edges (triangle/size/quality.h).
 *
 * The front is the edges between triangles that are too large and others, or segments. A triangle that is too large
 * proposes the apex of a triangle on its best edge of the front, with legs of the length that is asked for, where that
 * lies well below its circumcentre; else it proposes the circumcentre. So rows of near-equilateral triangles grow from
 * the segments, and meet.
 *
 * THEOREM (end; docs/theory.md, the front). No point comes nearer to a vertex than half of the lengths asked for. */
#ifndef TRIANGLE_REFINE_FRONT_H
#define TRIANGLE_REFINE_FRONT_H

#include "triangle/refine/bad_queue.h"

struct tri_front_stack {
    struct tri_entry *item; /* [n] the last first */
    int32_t n, capacity;
};

/* What waits: triangles on the front, which come first, and others that are too large. */
struct tri_front {
    struct tri_front_stack on, off;
    bool *large; /* [capacity] of the new triangles, in the order of the cavity's edges */
    int32_t capacity;
};

void tri_front_free(struct tri_front *front);

#endif
