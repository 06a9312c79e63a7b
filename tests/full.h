/* Whether a test runs all of its cases (label full), or only as many as fit in half a minute (label fast). */
#ifndef TESTS_FULL_H
#define TESTS_FULL_H

#include <stdbool.h>
#include <stdlib.h>

static inline bool is_full(void) { return getenv("PTRIANGLE_TEST_FULL") != NULL; }

/* The step of a loop over cases: all cases if the label is full, otherwise each n-th. */
static inline int every(int n) { return is_full() ? 1 : n; }

#endif
