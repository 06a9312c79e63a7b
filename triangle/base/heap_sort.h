/* Heap sort with a context for the comparison, in place: cannot fail, O(n log n) always, the same on every machine. */
#ifndef TRIANGLE_BASE_HEAP_SORT_H
#define TRIANGLE_BASE_HEAP_SORT_H

#include <stdbool.h>
#include <stdint.h>

/* Does a come before b? A strict weak order. */
typedef bool tri_before(const void *context, int32_t a, int32_t b);

static inline void tri_heap_swap(int32_t *a, int32_t *b)
{
    int32_t kept = *a;
    *a = *b;
    *b = kept;
}

static inline void tri_heap_sort(int32_t *item, int32_t n, tri_before *before, const void *context)
{
    for (int32_t heap = n, root = n / 2; heap > 1;) { /* first the heap is made, then its greatest item taken away */
        if (root > 0)
            root--;
        else
            tri_heap_swap(&item[0], &item[--heap]);
        for (int32_t i = root, child; (child = 2 * i + 1) < heap; i = child) {
            child += child + 1 < heap && before(context, item[child], item[child + 1]);
            if (!before(context, item[i], item[child]))
                break;
            tri_heap_swap(&item[i], &item[child]);
        }
    }
}

#endif
