/* Status codes and error detail of every fallible call.
 *
 * Libraries return a status and never print or exit; the detail travels in a caller-owned struct tri_error, which may
 * be NULL where the caller does not care. After TRI_OK the error is untouched. */
#ifndef TRIANGLE_STATUS_H
#define TRIANGLE_STATUS_H

#ifdef __cplusplus
extern "C" {
#endif

enum tri_status {
    TRI_OK = 0,
    TRI_NO_MEMORY,    /* an allocation failed; what existed before the call is intact */
    TRI_TOO_LARGE,    /* more than 2^28 vertices or 2^29 triangles in one mesh */
    TRI_BAD_INPUT,    /* the input's content is at fault; the text says what and where */
    TRI_CANNOT_READ,  /* a file cannot be opened or read */
    TRI_CANNOT_WRITE, /* a file cannot be created, written or renamed */
    TRI_NO_ROOM,      /* a view of shared arrays is full; not a failure: make room and call again */
    TRI_INTERNAL,     /* an invariant does not hold: a defect of this library */
    TRI_STOPPED       /* somebody asked for it, see triangle/stop.h */
};

struct tri_error {
    enum tri_status status;
    char file[1024]; /* "" where no file is concerned */
    long line;       /* 1-based; 0 where no line is concerned */
    char text[512];  /* one sentence without file, line or final newline */
};

/* Fills *error (unless NULL) from a printf format and returns status, so that failing is one statement. */
#if defined(__GNUC__)
__attribute__((format(printf, 5, 6)))
#endif
enum tri_status tri_fail(struct tri_error *error, enum tri_status status, const char *file, long line,
                         const char *format, ...);

#ifdef __cplusplus
}
#endif

#endif
