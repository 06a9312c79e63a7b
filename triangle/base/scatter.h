/* Pseudo-random numbers that are the same on every machine, for rounds of random samples (Amenta, Choi & Rote 2003). */
#ifndef TRIANGLE_BASE_SCATTER_H
#define TRIANGLE_BASE_SCATTER_H

#include <stdint.h>

/* A bijection that scatters numbers: the results for neighbouring numbers look unrelated. */
static inline uint32_t tri_scatter(uint32_t i)
{
    i ^= i >> 16;
    i *= UINT32_C(0x7feb352d);
    i ^= i >> 15;
    i *= UINT32_C(0x846ca68b);
    return i ^ i >> 16;
}

#endif
