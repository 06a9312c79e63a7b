/* Arrays that grow as they are filled. */
#ifndef TRIANGLE_BASE_GROW_H
#define TRIANGLE_BASE_GROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* Resizes *array to hold n items; `array` is the address of the pointer. Returns false if there is no memory; then
 * nothing has changed. */
static inline bool tri_resize(void *array, size_t n, size_t item)
{
    void *items;
    if (n > SIZE_MAX / item)
        return false;
    memcpy(&items, array, sizeof items);
    items = realloc(items, n * item);
    if (!items)
        return false;
    memcpy(array, &items, sizeof items);
    return true;
}

/* Grows *array, which has room for *capacity items, to hold at least `need`. Allocates half as much again, so that
 * filling the array one item at a time costs O(1) each. Returns false if there is no memory; then nothing has
 * changed. */
static inline bool tri_grow_far(void *array, int64_t *capacity, int64_t need, size_t item)
{
    if (need <= *capacity)
        return true;
    const int64_t wanted = need + need / 2 + 64;
    if (!tri_resize(array, (size_t)wanted, item))
        return false;
    *capacity = wanted;
    return true;
}

/* The same with counts of type int32_t. Also returns false if the new capacity does not fit that type. */
static inline bool tri_grow(void *array, int32_t *capacity, int32_t need, size_t item)
{
    int64_t wanted = *capacity;
    if (need > INT32_MAX / 2 || !tri_grow_far(array, &wanted, need, item))
        return false;
    *capacity = (int32_t)wanted;
    return true;
}

/* One of several arrays that grow together: the address of its pointer, and the size of an item. */
struct tri_growing {
    void *array; /* address of the pointer to the items */
    size_t item; /* bytes of an item */
};

/* Grows n arrays that are filled side by side. Each gets room for `over` additional items. Returns false if there is no
 * memory; then *capacity is unchanged, and no item is lost. */
static inline bool tri_grow_together(const struct tri_growing *array, int n, int32_t *capacity, int32_t need,
                                     int32_t over)
{
    if (need <= *capacity)
        return true;
    if (need > INT32_MAX / 2)
        return false;
    const int32_t wanted = need + need / 2 + 64;
    for (int i = 0; i < n; i++)
        if (!tri_resize(array[i].array, (size_t)wanted + (size_t)over, array[i].item))
            return false;
    *capacity = wanted;
    return true;
}

#endif
