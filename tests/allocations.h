/* Allocations that fail when a test requests it.
 *
 * For programs linked with --wrap for malloc, calloc, realloc and free (GNU and LLVM linkers support this). All their
 * calls are counted, and the chosen call fails. Any thread may allocate. */
#ifndef TESTS_ALLOCATIONS_H
#define TESTS_ALLOCATIONS_H

#include <stdatomic.h>
#include <stdint.h>

extern atomic_llong support_calls;      /* number of allocations requested; a test sets it to 0 */
extern atomic_llong support_fail_at;    /* the call that fails, counted from 1; INT64_MAX: none */
extern atomic_bool support_fail_ever_after; /* all later calls fail as well */
extern atomic_llong support_held;       /* blocks allocated and not freed */

#endif
