/* Reads the input of a fuzz target as a stream of small choices. After its end, all choices are 0. */
#ifndef TESTS_FUZZ_BYTES_H
#define TESTS_FUZZ_BYTES_H

#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

struct bytes {
    const uint8_t *at, *end;
};

static inline uint8_t bytes_one(struct bytes *b) { return b->at < b->end ? *b->at++ : 0; }
static inline int32_t bytes_below(struct bytes *b, int32_t n) { return bytes_one(b) % n; }

static inline double bytes_double(struct bytes *b)
{
    uint64_t bits = 0;
    for (int i = 0; i < 8; i++)
        bits = bits << 8 | bytes_one(b);
    double x;
    memcpy(&x, &bits, sizeof x);
    return x;
}

/* A coordinate: a small integer, a number with one decimal, a number within some ulps of such a number, or any double,
 * including infinities and NaN. */
static inline double bytes_coordinate(struct bytes *b, int32_t mode)
{
    switch (mode) {
    case 0: return bytes_below(b, 8);
    case 1: return (int8_t)bytes_one(b) / 10.0;
    case 2: {
        double x = (int8_t)bytes_one(b) / 10.0;
        return x + (int8_t)bytes_one(b) * 0x1p-52;
    }
    default: return bytes_double(b);
    }
}

static inline double bytes_finite(struct bytes *b, int32_t mode)
{
    double x = bytes_coordinate(b, mode);
    return isfinite(x) ? x : 0;
}

#endif
