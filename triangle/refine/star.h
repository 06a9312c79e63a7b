/* The star of a free vertex: its triangles, their quality, and the point to which the vertex should move.
 *
 * The quality q = 4 sqrt(3) area / (sum of the squared edges) is 1 for an equilateral triangle. The energy of a star is
 * the sum of 1 / q over its triangles.
 *
 * POSITION. Let e be the edge opposite the vertex x in one of its triangles, l its length, t the height of x over it,
 * and x* the apex of the equilateral triangle over e. Then 1 / q = 1 + |x - x*|^2 / (sqrt(3) l t). For constant t the
 * sum is smallest at the mean of all x* with weights 1 / (l t). The gradient with respect to t shifts each x* along the
 * normal of e. Two such steps are made. No size field is needed: graded rims keep their grading. */
#ifndef TRIANGLE_REFINE_STAR_H
#define TRIANGLE_REFINE_STAR_H

#include "triangle/cdt/flip.h"
#include "triangle/mesh/mesh.h"

/* The state of smoothing, shared by its passes (smooth.h, degrees.h). */
struct tri_smooth {
    struct tri_mesh *mesh;   /* borrowed */
    double sin2;             /* squared sine of the angle bound */
    int32_t *home;           /* [n_vertices] the block of each vertex; owned by the schedule; NULL: no blocks */
    tri_triangle_id *corner; /* [n_vertices] a triangle that has the vertex as a corner; TRI_NONE: none */
    int32_t *degree;         /* [n_vertices] triangles at the vertex; NULL: no pass improves degrees */
    int32_t *ideal;          /* [n_vertices] the best degree: one triangle per 60 degrees; NULL with degree */
};

enum { TRI_MOST_RIM = 32 }; /* a vertex with more triangles does not move */

/* Triangle i has the vertex and the rim vertices i and i + 1, counter-clockwise. */
struct tri_star {
    int n;                                  /* number of triangles */
    tri_triangle_id triangle[TRI_MOST_RIM]; /* [n] in counter-clockwise order */
    tri_vertex_id id[TRI_MOST_RIM];         /* [n] the rim vertices */
    struct tri_point rim[TRI_MOST_RIM + 1]; /* [n + 1] their positions; the last repeats the first */
};

/* The quality of a star, for a given position of its vertex. */
struct tri_worth {
    double sum;   /* energy */
    double least; /* smallest q */
    int n_bad;    /* triangles with an angle below the bound */
};

/* Collects the star of a vertex. Returns false if the vertex must not move: it touches a subsegment, two regions, or
 * too many triangles. Also returns false, with *is_here false, if a vertex of the star belongs to another block; block
 * < 0: there is no limit. */
bool tri_star_find(const struct tri_smooth *smooth, tri_vertex_id v, int32_t block, struct tri_star *star,
                   bool *is_here);

/* Pushes the triangles of a star to be tested by Lawson's flips. Returns false if out of memory. */
bool tri_star_touch(const struct tri_star *star, struct tri_flips *flips);

/* Evaluates the star with its vertex at x. */
struct tri_worth tri_star_worth(const struct tri_smooth *smooth, const struct tri_star *star, struct tri_point x);

/* Sets *x to a better position: the energy decreases, and the smallest q does not decrease or stays good. At most
 * `allowed_bad` triangles violate the angle bound there. Returns false if there is none. */
bool tri_star_find_place(const struct tri_smooth *smooth, const struct tri_star *star, int allowed_bad,
                         struct tri_point *x);

/* Tests exactly whether all triangles are counter-clockwise with the vertex at x. */
bool tri_star_is_oriented(const struct tri_star *star, struct tri_point x);

#endif
