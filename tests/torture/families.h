/* The families of figures. Each is difficult in its own way. */
#ifndef TESTS_TORTURE_FAMILIES_H
#define TESTS_TORTURE_FAMILIES_H

#include "tests/torture/figure.h"

struct family {
    const char *name;
    void (*make)(struct figure *figure);
    double weight;       /* relative probability of being drawn */
    bool is_near;        /* true: near-degenerate, with details within rounding of each other */
    bool keeps_its_size; /* true: not rotated, rounded or scaled, since its coordinates matter */
};

extern const struct family families_near[], families_shape[], families_map[]; /* each array ends with a NULL name */

int32_t family_count(void);
const struct family *family_at(int32_t i);
const struct family *family_named(const char *name); /* Returns NULL if there is no such family. */

#endif
