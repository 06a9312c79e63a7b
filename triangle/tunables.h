/* The constants that influence meshes and that no theorem determines. Each has been measured, or is a guess that has
 * caused no known problem. If you change one, meshes change. Constants that only affect speed, and error bounds, which
 * are derived, are defined in the files that use them. docs/performance-history.md has the measurements.
 *
 * A resolution is one unit in the last place of the larger coordinate of a point (cdt/crossing.h). */
#ifndef TRIANGLE_TUNABLES_H
#define TRIANGLE_TUNABLES_H

/* --- angles, in degrees */

/* Refinement ends in practice for bounds up to about this one (proved: 28.6, for input angles of at least 60). A larger
 * bound is treated as this one, but triangles are still counted by the requested bound. */
#define TRI_USUAL_ANGLE 38.0
/* The largest bound with -D. Measured on 235 real inputs: 36 degrees need up to 2.6 times the triangles of 34 degrees,
 * and 38 degrees up to 22 times. */
#define TRI_CONFORMING_ANGLE 36.0
/* Above this bound, the mesh is first refined for sizes with the bound TRI_SIZES_ANGLE, if areas need at least
 * TRI_SIZES_FIRST times as many triangles as angles. Measured on 19 coasts, parts and figures at 33 to 36 degrees:
 * below a factor of two, meshes made in one step have 0.73 to 0.85 times the triangles. */
#define TRI_EASY_ANGLE 31.0
#define TRI_SIZES_ANGLE 25.0
#define TRI_SIZES_FIRST 2.0

/* --- where points go */

/* The new point for a triangle that is only too large makes an equilateral triangle with this share of the area bound.
 * Measured: the mean area is 0.663 of the bound; with circumcentres it is 0.645. */
#define TRI_IDEAL 0.85
/* Height of an off-centre. At 0.5, its edge is seen exactly under the angle bound. Measured: 0.475 makes up to 2% more
 * triangles. At 0.5 rounding makes bad triangles, and 9% to 110% more of them in total. */
#define TRI_OFF_CENTRE 0.499
/* Another cavity is searched for a point of the petal if its squared distance is larger by this factor. Guess, to cover
 * rounding. */
#define TRI_PETAL_GAIN (1 + 1e-6)
/* Points in the lens of a subsegment that must not be split have at least this distance from it, in shortest edges
 * (docs/theory.md, protected walls). Guess. */
#define TRI_CLEARANCE 2.0
/* Size of the window of the queue in which triangles that are only too large wait; a power of two. Measured: 7.4 M
 * points a second instead of 5.2 M with an unlimited window; sizes are spread as evenly. */
#define TRI_WINDOW (1 << 13)
/* Number of triangles of the worklist whose bad angles are queued at a time. Measured: 2.5 times as fast as queueing
 * all at once. With 2^12, meshes are 3% to 12% larger. */
#define TRI_WORKLIST_CHUNK (1 << 16)

/* Points are placed on a lattice up to this angle bound, because a point inserted into a lattice halves an angle of 60
 * degrees. Measured: at 30.5 the letter with 51,000 triangles gets twice as many. */
#define TRI_LATTICE_ANGLE 30.0
/* Tolerance for the squared sine of an angle at this bound; trianglecheck allows the same. An exact half of 60 degrees
 * may be rounded down, and the next point would make another such angle. Measured on coast_greenland at 30 degrees:
 * 10,349 triangles, without the tolerance 14,423. */
#define TRI_LATTICE_ROUNDING 1e-12
/* Area of lattice triangles over the area bound; minimum distance of lattice points from vertices and from subsegments,
 * in lattice edges. Measured on a letter of 1.7 million triangles: distances from 0.7 to 0.95 and from 0.6 to 1.2
 * change the number of triangles by 0.4%. With less than 0.9 from subsegments, refinement to 30 degrees may not end. */
#define TRI_LATTICE_SHARE 0.995
#define TRI_LATTICE_APART 0.8
#define TRI_LATTICE_OFF_WALLS 0.9
/* The size of features around a lattice point is at most this, in lattice edges. Measured: with 1, soho_ran_away keeps
 * 18 bad triangles, with 0.25 it keeps 4. Coasts and letters are unchanged. */
