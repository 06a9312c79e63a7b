/* Allocations that fail when a test wants them to.
 *
 * For programs linked with --wrap for malloc, calloc, realloc and free (the GNU and LLVM linkers know it): all their
 * calls are counted, and the chosen one fails. Any thread may call. */
#ifndef TESTS_ALLOCATIONS_H
#define TESTS_ALLOCATIONS_H

#include <stdatomic.h>
#include <stdint.h>

extern atomic_llong support_calls;      /* allocations asked for; a test sets it to 0 */
extern atomic_llong support_fail_at;    /* the call that fails, counted from 1; INT64_MAX: none */
extern atomic_bool support_fail_ever_after; /* all later calls fail too */
extern atomic_llong support_held;       /* blocks allocated and not freed */

#endif
