/* In-place heap sort whose comparison receives a context. It cannot fail, always takes O(n log n), and gives the same
 * result on every machine. */
#ifndef TRIANGLE_BASE_HEAP_SORT_H
#define TRIANGLE_BASE_HEAP_SORT_H

#include <stdbool.h>
#include <stdint.h>

/* Returns true if a comes before b; must be a strict weak order. */
typedef bool tri_before(const void *context, int32_t a, int32_t b);

static inline void tri_heap_swap(int32_t *a, int32_t *b)
{
    int32_t kept = *a;
    *a = *b;
    *b = kept;
}

static inline void tri_heap_sort(int32_t *item, int32_t n, tri_before *before, const void *context)
{
    for (int32_t heap = n, root = n / 2; heap > 1;) { /* builds the heap, then removes its maximum each time */
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
