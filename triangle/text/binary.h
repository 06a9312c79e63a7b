/* Conversion of numbers to and from the bytes of binary files, which are little-endian on every machine. So the same
 * mesh gives the same bytes. */
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

static inline uint32_t tri_get_u32(const char *at)
{
    uint32_t value = 0;
    for (int k = 0; k < 4; k++)
        value |= (uint32_t)(unsigned char)at[k] << (8 * k);
    return value;
}

static inline uint64_t tri_get_u64(const char *at)
{
    return tri_get_u32(at) | (uint64_t)tri_get_u32(at + 4) << 32;
}

static inline int32_t tri_get_i32(const char *at)
{
    const uint32_t bits = tri_get_u32(at);
    int32_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline int64_t tri_get_i64(const char *at)
{
    const uint64_t bits = tri_get_u64(at);
    int64_t value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline double tri_get_f64(const char *at)
{
    const uint64_t bits = tri_get_u64(at);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

#endif
