/* The triangles around a free vertex, and where in them the vertex should lie.
 *
 * q = 4 sqrt(3) area / (sum of the squared edges) is 1 for an equilateral triangle. The energy of a star is the sum of
 * 1 / q over its triangles.
 *
 * PLACE. Let e be the edge opposite the vertex x in one of its triangles, l its length, t the height of x over it, and
 * x* the apex of the equilateral triangle over e. Then 1 / q = 1 + |x - x*|^2 / (sqrt(3) l t). If t is held fixed, the
 * sum is least at the mean of all x* with the weights 1 / (l t); the gradient of t moves each x* along the normal of e.
 * Two such steps are made. No field of sizes is needed: graded rims keep their grading. */
#ifndef TRIANGLE_REFINE_STAR_H
#define TRIANGLE_REFINE_STAR_H

#include "triangle/mesh/mesh.h"

/* Shared by passes of smoothing (smooth.h) and of flips (degrees.h). */
struct tri_smooth {
    struct tri_mesh *mesh;   /* borrowed */
    double sin2;             /* square of the sine of the bound on angles */
    int32_t *home;           /* [n_vertices] the block of each vertex, borrowed; NULL: there are no blocks */
    tri_triangle_id *corner; /* [n_vertices] a triangle that has the vertex as a corner; TRI_NONE: none */
    int32_t *degree;         /* [n_vertices] triangles at the vertex; NULL: no pass flips by degree */
    int32_t *ideal;          /* [n_vertices] the best number of them: one for each 60 degrees; NULL with degree */
};

enum { TRI_MOST_RIM = 32 }; /* a vertex with more triangles stays */

/* Triangle i has the vertex and the rim vertices i and i + 1, counter-clockwise. */
struct tri_star {
    int n;                                  /* triangles */
    tri_triangle_id triangle[TRI_MOST_RIM]; /* [n] */
    tri_vertex_id id[TRI_MOST_RIM];         /* [n] of rim vertex i */
    struct tri_point rim[TRI_MOST_RIM + 1]; /* [n + 1] their places; the last is the first */
};

/* The shape of a star if its vertex lies at a given place. */
struct tri_worth {
    double sum;   /* energy */
    double least; /* smallest q */
    int n_bad;    /* triangles with an angle below the bound */
};

/* Finds the star of a vertex. Returns false if the vertex must stay, since it lies on a subsegment, meets another
 * region, or has too many triangles; or, with *is_here false, if not all of its triangles lie in the
 * block. */
bool tri_star_find(const struct tri_smooth *smooth, tri_vertex_id v, int32_t block, struct tri_star *star,
                   bool *is_here);

struct tri_worth tri_star_worth(const struct tri_smooth *smooth, const struct tri_star *star, struct tri_point x);

/* Moves *x to a better place: the energy gets less, and the worst q not lower, or it stays good. allowed_bad: triangles
 * that may break the bound on angles there. False: there is none. */
bool tri_star_find_place(const struct tri_smooth *smooth, const struct tri_star *star, int allowed_bad,
                         struct tri_point *x);

/* Decides exactly whether all triangles are counter-clockwise if the vertex lies at x. */
bool tri_star_is_oriented(const struct tri_star *star, struct tri_point x);

#endif
