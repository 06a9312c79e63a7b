/* Arrays that grow as they are filled. */
#ifndef TRIANGLE_GROW_H
#define TRIANGLE_GROW_H

#include <stdint.h>
#include <stdlib.h>

/* The array with room for so many items at least, half as many again where it has to be moved; NULL where there is no
 * memory: then the array stays as it is. */
static inline void *tri_grown(void *array, int32_t *capacity, int32_t need, size_t item)
{
    if (array && need <= *capacity)
        return array;
    if (need > INT32_MAX / 2)
        return NULL;
    int32_t wanted = need + need / 2 + 64;
    void *grown = realloc(array, (size_t)wanted * item);
    if (grown)
        *capacity = wanted;
    return grown;
}

#endif
