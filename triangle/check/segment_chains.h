/* Input segments as chains of subsegments. Private to the checker. */
#ifndef TRIANGLE_CHECK_SEGMENT_CHAINS_H
#define TRIANGLE_CHECK_SEGMENT_CHAINS_H

#include "triangle/check/internal.h"

/* Looks for a chain for each input segment, asks the sweep about the missing pieces, and compares markers. Needs
 * c->twin, c->fan, c->tolerance. O(log n) a subsegment and input segment on the whole, unless many of these overlap and
 * are incomplete, or as far off each other as the tolerance is. */
enum tri_status tri_check_chains(struct checker *c);

#endif
