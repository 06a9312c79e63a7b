/* Does a test try all of its cases (label full), or those that half a minute has room for (label fast)? */
#ifndef TESTS_FULL_H
#define TESTS_FULL_H

#include <stdbool.h>
#include <stdlib.h>

static inline bool is_full(void) { return getenv("PTRIANGLE_TEST_FULL") != NULL; }

/* The step of a loop over cases: each of them when full, else each n-th. */
static inline int every(int n) { return is_full() ? 1 : n; }

#endif
