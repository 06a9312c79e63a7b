/* What points for angles above TRI_PROMISED_ANGLE may cost.
 *
 * A point is on credit if it is inserted, or a subsegment split, for the angle of a triangle that is no smaller than
 * TRI_PROMISED_ANGLE, or whose shortest edge has an end that is on credit itself. The others are the features of the
 * input, what sizes ask for, and what refinement for TRI_PROMISED_ANGLE inserts among these: their insertion radii
 * come from each other's alone, so that they are as far apart as theory promises for that angle (Shewchuk 2002),
 * whatever lies between them. Under -D a vertex of a subsegment whose circle is not empty is on credit if that is so
 * for an end of it or a vertex beside it; that split is not paid for, since it must be made.
 *
 * RULE. Each point that is not on credit grants TRI_CREDIT points, each on credit takes one, whatever it is for; and
 * each call grants TRI_ALLOWANCE more, which is what a small figure whose features differ by twelve orders of magnitude
 * takes for 34 degrees; within a fence TRI_BLOCK_ALLOWANCE, as there are many such calls. Triangles that are no smaller
 * than TRI_PROMISED_ANGLE are refined while no more is taken than granted. Smaller ones that must be on credit come of
 * such points: they are refined until three times that is taken, those smaller than TRI_POOR_ANGLE until four times is.
 * Smaller ones that need not be on credit are always refined.
 *
 * THEOREM. A call inserts for angles no more points on credit than four times: its allowance, and TRI_CREDIT for each
 * point that it inserts otherwise, and for each vertex that it finds and that is not on credit; those count, in all, as
 * often as a third of the triangles in its worklist that ask and have them for a corner, but no more than a sixth of
 * all that have, which is once on average; and within a fence once, and once more where the call has inserted it.
 * Proof: it counts them. So up to 34 degrees (TRI_USUAL_ANGLE), without -D, one call makes no more than 8 TRI_ALLOWANCE
 * + (2 + 8 TRI_CREDIT) n triangles of a figure, n being the vertices that are not on credit.
 *
 * CLAIMS. What comes of points on credit in smaller triangles need not be in proportion to them: where one of them
 * splits a subsegment, features may lie beside it that are ever finer towards a place, and to grade that takes 60
 * points for each factor of two at 34 degrees. (Two segments that end an ulp apart, in a turned grid, when such gaps
 * were features yet: 448 points for triangles of 28 degrees and more, 2,408 for smaller ones.) Elsewhere the claims
 * were never reached, on 197 figures at 30 to 34 degrees; random ones whose meshes were more than three times those at
 * 28 took up to 1.2 of what is granted. But points on credit may also stand where others would be needed for 28
 * degrees, and must be followed by as many: a star of 14 spikes that meet in a hub has 9,437 triangles at 33 degrees,
 * 1,498 of them bad, without limits, 9,174 and 1,553 with these claims, and 5,400 and 2,228 with claims of 4/3 and 3/2.
 * The last quarter is for TRI_POOR_ANGLE: with one claim for all angles more of them stayed below it.
 *
 * READ MESHES. A file does not say which vertices were on credit when the mesh was made: all that are read may grant,
 * and what had been left for want of credit would be refined each time that the mesh is read. But such a mesh is good
 * elsewhere, and one that is read for the sake of a larger angle is not: of one made for 20 degrees more than half of
 * the triangles ask at 33. So they grant for those that ask, as nearly all triangles of an input do. (127 figures of
 * narrow spaces made at 33 degrees and read once and twice: 1.14 and 1.22 times the triangles before, 1.05 and 1.10
 * now; made at 20 and read for 33: the same meshes.)
 *
 * SCHEDULES. Those on credit grant nothing, so it does not matter that they grow in number from phase to phase; and a
 * vertex lies in one block of each phase. So a schedule of b blocks in p phases inserts no more of them than four
 * times: b times TRI_BLOCK_ALLOWANCE, and p + 1 times TRI_CREDIT for each vertex that is not on credit. That is in
 * proportion to the mesh that theory promises where blocks are as large as was estimated: up to four cells of 8,192
 * triangles and more, against 200 points. Measured at 34 degrees with and without -D, 192 figures: with an allowance of
 * 1,000 in blocks no mesh differs; in cells of 250 triangles 15 of 382 do, with 0.7% more triangles in all and 2% fewer
 * below the bound; but circles that share arcs up to rounding, in cells of 100 triangles, take 25,071 instead of 9,865
 * (374 at 28 degrees).
 */
#ifndef TRIANGLE_CREDIT_H
#define TRIANGLE_CREDIT_H

#include <math.h>

#include "triangle/entry_set.h"
#include "triangle/mesh.h"

/* In degrees: up to here theory promises that refinement ends, where no segments meet at small angles. */
#define TRI_PROMISED_ANGLE 28.0
/* And up to here for any input without small angles (Ruppert 1995). */
#define TRI_POOR_ANGLE 20.7

enum { TRI_CREDIT = 9, TRI_ALLOWANCE = 1000, TRI_BLOCK_ALLOWANCE = 200 };

/* So many sixths of what is granted may be taken before a triangle is left: by its angle. */
enum tri_claim { TRI_CLAIM_NEARLY_GOOD = 6, TRI_CLAIM_FAIR = 18, TRI_CLAIM_POOR = 24 };

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

/* Corners of triangles, of those that are not on credit: a sixth of a vertex each. */
struct tri_grantors {
    int64_t all, asking; /* those of triangles that ask for a point because of their angle */
};

/* Counts the corners of a triangle of the worklist of a call without a fence, as it begins. */
void tri_list_corners(struct tri_grantors *grantors, const struct tri_mesh *mesh, const tri_vertex_id corner[3],
                      bool asks);

/* They grant what all of them would if half of the triangles ask, and less in proportion if fewer do. */
void tri_grant(struct tri_credit *credit, const struct tri_grantors *grantors);

/* What the corners of a triangle that asks within a fence grant; O(1), amortised. False: no memory. */
bool tri_meet_corners(struct tri_credit *credit, const struct tri_mesh *mesh, const tri_vertex_id corner[3]);

/* Is there credit for a point in such a triangle? */
static inline bool tri_has_credit(const struct tri_credit *credit, enum tri_claim claim)
{
    return 6 * credit->paid < (int64_t)claim * credit->granted;
}

void tri_credit_free(struct tri_credit *credit);

#endif
