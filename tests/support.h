/* What the tests of the mesher share: inputs made from a seed, naive questions to a mesh, and the way to its judge.
 *
 * Everything here asserts by cmocka: a broken precondition is a failed test. All PSLGs own their arrays; tri_pslg_free
 * frees them. The same seed gives the same input on every machine. */
#ifndef TESTS_SUPPORT_H
#define TESTS_SUPPORT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#include "both_ways.h"
#include "triangle/refine/census.h"
#include "triangle/mesh/mesh.h"
#include "triangle/geometry/predicates.h"
#include "triangle/api/generate.h"

/* A generator of random numbers (splitmix64). Start it with any seed. */
struct support_random {
    uint64_t state;
};

uint64_t support_bits(struct support_random *random);
double support_unit(struct support_random *random); /* 0 <= x < 1 */
int32_t support_below(struct support_random *random, int32_t n);

/* A PSLG with room for so many points, segments, holes and regions; the counts start at 0, attributes and markers at
 * NULL. */
struct tri_pslg support_pslg(int32_t points, int32_t segments, int32_t holes, int32_t regions);
int32_t support_add_point(struct tri_pslg *pslg, double x, double y);
void support_add_segment(struct tri_pslg *pslg, int32_t a, int32_t b);

/* Two attributes for every point that are linear in the plane, so that interpolated ones can be recognised; and is a
 * vertex of the mesh one that has them? */
void support_add_attributes(struct tri_pslg *pslg);
bool support_has_its_attributes(const struct tri_mesh *mesh, int32_t v);

/* In place of those that it has, n random attributes for every point, as rough as can be. */
void support_add_heights(struct tri_pslg *pslg, int32_t n, uint64_t seed);

/* Lie the attributes of all new vertices of a mesh on the surface over the triangles of what it was before? A naive
 * search for each, or, where that would take too long, for some. */
void support_assert_on_surface(const struct tri_mesh *before, const struct tri_mesh *mesh);

enum support_kind {
    SUPPORT_RANDOM,    /* in the unit square */
    SUPPORT_LATTICE,   /* drawn from a small lattice: duplicates, collinear and cocircular quadruples */
    SUPPORT_RING,      /* integer points of one circle, then of smaller ones */
    SUPPORT_LINE,      /* on the line y = 3x exactly, a few beside it */
    SUPPORT_NEAR_LINE, /* rounded to the line y = 0.3 x + 0.1 */
    SUPPORT_CLUSTER,   /* scales from 1 to 2^-40 */
    SUPPORT_KINDS
};

/* n points, n >= 3. */
struct tri_pslg support_points(enum support_kind kind, int32_t n, uint64_t seed);

/* A star-shaped polygon of n corners around the origin, with some radial spikes; segments in order, no holes. */
struct tri_pslg support_polygon(int32_t n, uint64_t seed);

/* A square, n points of the kind scaled into it, and m segments between random points, which cross and overlap. */
struct tri_pslg support_tangle(enum support_kind kind, int32_t n, int32_t m, uint64_t seed);

/* A square of the given side with corners 0 .. 3 counter-clockwise from the origin, and n random points in it. */
struct tri_pslg support_square(double side, int32_t n, uint64_t seed);

/* Reads a .poly or .node file of PTRIANGLE_DATA_DIR; false where the reader refuses it, or the
 * mesher for its subnormal coordinates. */
bool support_read(const char *name, struct tri_pslg *pslg);

/* All input names of data/, data/nasty, data/regress, data/coast that end in .poly or .node, sorted, NULL at the
 * end; for support_read. To be freed by support_free_names. */
char **support_names(const char *folder);
void support_free_names(char **names);

/* The mesh in the form of the judge, in the caller's coordinates. */
struct support_copy {
    struct tri_check_mesh mesh;
    double *points;
    int32_t *triangles, *neighbors, *segments, *markers;
    double *max_areas, *attributes; /* of the regions */
};

struct support_copy support_copy(const struct tri_mesh *mesh);
void support_copy_free(struct support_copy *copy);

enum { SUPPORT_TEXT = 600 };

/* Validates the links and lets tri_check judge. False where there is a fault: the text of the judge. */
bool support_passes(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                    bool with_regions, struct tri_check_report *report, char text[SUPPORT_TEXT]);

/* The same; a fault fails the test with the text of the judge. NULL report:
 * unwanted. options->max_areas is filled in from the regions where with_regions. */
void support_judge(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                   bool with_regions, struct tri_check_report *report);

/* The same of a mesh before carving, which it marks: the whole hull is kept, holes are ignored. */
void support_judge_hull(struct tri_mesh *mesh, const struct tri_pslg *pslg);

/* tri_generate that must succeed. */
struct tri_mesh support_generate(const struct tri_pslg *pslg, const struct tri_options *options,
                                 struct tri_report *report);

/* The Delaunay triangulation of the points, in leaves of this size (0: the usual one); its links are valid. */
struct tri_mesh support_delaunay(const struct tri_pslg *pslg, int32_t leaf_size, const struct tri_executor *executor);

/* A constrained triangulation of the whole hull, nothing carved; its links are valid. */
struct tri_mesh support_constrained(const struct tri_pslg *pslg, struct tri_constrain_report *report);

/* Options for a quality mesh of a PSLG. */
struct tri_options support_quality(double min_angle, double max_area);

/* tri_estimate, as one thread makes it. */
double support_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* A set of triangles by their vertex ids: sorted, each rotated so that its least corner comes first. */
struct support_set {
    int32_t n;
    int32_t (*v)[3];
};

struct support_set support_triangles(const struct tri_mesh *mesh);
void support_sort(struct support_set *set);
bool support_same(const struct support_set *a, const struct support_set *b);
void support_set_free(struct support_set *set);

/* Triangles by the coordinates of their corners: six numbers each, sorted, least corner first. */
struct support_places {
    int32_t n;
    double (*at)[6];
};

struct support_places support_places(const struct tri_mesh *mesh);
bool support_same_places(const struct support_places *a, const struct support_places *b);
bool support_has_place(const struct support_places *set, const double place[6]);
void support_places_free(struct support_places *set);

/* The arrays of two meshes, numbers and all; lives of triangles aside. */
void support_assert_same_bytes(const struct tri_mesh *a, const struct tri_mesh *b);

/* An executor that runs tasks from the last to the first. */
extern const struct tri_executor support_backwards;

/* Does a subsegment other than `except` cut the sight from p to q? Exact. A touched end cuts, save where it is q
 * itself. */
bool support_is_hidden(const struct tri_mesh *mesh, struct tri_point p, struct tri_point q, int32_t except);

/* Every edge without subsegment is Delaunay, ties included, and (where naive) no vertex in the circumcircle of a
 * triangle is visible from a point in its interior. O(triangles * vertices * subsegments) where naive. */
void support_assert_cdt(const struct tri_mesh *mesh, bool naive);

/* The files in it, and then itself, if it is there. */
void support_remove_directory(const char *path);

#endif
