/* Arrays that grow as they are filled. */
#ifndef TRIANGLE_GROW_H
#define TRIANGLE_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Makes room for `need` items at least in *array, which has room for *capacity: half as many more than are needed, so
 * that filling it one by one costs O(1) each. `array` is the address of the pointer. False: no memory, or more than an
 * int32_t counts; then nothing has changed. */
static inline bool tri_grow(void *array, int32_t *capacity, int32_t need, size_t item)
{
    if (need <= *capacity)
        return true;
    if (need > INT32_MAX / 2)
        return false;
    const int32_t wanted = need + need / 2 + 64;
    void *items;
    memcpy(&items, array, sizeof items);
    items = realloc(items, (size_t)wanted * item);
    if (!items)
        return false;
    memcpy(array, &items, sizeof items);
    *capacity = wanted;
    return true;
}

#endif
