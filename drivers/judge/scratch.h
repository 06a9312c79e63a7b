/* Rows of numbers in memory, or in a nameless file: written once from the first to the last, then read in slices. The
 * file goes with the process, however that ends. */
#ifndef DRIVERS_JUDGE_SCRATCH_H
#define DRIVERS_JUDGE_SCRATCH_H

#include <stddef.h>
#include <stdint.h>

#include "triangle/base/status.h"

struct scratch {
    int file;     /* -1: in memory */
    size_t width; /* bytes of a row; 0: not open */
    int64_t n;    /* rows */
    char *bytes;  /* [room] in memory */
    int64_t room;
};

/* In that folder; NULL: in memory. TRI_CANNOT_WRITE. */
enum tri_status scratch_open(struct scratch *scratch, const char *folder, size_t width, struct tri_error *error);

/* Any number of times. Rows go to the end. TRI_CANNOT_WRITE; TRI_NO_MEMORY. */
enum tri_status scratch_append(struct scratch *scratch, const void *rows, int64_t n, struct tri_error *error);

/* TRI_CANNOT_READ. */
enum tri_status scratch_read(const struct scratch *scratch, int64_t first, int64_t n, void *rows,
                             struct tri_error *error);

void scratch_close(struct scratch *scratch);

#endif
