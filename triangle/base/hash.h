/* A hash of bytes. */
#ifndef TRIANGLE_BASE_HASH_H
#define TRIANGLE_BASE_HASH_H

#include <stddef.h>
#include <stdint.h>
#include <string.h>

static inline uint64_t tri_mix(uint64_t hash, uint64_t word)
{
    hash = (hash ^ word) * UINT64_C(0x9E3779B97F4A7C15);
    return hash ^ hash >> 29;
}

/* Returns the hash of n bytes, continuing from `hash` (0 at the start). The result depends on how the bytes are divided
 * among calls. It detects damage and does not resist attackers. Four words at a time go into separate hashes, so that
 * no multiplication waits for another. */
static inline uint64_t tri_hash(uint64_t hash, const void *bytes, size_t n)
{
    enum { LANES = 4 };
    const char *at = bytes;
    uint64_t lane[LANES] = {hash, 1, 2, 3}, word[LANES];
    if (n >= sizeof word) {
        for (; n >= sizeof word; n -= sizeof word, at += sizeof word) {
            memcpy(word, at, sizeof word);
            for (int k = 0; k < LANES; k++)
                lane[k] = tri_mix(lane[k], word[k]);
        }
        hash = tri_mix(tri_mix(tri_mix(lane[0], lane[1]), lane[2]), lane[3]);
    }
    for (; n > 0; n -= n < 8 ? n : 8, at += 8) {
        word[0] = n < 8 ? n : 0;
        memcpy(word, at, n < 8 ? n : 8);
        hash = tri_mix(hash, word[0]);
    }
    return hash;
}

#endif
