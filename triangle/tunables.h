/* The numbers that decide what a mesh looks like and that no theorem gives: each was measured, or guessed and not found
 * wrong. Whoever changes one changes meshes. Numbers that only decide how fast something is, and bounds on errors,
 * which are derived, stand where they are used. docs/performance-history.md has the measurements.
 *
 * A resolution is a unit in the last place of the larger coordinate of a point (cdt/crossing.h). */
#ifndef TRIANGLE_TUNABLES_H
#define TRIANGLE_TUNABLES_H

/* --- angles, in degrees */

/* Up to about this bound refinement ends in practice (28.6 is proved, with input angles of 60 and more). A larger one
 * is treated as this one; triangles are still counted by the bound that is asked for. */
#define TRI_USUAL_ANGLE 38.0
/* The largest bound with -D. Measured on 235 real inputs: 36 degrees take up to 2.6 times the triangles of 34, 38 up to
 * 22. */
#define TRI_CONFORMING_ANGLE 36.0
/* Above this bound sizes may be refined first, with TRI_SIZES_ANGLE as bound, where areas ask for TRI_SIZES_FIRST times
 * the triangles that angles do. Measured on 19 coasts, parts and figures at 33 to 36 degrees: below twice, meshes made
 * at once have 0.73 to 0.85 times the triangles. */
#define TRI_EASY_ANGLE 31.0
#define TRI_SIZES_ANGLE 25.0
#define TRI_SIZES_FIRST 2.0

/* --- where points go */

/* The point of a triangle that is only too large makes an equilateral one of this share of the bound. Measured: the
 * mean area is 0.663 of the bound; of circumcentres 0.645. */
#define TRI_IDEAL 0.85
/* Height of off-centres over the exact one that sees its edge under the bound, 0.5. Measured: 0.475 makes up to 2% more
 * triangles; at 0.5 rounding makes bad ones, 9% to 110% more. */
#define TRI_OFF_CENTRE 0.499
/* A point of the petal is worth another search if its squared distance is larger by this factor. Guess: rounding. */
#define TRI_PETAL_GAIN (1 + 1e-6)
/* Points in the lens of a subsegment that must not be split keep off it by so many shortest edges (docs/theory.md,
 * protected walls). Guess. */
#define TRI_CLEARANCE 2.0
/* Triangles that are only too large wait in a window of so many, a power of two. Measured: 7.4 M points a second
 * instead of 5.2 M with an endless one; sizes spread as evenly. */
#define TRI_WINDOW (1 << 13)
/* Triangles of the worklist whose bad angles are queued at once. Measured: 2.5 times as fast as all at once; of 2^12
 * meshes are 3% to 12% larger. */
#define TRI_WORKLIST_CHUNK (1 << 16)

/* Points lie in a lattice up to this bound on angles: a point put into a lattice halves an angle of 60 degrees. Measured:
 * at 30.5 the letter of 51,000 triangles gets twice as many. */
#define TRI_LATTICE_ANGLE 30.0
/* By so much the squared sine of an angle may miss the bound there: as much as trianglecheck lets pass. Measured on
 * coast_greenland, 30 degrees: 10,349 triangles; without it 14,423, since an exact half of 60 degrees may be rounded
 * down, and the next point makes another one. */
#define TRI_LATTICE_ROUNDING 1e-12
/* Area of the lattice's triangles over the bound; how far its points keep off vertices and subsegments, in lengths of
 * its edges. Measured on a letter of 1.7 million triangles: between 0.7 and 0.95, and 0.6 and 1.2, the number of
 * triangles changes by 0.4%; below 0.9 off subsegments angles of 30 degrees run away. */
#define TRI_LATTICE_SHARE 0.995
#define TRI_LATTICE_APART 0.8
#define TRI_LATTICE_OFF_WALLS 0.9
/* Features around a lattice point have at most this size, in lengths of its edges. Measured: with 1, soho_ran_away keeps
 * 18 bad triangles, with this 4; coasts and letters stay the same. */
#define TRI_LATTICE_FEATURE 0.25
/* Squared distance of the lattice point from a corner over the squared longest edge: beyond, the triangle is flatter than
 * 172 degrees, and the cavity would be large. Measured: two borders that were drawn twice took minutes without it. */
#define TRI_LATTICE_REACH 16.0
/* Cells are made at once where about so many come; for at most so many sites for each, since rows run across what is
 * no part of the mesh. Guess. */
#define TRI_LATTICE_LEAST 500.0
#define TRI_LATTICE_SPARSE 8.0
/* .. and where no more than this share of the sites is of the rim, which is inserted point by point. Measured: a spiral
 * of lanes five edges wide takes 2.6 s; 5.3 s with a half; 2.1 s without a lattice. */
#define TRI_LATTICE_RIM 0.25
/* Rows and columns from the origin, beyond which rounding would change areas by more than TRI_LATTICE_SHARE leaves;
 * triangles that are walked through to a site that no vertex is near to. Guess. */
#define TRI_LATTICE_FARTHEST 0x1p40
#define TRI_LATTICE_STEPS 100

/* Lengths are kept by triangles with a circumradius of at most TRI_FRONT_ACCEPT of the mean h (0.577: equilateral), and
 * by thin ones (20 degrees: squared sine TRI_FRONT_THIN) with edges of at most TRI_FRONT_LONGEST h. An apex is taken if
 * so much of its height lies below the circumcentre, TRI_FRONT_CUSHION. Measured on a graded coast of 0.56 M triangles:
 * 0.72, 0.76, 0.84, 0.88 to accept, 0.7, 0.75, 0.8, 0.9, 0.95 as cushion give worse triangles, or too many. */
