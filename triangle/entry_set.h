/* A set of triangles, each as it is now: one that has changed since is no longer in it. */
#ifndef TRIANGLE_ENTRY_SET_H
#define TRIANGLE_ENTRY_SET_H

#include "triangle/bad_queue.h"

struct tri_entry_set {
    struct tri_entry *slot; /* [1 << bits], or NULL: empty; open addressing, at most half full */
    int32_t n;
    int bits;
};

void tri_entry_set_free(struct tri_entry_set *set);

/* O(1), amortised. False: no memory. */
bool tri_entry_set_add(struct tri_entry_set *set, struct tri_entry entry);

/* O(1). */
bool tri_entry_set_holds(const struct tri_entry_set *set, struct tri_entry entry);

#endif
