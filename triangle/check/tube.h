/* Subsegments along one line, in order. Private to the judge. */
#ifndef TRIANGLE_CHECK_TUBE_H
#define TRIANGLE_CHECK_TUBE_H

#include "triangle/check/internal.h"

struct check_tube {
    struct tri_point from, to; /* its line; places are distances from the first along it */
    double length;
    int32_t first, last; /* entries first .. last - 1 */
};

/* A subsegment of a tube; it may be in several. */
struct check_tube_entry {
    double low, high, off; /* places of its ends, and their largest distance from the line */
    int32_t subsegment;
    int32_t next, jump, depth; /* see tri_check_tube_span */
    int32_t piece;     /* equal where subsegments of the tube lead from one to the other */
    int32_t onward[2]; /* entry down, up beyond its end if nothing else leaves there nearly along the line; else -1 */
};

/* Entries, of which those between two places are to be taken, each but once. */
struct check_taking {
    int32_t *order; /* [n_entries] tube after tube, those with equal keys in the order of their places */
    double *least;  /* [2 size] a tree: the least high place of what is still there; size: a power of two */
};

struct check_tubes {
    const struct checker *c;
    int32_t n_tubes, tube_capacity, n_entries, entry_capacity, size;
    struct check_tube *tube;
    struct check_tube_entry *entry;
    int32_t *tube_of; /* [n_segments] the first one of each subsegment, -1: none */
    int32_t *of_line; /* [input segments] -1: none; NULL: no tubes are made */
    double *most_off; /* [2 size] a tree */
    struct check_taking any, marked; /* keys of the second: markers as they are given; nothing where they are not */
};

/* What an input segment covers of a tube. */
struct check_span {
    int32_t tube;
    double low, high, margin; /* places of its ends, and what they may be passed by */
};

/* Tubes along the input segments from number `first` on. O(n log n) for n subsegments and input segments. */
enum tri_status tri_check_tubes_make(struct check_tubes *tubes, const struct checker *c, int32_t first);
void tri_check_tubes_free(struct check_tubes *tubes);

/* Is the input segment between these vertices covered by subsegments of a tube, all of them between its ends, and is
 * everything in the tube between these within the tolerance of it, and does some way in the tube lead from end to end
 * (that is known where neither is a hub)? False may also mean: not known. O(log n) mostly. */
bool tri_check_tube_span(const struct check_tubes *tubes, int32_t id, const int32_t *ends, double tolerance,
                         struct check_span *span);

/* Calls take for subsegments between the ends of the span, and with that marker (NULL: any), but not for those that an
 * earlier call with such a span has seen. O(log n) each. */
void tri_check_tube_take(struct check_tubes *tubes, const struct check_span *span, const int32_t *marker,
                         void (*take)(void *user, int32_t subsegment), void *user);

/* The entry by which one goes up (1) or down (0) from a vertex, if there is no other way nearly along the line; -1. */
int32_t tri_check_tube_sole_way(const struct check_tubes *tubes, int32_t tube, int32_t v, int up);

/* Does the second vertex come after the first one along the tube's line? */
bool tri_check_tube_ascends(const struct check_tubes *tubes, int32_t tube, int32_t from, int32_t to);

#endif
