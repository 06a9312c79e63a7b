/* Advancing front: makes near-equilateral triangles if the wanted edge lengths are given (triangle/size/quality.h).
 *
 * The front consists of the edges between a triangle that is too large and one that is not, and of segments beside
 * triangles that are too large. A triangle that is too large proposes the apex of a triangle on its best front edge,
 * whose legs have the wanted length. If that apex does not lie well below the triangle's circumcentre, it proposes
 * the circumcentre instead. So rows of near-equilateral triangles grow from the segments until they meet.
 *
 * THEOREM (termination; docs/theory.md, the front). No new point is closer to a vertex than half the wanted length. */
#ifndef TRIANGLE_REFINE_FRONT_H
#define TRIANGLE_REFINE_FRONT_H

#include "triangle/refine/bad_queue.h"

struct tri_front_stack {
    struct tri_entry *item; /* [n] the last entry is popped first */
    int32_t n, capacity;    /* entries; allocated */
};

/* The waiting triangles: those on the front, which are treated first, and the others that are too large. */
struct tri_front {
    struct tri_front_stack on, off; /* triangles on the front; the others */
    bool *large; /* [capacity] whether each new triangle is too large, in the order of cavity edges */
    int32_t capacity;               /* allocated entries of `large` */
};

void tri_front_free(struct tri_front *front);

#endif
