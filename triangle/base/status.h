/* Status codes and error detail of every fallible call; and how work is asked to end early.
 *
 * Libraries return a status and never print or exit; the detail travels in a caller-owned struct tri_error, which may
 * be NULL where the caller does not care. After TRI_OK the error is untouched. */
#ifndef TRIANGLE_BASE_STATUS_H
#define TRIANGLE_BASE_STATUS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "ptriangle/tri.h" /* enum tri_status, struct tri_error */

/* Fills *error (unless NULL) from a printf format and returns status, so that failing is one statement. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
enum tri_status tri_fail(struct tri_error *error, enum tri_status status, const char *file, int64_t line,
                         const char *format, ...);

/* The same with the system's words for error_number, an errno, behind `what`. */
enum tri_status tri_fail_system(struct tri_error *error, enum tri_status status, const char *file, const char *what,
                                int error_number);

/* --- ending work early because somebody asks for it: a signal, a time limit, a button
 *
 * Whatever is worked on for long - a mesh, a text, a set of outputs - knows whom to ask; the work asks every few
 * thousand steps, from any of its threads, and returns TRI_STOPPED once the answer was yes. */

struct tri_stop {
    /* Is the work to end? Called often and from several threads at once: it should do no more than look at a flag. Once
     * true, it stays true. */
    bool (*is_asked)(void *user);
    void *user;
};

/* NULL: never. */
static inline bool tri_stop_is_asked(const struct tri_stop *stop) { return stop && stop->is_asked(stop->user); }

enum { TRI_STOP_STEPS = 1024 };

/* For loops of short steps: asks at the first of them and then once in TRI_STOP_STEPS. *step counts them, from 0. */
static inline bool tri_stop_is_due(const struct tri_stop *stop, uint32_t *step)
{
    return (*step)++ % TRI_STOP_STEPS == 0 && tri_stop_is_asked(stop);
}

/* TRI_STOPPED, with words for it. */
static inline enum tri_status tri_fail_stopped(struct tri_error *error)
{
    return tri_fail(error, TRI_STOPPED, NULL, 0, "stopped before the work was done");
}

#endif
