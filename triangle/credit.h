/* What points for angles above TRI_PROMISED_ANGLE may cost.
 *
 * A point is on credit if it is inserted, or a subsegment split, for the angle of a triangle that is no smaller than
 * TRI_PROMISED_ANGLE, or whose shortest edge has an end that is on credit itself. The others are the features of the
 * input, what sizes ask for, and what refinement for TRI_PROMISED_ANGLE inserts among these: their insertion radii
 * come from each other's alone, so that they are as far apart as theory promises for that angle (Shewchuk 2002),
 * whatever lies between them. Under -D a vertex of a subsegment whose circle is not empty is on credit if that is so
 * for an end of it or a vertex beside it; that split is not paid for, since it must be made.
 *
 * RULE. Triangles smaller than TRI_PROMISED_ANGLE are always refined. Those that are no smaller are refined while there
 * is credit: each point that is not on credit grants TRI_CREDIT points, each on credit takes one, whatever it is for;
 * and each call grants TRI_ALLOWANCE more, which is what a small figure whose features differ by twelve orders of
 * magnitude takes for 34 degrees.
 *
 * THEOREM. For triangles that are no smaller than TRI_PROMISED_ANGLE a call inserts no more than TRI_ALLOWANCE points,
 * and TRI_CREDIT for each point that it inserts otherwise, and for each vertex that it finds and that is not on credit;
 * those count as often as a sixth of the triangles in its worklist that have them for a corner, which is once on
 * average, and within a fence once, and once more where the call has inserted it. Proof: it counts them. What comes of
 * these points in triangles smaller than TRI_PROMISED_ANGLE is what theory promises for a figure with these vertices:
 * about as many again (measured).
 *
 * SCHEDULES. Those on credit grant nothing, so it does not matter that they grow in number from phase to phase; and a
 * vertex lies in one block of each phase. So a schedule of b blocks in p phases inserts for such triangles no more than
 * b times TRI_ALLOWANCE, and p + 1 times TRI_CREDIT for each vertex that is not on credit. That is in proportion to the
 * mesh that theory promises where blocks are as large as was estimated: up to four cells of 8,192 triangles and more,
 * against 1,000 points. Measured at 34 degrees, 105 figures: blocks without an allowance make 0.07% fewer triangles, in
 * cells of 1,000, 250 and 60 triangles 0.3, 0.7 and 1%, and leave more of these below the bound. What seams would add
 * is kept low by refine.c (SEAMS).
 */
#ifndef TRIANGLE_CREDIT_H
#define TRIANGLE_CREDIT_H

#include <math.h>

#include "triangle/entry_set.h"
#include "triangle/mesh.h"

/* In degrees: up to here theory promises that refinement ends, where no segments meet at small angles. */
#define TRI_PROMISED_ANGLE 28.0

enum { TRI_CREDIT = 9, TRI_ALLOWANCE = 1000 };

struct tri_credit {
    int64_t granted, paid;    /* in sixths of a point */
    struct tri_entry_set met; /* within a fence: vertices that have granted theirs, as entries of life 0 */
};

static inline bool tri_is_on_credit(const struct tri_mesh *mesh, tri_vertex_id v) { return signbit(mesh->feature[v]); }

/* A point has been inserted. */
static inline void tri_count_credit(struct tri_credit *credit, bool on_credit)
{
    if (on_credit)
        credit->paid += 6;
    else
        credit->granted += INT64_C(6) * TRI_CREDIT;
}

/* What the corners of a triangle grant: in the worklist of a call without a fence; when it asks within one, which is
 * O(1), amortised. False: no memory. */
void tri_list_corners(struct tri_credit *credit, const struct tri_mesh *mesh, const tri_vertex_id corner[3]);
bool tri_meet_corners(struct tri_credit *credit, const struct tri_mesh *mesh, const tri_vertex_id corner[3]);

/* Is there credit for a point in a triangle that is no smaller than TRI_PROMISED_ANGLE? */
static inline bool tri_has_credit(const struct tri_credit *credit) { return credit->paid < credit->granted; }

void tri_credit_free(struct tri_credit *credit);

#endif
