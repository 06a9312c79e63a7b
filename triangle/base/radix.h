/* Sorting by integer keys, in linear time and in parallel. */
#ifndef TRIANGLE_BASE_RADIX_H
#define TRIANGLE_BASE_RADIX_H

#include "triangle/base/executor.h"

/* Bits of a number that is not negative, at least one. */
static inline int tri_bits_of(int32_t number)
{
    int bits = 1;
    while (bits < 31 && number >> bits)
        bits++;
    return bits;
}

/* Sorts items[n] by their bits low .. high - 1, 0 <= low < high <= 64; those that agree in them keep their order. Bits
 * at and above high must be zero. What lies below low comes along: an index, mostly. scratch[n]. Cannot fail.
 * O(n (high - low)): for keys that are spread one pass through memory, and up to four in the cache. */
void tri_radix_sort(uint64_t *items, uint64_t *scratch, int32_t n, int low, int high,
                    const struct tri_executor *executor);

#endif
