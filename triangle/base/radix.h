/* Sorting by integer keys, in linear time and in parallel. */
#ifndef TRIANGLE_BASE_RADIX_H
#define TRIANGLE_BASE_RADIX_H

#include "triangle/base/executor.h"

/* Returns the number of bits of a number >= 0, at least one. */
static inline int tri_bits_of(int32_t number)
{
    int bits = 1;
    while (bits < 31 && number >> bits)
        bits++;
    return bits;
}

/* Sorts items[n] by their bits low .. high - 1, with 0 <= low < high <= 64. Items that agree in these bits keep their
 * order. Bits from high on must be zero. Bits below low move with the item and are usually an index. scratch has room
 * for n items. Cannot fail. Takes O(n (high - low)): for evenly spread keys one pass through memory and up to four in
 * the cache. */
void tri_radix_sort(uint64_t *items, uint64_t *scratch, int32_t n, int low, int high,
                    const struct tri_executor *executor);

#endif
