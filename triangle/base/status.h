/* Status codes and error detail of every fallible call.
 *
 * Libraries return a status and never print or exit; the detail travels in a caller-owned struct tri_error, which may
 * be NULL where the caller does not care. After TRI_OK the error is untouched. */
#ifndef TRIANGLE_BASE_STATUS_H
#define TRIANGLE_BASE_STATUS_H

#include "ptriangle/tri.h" /* enum tri_status, struct tri_error */

/* Fills *error (unless NULL) from a printf format and returns status, so that failing is one statement. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
enum tri_status tri_fail(struct tri_error *error, enum tri_status status, const char *file, long line,
                         const char *format, ...);

#endif