#define TRI_LATTICE_FEATURE 0.25
/* Maximum squared distance of a lattice point from a corner, divided by the squared longest edge. Beyond it the
 * triangle is flatter than 172 degrees and the cavity would be large. Measured: without it, two borders that were drawn
 * twice take minutes. */
#define TRI_LATTICE_REACH 16.0
/* Whole cells of the lattice are inserted if at least about TRI_LATTICE_LEAST cells are expected, with at most
 * TRI_LATTICE_SPARSE sites for each cell, because rows also cross areas outside the mesh. Guess. */
#define TRI_LATTICE_LEAST 500.0
#define TRI_LATTICE_SPARSE 8.0
/* ... and if at most this share of the sites is in the rim, which is inserted point by point. Measured: a spiral of
 * lanes five edges wide takes 2.6 s; with a share of one half 5.3 s; without a lattice 2.1 s. */
#define TRI_LATTICE_RIM 0.25
/* Largest row or column number from the origin; beyond it, rounding would change areas by more than TRI_LATTICE_SHARE
 * allows. Then the largest number of triangles that are walked through to a site without a vertex nearby. Guess. */
#define TRI_LATTICE_FARTHEST 0x1p40
#define TRI_LATTICE_STEPS 100

/* A triangle has the given lengths if its circumradius is at most TRI_FRONT_ACCEPT times the mean h (0.577:
 * equilateral). A thin triangle (below 20 degrees: squared sine TRI_FRONT_THIN) has them if its edges are at most
 * TRI_FRONT_LONGEST times h. An apex is used if at least the share TRI_FRONT_CUSHION of its height lies below the
 * circumcentre. Measured on a graded coast of 0.56 M triangles: TRI_FRONT_ACCEPT 0.72, 0.76, 0.84, 0.88 and
 * TRI_FRONT_CUSHION 0.7, 0.75, 0.8, 0.9, 0.95 give worse triangles, or too many. */
#define TRI_FRONT_ACCEPT 0.8
#define TRI_FRONT_LONGEST 1.4
#define TRI_FRONT_THIN 0.117
#define TRI_FRONT_CUSHION 0.85
/* Minimum distance of an apex from all vertices, in h. If it is less, the circumcentre is used, as the proof of
 * termination requires. Measured: no difference. */
#define TRI_FRONT_APART 0.5

/* --- triangles that are given up */

/* To improve angles, edges become at most this many times shorter than the features around them. Measured: a different
 * value for each angle bound changes no ordinary mesh. */
#define TRI_SHRINK 6.0
/* How fast the size of features grows with distance. Guess. */
#define TRI_SLOPE 0.5
/* Shortest edge over the largest coordinate: 32 resolutions. It is multiplied by TRI_BLUR if more than TRI_FEW_BLURRED
 * vertices have a neighbour at a distance between the two lengths; up to four vertices may be two separate pairs of
 * points. Measured: with 128 resolutions for all inputs, drawings lose features. With 32, grids drawn twice get 2.5
 * times the triangles. With 4 instead of 8 as TRI_BLUR, maps keep 1.7 times as many bad triangles. */
#define TRI_SHORTEST_EDGE 0x1p-47
#define TRI_BLUR 8.0
#define TRI_FEW_BLURRED 4
/* Two segments that meet at an angle below 1 / TRI_SHARP (a quarter of a degree) are a spike, which is not filled.
 * Guess. */
#define TRI_SHARP 256.0
/* A space between segments is always filled if this takes at most 2^TRI_CHEAP_GAP points. All spaces are filled if they
 * take at most TRI_ALL_GAPS points together. Otherwise only as many are filled as fit into TRI_GAP_ALLOWANCE points,
 * plus TRI_GAP_PER_VERTEX for each vertex. Measured: with a single constant, overlaid maps get up to 97 times the
 * triangles. */
#define TRI_CHEAP_GAP 10
#define TRI_ALL_GAPS 250000.0
#define TRI_GAP_ALLOWANCE 20000.0
#define TRI_GAP_PER_VERTEX 4.0
/* With -D: a subsegment may be split level with a vertex whose distance is below the subsegment's length over this
 * number. It is also the largest number of parts into which a subsegment is cut because of rounding (split.c).
 * Measured: without level splits an overlaid map gets 18 times the triangles. */
