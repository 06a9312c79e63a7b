/* Status codes and error details of all calls that can fail, and requests to stop work early.
 *
 * Library functions return a status and never print or exit. The details go into a struct tri_error of the caller,
 * which may be NULL if the caller does not need them. A call that returns TRI_OK leaves the error unchanged. */
#ifndef TRIANGLE_BASE_STATUS_H
#define TRIANGLE_BASE_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ptriangle/tri.h" /* enum tri_status, struct tri_error */

/* Fills *error (unless NULL) from a printf format and returns status, so that `return tri_fail(...)` reports a
 * failure. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
enum tri_status tri_fail(struct tri_error *error, enum tri_status status, const char *file, int64_t line,
                         const char *format, ...);

/* The same, followed by the system's text for error_number, an errno. */
enum tri_status tri_fail_system(struct tri_error *error, enum tri_status status, const char *file, const char *what,
                                int error_number);

/* --- stopping work early because of a signal, a time limit or a button
 *
 * Objects on which work can take long (a mesh, a text, a set of outputs) have a pointer to a struct tri_stop. The work
 * calls is_asked every few thousand steps, from any of its threads, and returns TRI_STOPPED once the answer is true. */

struct tri_stop {
    /* Returns true if the work should stop. Called often and from several threads at once, so it should only read a
     * flag. Once it has returned true, it must keep returning true. */
    bool (*is_asked)(void *user);
    void *user; /* argument of is_asked */
};

/* NULL: never stops */
static inline bool tri_stop_is_asked(const struct tri_stop *stop) { return stop && stop->is_asked(stop->user); }

enum { TRI_STOP_STEPS = 1024 };

/* For loops of short steps: asks at the first step and then once every TRI_STOP_STEPS. *step counts them from 0. */
static inline bool tri_stop_is_due(const struct tri_stop *stop, uint32_t *step)
{
    return (*step)++ % TRI_STOP_STEPS == 0 && tri_stop_is_asked(stop);
}

/* Returns TRI_STOPPED and fills *error with its message. */
static inline enum tri_status tri_fail_stopped(struct tri_error *error)
{
    return tri_fail(error, TRI_STOPPED, NULL, 0, "stopped before the work was done");
}

#endif