#define TRI_FRONT_ACCEPT 0.8
#define TRI_FRONT_LONGEST 1.4
#define TRI_FRONT_THIN 0.117
#define TRI_FRONT_CUSHION 0.85
/* An apex keeps so many h off all vertices, or the circumcentre is taken: the proof that refinement ends asks for it.
 * Measured: no difference. */
#define TRI_FRONT_APART 0.5

/* --- what is given up */

/* Edges become at most so many times shorter than the features around, for angles. Measured: another value for each
 * bound on angles changes no ordinary mesh. */
#define TRI_SHRINK 6.0
/* How fast the size of features grows with the distance. Guess. */
#define TRI_SLOPE 0.5
/* Shortest edge over the largest coordinate, 32 resolutions; TRI_BLUR times that if more than TRI_FEW_BLURRED vertices
 * have a distance between the two: so many may be two pairs of points. Measured: with 128 for all, drawings lose
 * features; with 32, grids drawn twice get 2.5 times the triangles; with 4 instead of 8, maps keep 1.7 times the bad
 * ones. */
#define TRI_SHORTEST_EDGE 0x1p-47
#define TRI_BLUR 8.0
#define TRI_FEW_BLURRED 4
/* Two segments that meet at less than 1 over this are a spike, and not filled: a quarter of a degree. Guess. */
#define TRI_SHARP 256.0
/* Spaces between segments that take no more than 2^TRI_CHEAP_GAP points are filled in any case; all are, if they take
 * TRI_ALL_GAPS points together; else those that fit TRI_GAP_ALLOWANCE points and TRI_GAP_PER_VERTEX for each vertex.
 * Measured: with one constant instead overlaid maps get up to 97 times the triangles. */
#define TRI_CHEAP_GAP 10
#define TRI_ALL_GAPS 250000.0
#define TRI_GAP_ALLOWANCE 20000.0
#define TRI_GAP_PER_VERTEX 4.0
/* -D: a vertex is level with a place if it lies nearer than the subsegment's length over this, which is also the most
 * parts into which a subsegment is cut because of rounding (split.c). Measured: without the rule an overlaid map has 18
 * times the triangles. */
#define TRI_NARROW 8

/* --- segments and rounding, in resolutions */

/* A vertex so near to a segment is on it. Half a unit is what coordinates tell. */
#define TRI_ON_SEGMENT 0.5
/* A new crossing keeps so far from other vertices, and a stop of a bundle from the one before it. Guess. */
#define TRI_VERTICES_APART 2.0
/* Pieces of an input segment lie within this of its line; those shared with another one within TRI_BESIDE. Guess. */
#define TRI_SEGMENT_ASTRAY 8
#define TRI_BESIDE 3
/* A split point lies within this of its segment's line. Measured: of 200 bundles 1,624 instead of 2,201 circles that
 * are not empty, with 2. */
#define TRI_SPLIT_ASTRAY 4.0
/* Follows from it: a vertex of a mesh that is read lies on a chain of subsegments within this of its line. */
#define TRI_CHAIN_ASTRAY (2 * TRI_SPLIT_ASTRAY)
/* A carrier of a bundle stops at vertices so near to its line (bundle.h). Measured on overlaid maps: without, up to 2.5
 * times the bad triangles at small angles. */
#define TRI_BUNDLE_ALONG 1.25

/* --- estimates */

/* Mean area over bound, and a share that no mesh has. Measured: 0.63 to 0.67; in a lattice 0.90 of 33,000 triangles,
 * 0.97 of 3.4 million. */
#define TRI_LATTICE_MEAN 0.94
#define TRI_MEAN_OVER_BOUND 0.655
#define TRI_MOST_OVER_BOUND 0.75
/* A bad triangle, and each octave between its shortest edge and its longest, makes so many. Guess. */
#define TRI_BAD_WORK 1.25
/* What angles ask for is found in all of so many triangles, in a quarter of more, in at most so many. Measured: coasts
 * take 6% to 8% less time than with a rougher estimate of each triangle. */
#define TRI_FEWEST_SAMPLED (1 << 10)
#define TRI_MOST_SAMPLED (1 << 14)
/* The caller's functions are asked in so many pieces of the figure at least; a piece that asks for few triangles is not
 * divided. Guess. */
#define TRI_WISH_PIECES (1 << 12)
#define TRI_WISH_FEW 256
/* Triangles for angles (crowd.h): growth of h over distance, triangles for an octave and for a gap, and
 * TRI_FINENESS / (TRI_NEVER - angle) for each of the squares that features impose; once more where sizes come first.
 * Fitted to 19 coasts, parts, maps and point sets at 20 to 36 degrees, without areas and with two area bounds each. */
#define TRI_CROWD_SLOPE 0.35
#define TRI_AN_OCTAVE 0.4
#define TRI_A_GAP 4.0
#define TRI_FINENESS 7.1
#define TRI_NEVER 42.5
#define TRI_AGAIN 1.5
#define TRI_NEVER_AGAIN 39.0

/* --- smooth.c. Measured on a coast with sizes growing by 0.15: one pass raises the mean q from 0.956 to 0.977, a second
 * one to 0.979. */

#define TRI_SMOOTH_FINE 0.985 /* a vertex whose triangles all have at least this q stays: nothing is gained */
#define TRI_SMOOTH_GAIN 1e-5  /* of the sum of 1 / q that a move must bring */
#define TRI_SMOOTH_GOOD 0.7   /* the worst q may get lower as long as it is above this: no angle is below 24 degrees */
#define TRI_SMOOTH_LEAST 0.05 /* no triangle flatter than this is made, whatever else gets better */

#endif
