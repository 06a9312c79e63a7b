/* Shared code of the mesher's tests: inputs made from a seed, naive queries of a mesh, and calls of the mesh checker.
 *
 * All functions assert with cmocka, so a violated precondition fails the test. All PSLGs own their arrays;
 * tri_pslg_free frees them. The same seed gives the same input on every machine. */
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

/* A random number generator (splitmix64). It can start with any seed. */
struct support_random {
    uint64_t state;
};

uint64_t support_bits(struct support_random *random);
double support_unit(struct support_random *random); /* 0 <= x < 1 */
int32_t support_below(struct support_random *random, int32_t n);

/* Returns a PSLG with room for the given numbers of points, segments, holes and regions. Its counts are 0, and its
 * attributes and markers are NULL. */
struct tri_pslg support_pslg(int32_t points, int32_t segments, int32_t holes, int32_t regions);
int32_t support_add_point(struct tri_pslg *pslg, double x, double y);
void support_add_segment(struct tri_pslg *pslg, int32_t a, int32_t b);

/* Gives each point two attributes that are linear in the plane, so that interpolated values can be recognised.
 * support_has_its_attributes returns true if vertex v has the values for its place. */
void support_add_attributes(struct tri_pslg *pslg);
bool support_has_its_attributes(const struct tri_mesh *mesh, int32_t v);

/* Replaces the attributes by n independent random values for each point. */
void support_add_heights(struct tri_pslg *pslg, int32_t n, uint64_t seed);

/* Asserts that the attributes of all new vertices lie on the surface over the triangles of `before`. The search is
 * naive; in a large mesh only some vertices are tested. */
void support_assert_on_surface(const struct tri_mesh *before, const struct tri_mesh *mesh);

enum support_kind {
    SUPPORT_RANDOM,    /* uniform in the unit square */
    SUPPORT_LATTICE,   /* drawn from a small lattice: duplicates, collinear and cocircular quadruples */
    SUPPORT_RING,      /* integer points on a circle, then on smaller circles */
    SUPPORT_LINE,      /* exactly on the line y = 3x, with a few points beside it */
    SUPPORT_NEAR_LINE, /* rounded to the line y = 0.3 x + 0.1 */
    SUPPORT_CLUSTER,   /* scales from 1 down to 2^-40 */
    SUPPORT_KINDS
};

/* Returns n points of this kind, n >= 3. */
struct tri_pslg support_points(enum support_kind kind, int32_t n, uint64_t seed);

/* A star-shaped polygon of n corners around the origin, with some radial spikes; segments in order, no holes. */
struct tri_pslg support_polygon(int32_t n, uint64_t seed);

/* A square, n points of the kind scaled into it, and m segments between random points, which cross and overlap. */
struct tri_pslg support_tangle(enum support_kind kind, int32_t n, int32_t m, uint64_t seed);

/* A square of the given side with corners 0 .. 3 counter-clockwise from the origin, and n random points in it. */
struct tri_pslg support_square(double side, int32_t n, uint64_t seed);

/* Reads a .poly or .node file of PTRIANGLE_DATA_DIR. Returns false if the reader rejects it, or if the mesher would
 * reject its subnormal coordinates. */
bool support_read(const char *name, struct tri_pslg *pslg);

/* Returns the names, for support_read, of all .poly and .node files in this folder of the data, sorted, with NULL at
 * the end. Free them with support_free_names. */
char **support_names(const char *folder);
void support_free_names(char **names);

/* The mesh in the form that tri_check reads, in the caller's coordinates. */
struct support_copy {
    struct tri_check_mesh mesh;
    double *points;
    int32_t *triangles, *neighbors, *segments, *markers;
    double *max_areas, *attributes; /* of each region */
};

struct support_copy support_copy(const struct tri_mesh *mesh);
void support_copy_free(struct support_copy *copy);

enum { SUPPORT_TEXT = 600 };

/* Validates the links and calls tri_check. Returns false with the checker's message in `text` if there is a fault. */
bool support_passes(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                    bool with_regions, struct tri_check_report *report, char text[SUPPORT_TEXT]);

/* The same, but a fault fails the test and prints the message. report may be NULL. With with_regions,
 * options->max_areas is filled in from the regions. */
void support_judge(const struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_check_options *options,
                   bool with_regions, struct tri_check_report *report);

/* The same for a mesh before carving: the whole hull is kept, and holes are ignored. Marks the hull in the mesh. */
void support_judge_hull(struct tri_mesh *mesh, const struct tri_pslg *pslg);

/* Calls tri_generate, which must succeed. */
struct tri_mesh support_generate(const struct tri_pslg *pslg, const struct tri_options *options,
                                 struct tri_report *report);

/* Returns the Delaunay triangulation of the points, made with leaves of this size (0: the default). Its links are
 * validated. */
struct tri_mesh support_delaunay(const struct tri_pslg *pslg, int32_t leaf_size, const struct tri_executor *executor);

/* Returns the constrained triangulation of the whole hull, without carving. Its links are validated. */
struct tri_mesh support_constrained(const struct tri_pslg *pslg, struct tri_constrain_report *report);

/* Options for a quality mesh of a PSLG. */
struct tri_options support_quality(double min_angle, double max_area);

/* Calls tri_estimate on one thread. */
double support_estimate(const struct tri_mesh *mesh, const struct tri_quality *quality);

/* Triangles as vertex ids. They are sorted, and each starts with its lowest id. */
struct support_set {
    int32_t n;
    int32_t (*v)[3]; /* [n] */
};

struct support_set support_triangles(const struct tri_mesh *mesh);
void support_sort(struct support_set *set);
bool support_same(const struct support_set *a, const struct support_set *b);
void support_set_free(struct support_set *set);

/* Triangles as the coordinates of their corners: six numbers each, sorted, lowest corner first. */
struct support_places {
    int32_t n;
    double (*at)[6]; /* [n] */
};

struct support_places support_places(const struct tri_mesh *mesh);
bool support_same_places(const struct support_places *a, const struct support_places *b);
bool support_has_place(const struct support_places *set, const double place[6]);
void support_places_free(struct support_places *set);

/* Asserts that the arrays of two meshes are equal, including the numbering, except for the generations of triangles. */
void support_assert_same_bytes(const struct tri_mesh *a, const struct tri_mesh *b);

/* An executor that runs tasks from the last to the first. */
extern const struct tri_executor support_backwards;

/* Returns true if a subsegment other than `except` blocks the view from p to q; exact. A touched end of a subsegment
 * blocks the view, unless that end is q itself. */
bool support_is_hidden(const struct tri_mesh *mesh, struct tri_point p, struct tri_point q, int32_t except);

/* Asserts that every edge without subsegment is Delaunay, ties included. With `naive`, also asserts that no vertex in
 * the circumcircle of a triangle is visible from a point inside the triangle, which takes O(triangles * vertices *
 * subsegments). */
void support_assert_cdt(const struct tri_mesh *mesh, bool naive);

/* Removes the files in the directory and then the directory itself, if it exists. */
void support_remove_directory(const char *path);

#endif
