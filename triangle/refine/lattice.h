/* A hexagonal lattice for new points, where one bound on areas holds, or one length. It is the best mesh there is away
 * from features: equilateral triangles of nearly the largest area allowed.
 *
 * A bad triangle gets the lattice point nearest to its circumcentre, if nothing is too near to that. A circumdisk wider
 * than the lattice's holds a lattice point, and no vertex: so away from features each of its points is inserted, in
 * whatever order, and the Delaunay triangulation of all is the lattice (docs/theory.md, the lattice). Where many of its
 * triangles lie side by side, they are made at once (lattice_fill.c).
 *
 * Row j lies at height j * rise, its points at i * edge, or at (i + 1/2) * edge where j is odd. The lattice begins at
 * the origin: all regions with the same bound, and all who work on a mesh, have the same one. */
#ifndef TRIANGLE_REFINE_LATTICE_H
#define TRIANGLE_REFINE_LATTICE_H

#include <math.h>

#include "triangle/geometry/shape.h"
#include "triangle/mesh/cavity.h"

struct tri_lattice {
    double edge;    /* length of its edges, in the mesh's units */
    double rise;    /* from row to row */
    double feature; /* the size of features around its points (triangle/size/feature_size.h) is at most this */
};

/* edge: the length of its edges; area2: twice the bound on areas, both in the mesh's units. */
struct tri_lattice tri_lattice_of(double edge);
struct tri_lattice tri_lattice_for(double area2);

/* By how much of an edge is a row shifted? */
static inline double tri_lattice_shift(double row) { return 0.5 * (row - 2 * floor(0.5 * row)); }

/* The point of a row and column, which are whole numbers. */
static inline struct tri_point tri_lattice_at(const struct tri_lattice *lattice, double row, double column)
{
    struct tri_point p = {tri_round_coordinate((column + tri_lattice_shift(row)) * lattice->edge),
                          tri_round_coordinate(row * lattice->rise)};
    return p;
}

/* Sets row and column of a lattice point near to p, at most sqrt(7) / 4 edges away: the nearest in the nearest row. */
static inline void tri_lattice_near(const struct tri_lattice *lattice, struct tri_point p, double *row, double *column)
{
    *row = floor(p.y / lattice->rise + 0.5);
    *column = floor(p.x / lattice->edge - tri_lattice_shift(*row) + 0.5);
}

/* Sets *p to the lattice point for a bad triangle with corners v. False: there is none, since a corner is too near to
 * it, the triangle so flat that the point is far away, or the coordinates are too coarse. */
bool tri_lattice_point(const struct tri_lattice *lattice, const struct tri_point *xy, const tri_vertex_id v[3],
                       const struct tri_shape *shape, struct tri_point *p);

/* Is the lattice point whose cavity has been found far enough from all vertices and subsegments around? */
bool tri_lattice_is_clear(const struct tri_cavity *cavity, const struct tri_lattice *lattice);

#endif
