/* Numbers into bytes for binary files, which are little-endian whatever the machine: the same mesh, the same bytes. */
#ifndef TRIANGLE_TEXT_BINARY_H
#define TRIANGLE_TEXT_BINARY_H

#include <stdint.h>
#include <string.h>

static inline char *tri_put_u32(char *at, uint32_t value)
{
    for (int k = 0; k < 4; k++)
        at[k] = (char)(value >> (8 * k));
    return at + 4;
}

static inline char *tri_put_u64(char *at, uint64_t value)
{
    for (int k = 0; k < 8; k++)
        at[k] = (char)(value >> (8 * k));
    return at + 8;
}

static inline char *tri_put_i32(char *at, int32_t value) { return tri_put_u32(at, (uint32_t)value); }
static inline char *tri_put_i64(char *at, int64_t value) { return tri_put_u64(at, (uint64_t)value); }

static inline char *tri_put_f64(char *at, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    return tri_put_u64(at, bits);
}

#endif
