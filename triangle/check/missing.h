/* Pieces of input segments that the mesh has no edges for. Private to the judge. */
#ifndef TRIANGLE_CHECK_MISSING_H
#define TRIANGLE_CHECK_MISSING_H

#include "triangle/check/internal.h"

struct check_pieces {
    int32_t n;
    struct check_piece *at; /* [n] to be freed */
};

/* Brings c->missing into order, from left to right, and drops pieces that are there already. */
void tri_check_sort_missing(struct checker *c);

/* c->missing, in order, cut wherever pieces meet: they share nothing then but end points, up to rounding. None where
 * that would take too long, or too much memory. About n sqrt(n) steps where they are short and apart. */
enum tri_status tri_check_split_missing(const struct checker *c, struct check_pieces *pieces);

#endif
