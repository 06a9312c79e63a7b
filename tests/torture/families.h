/* The families of figures: each a way to be difficult. */
#ifndef TESTS_TORTURE_FAMILIES_H
#define TESTS_TORTURE_FAMILIES_H

#include "tests/torture/figure.h"

struct family {
    const char *name;
    void (*make)(struct figure *figure);
    double weight;      /* of being drawn */
    bool is_near;       /* near-degenerate: things within rounding of each other */
    bool keeps_its_size; /* not to be rotated, rounded or scaled: its numbers are the point */
};

extern const struct family families_near[], families_shape[], families_map[]; /* each ends with a NULL name */

int32_t family_count(void);
const struct family *family_at(int32_t i);
const struct family *family_named(const char *name); /* NULL: none */

#endif
