/* A file in memory as bytes that are taken one after the other, for formats that are binary: little-endian numbers, and
 * lines between them. What is not there is not taken: everyone who takes asks before. */
#ifndef TRIANGLE_TEXT_BYTES_H
#define TRIANGLE_TEXT_BYTES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "triangle/base/status.h"

struct tri_bytes {
    char *data;           /* malloc'ed */
    const char *at, *end; /* what has not been taken */
};

/* Reads a file whole; a pipe or device is refused. To be freed in any case. TRI_CANNOT_READ, TRI_NO_MEMORY. */
enum tri_status tri_bytes_load(struct tri_bytes *bytes, const char *path, struct tri_error *error);
void tri_bytes_free(struct tri_bytes *bytes);

static inline uint64_t tri_bytes_left(const struct tri_bytes *bytes) { return (uint64_t)(bytes->end - bytes->at); }

/* Are there n items of that size? */
static inline bool tri_bytes_has(const struct tri_bytes *bytes, uint64_t n, uint64_t size)
{
    return n <= tri_bytes_left(bytes) / size;
}

/* The line that begins here, without its end, and moves behind it; false: there is none. */
bool tri_bytes_line(struct tri_bytes *bytes, const char **line, size_t *length);

/* Moves behind the text, wherever it is next; false: it does not come. */
bool tri_bytes_pass(struct tri_bytes *bytes, const char *text);

/* --- numbers at a place */

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

/* --- numbers that are taken: they are there */

static inline int32_t tri_take_i32(struct tri_bytes *bytes)
{
    bytes->at += 4;
    return tri_get_i32(bytes->at - 4);
}

static inline uint64_t tri_take_u64(struct tri_bytes *bytes)
{
    bytes->at += 8;
    return tri_get_u64(bytes->at - 8);
}

#endif
