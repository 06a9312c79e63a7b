/* Subsegments in straight lines. Private to the judge. */
#ifndef TRIANGLE_CHECK_LINE_H
#define TRIANGLE_CHECK_LINE_H

#include "triangle/check/internal.h"

/* From an end of a subsegment to the other one is upwards if that comes later by x, then y. */
struct check_lines {
    const struct checker *c;
    int32_t *place;   /* [n_segments] of each subsegment in `at` */
    int32_t *at;      /* [n_segments] subsegments, line after line, upwards */
    int32_t *line_of; /* [n_segments] line of each place */
    int32_t *begin;   /* [n_lines + 1] places */
    int32_t n_lines;
    int32_t *forks;   /* [n_segments + 1] subsegments in lower places where another one leaves nearly along the line */
};

/* Places first .. last - 1 of a line; first < 0: none. */
struct check_stretch {
    int32_t first, last;
};

enum tri_status tri_check_lines_make(struct check_lines *lines, const struct checker *c);
void tri_check_lines_free(struct check_lines *lines);

/* The stretch of one line from vertex a to vertex b, if there is one without forks. O(log n). */
struct check_stretch tri_check_stretch(const struct check_lines *lines, int32_t a, int32_t b);

#endif