#define TRI_NARROW 8

/* --- segments and rounding, in resolutions */

/* A vertex at most this far from a segment is on it. Coordinates cannot resolve less than half a unit. */
#define TRI_ON_SEGMENT 0.5
/* Minimum distance of a new crossing from other vertices, and between two consecutive stops of a bundle. Guess. */
#define TRI_VERTICES_APART 2.0
/* Maximum distance of the pieces of an input segment from its line. For pieces shared with another segment it is
 * TRI_BESIDE. Guess. */
#define TRI_SEGMENT_ASTRAY 8
#define TRI_BESIDE 3
/* Maximum distance of a split point from the line of its segment. Measured: with 2 instead, 200 bundles have 1,624
 * circles that are not empty instead of 2,201. */
#define TRI_SPLIT_ASTRAY 4.0
/* Follows from TRI_SPLIT_ASTRAY: maximum distance of a vertex on a chain of subsegments from the chain's line, in a
 * mesh that is read. */
#define TRI_CHAIN_ASTRAY (2 * TRI_SPLIT_ASTRAY)
/* A carrier of a bundle stops at vertices at most this far from its line (bundle.h). Measured on overlaid maps: without
 * this, up to 2.5 times as many bad triangles at small angles. */
#define TRI_BUNDLE_ALONG 1.25

/* --- estimates */

/* Mean area over area bound, in a lattice and elsewhere, and a value that no mesh reaches. Measured: 0.63 to 0.67
 * elsewhere; in a lattice 0.90 with 33,000 triangles and 0.97 with 3.4 million. */
#define TRI_LATTICE_MEAN 0.94
#define TRI_MEAN_OVER_BOUND 0.655
#define TRI_MOST_OVER_BOUND 0.75
/* Number of triangles expected for a bad triangle, and again for each octave between its shortest and its longest edge.
 * Guess. */
#define TRI_BAD_WORK 1.25
/* The triangles that angles require are estimated from samples: all triangles of up to TRI_FEWEST_SAMPLED, a quarter of
 * more, at most TRI_MOST_SAMPLED. Measured: coasts take 6% to 8% less time than with a rougher estimate of every
 * triangle. */
#define TRI_FEWEST_SAMPLED (1 << 10)
#define TRI_MOST_SAMPLED (1 << 14)
/* Functions of the caller are evaluated in at least TRI_WISH_PIECES pieces of the figure. A piece that needs at most
 * TRI_WISH_FEW triangles is not divided. Guess. */
#define TRI_WISH_PIECES (1 << 12)
#define TRI_WISH_FEW 256
/* Number of triangles that angles require (crowd.h): growth of h with distance; triangles for an octave and for a gap;
 * and TRI_FINENESS / (TRI_NEVER - angle) for each square that features impose. The last two constants replace these if
 * sizes come first. Fitted to 19 coasts, parts, maps and point sets at 20 to 36 degrees, each without areas and with
 * two area bounds. */
#define TRI_CROWD_SLOPE 0.35
#define TRI_AN_OCTAVE 0.4
#define TRI_A_GAP 4.0
#define TRI_FINENESS 7.1
#define TRI_NEVER 42.5
#define TRI_AGAIN 1.5
#define TRI_NEVER_AGAIN 39.0

/* --- smooth.c. q is the quality of a triangle. Measured on a coast whose sizes grow by 0.15: one pass raises the mean
 * q from 0.956 to 0.977, a second pass to 0.979. */

#define TRI_SMOOTH_FINE 0.985 /* a vertex is not moved if all its triangles have at least this q */
#define TRI_SMOOTH_GAIN 1e-5  /* minimum relative gain in the sum of 1 / q for a move */
#define TRI_SMOOTH_GOOD 0.7   /* the worst q may decrease if it stays above this value: no angle is then below 24
                               * degrees */
#define TRI_SMOOTH_LEAST 0.05 /* no move makes a triangle with a lower q */

#endif
