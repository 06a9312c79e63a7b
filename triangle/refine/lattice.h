/* A hexagonal lattice of candidate points, for a single area bound or a single edge length. Away from features it
 * gives the best possible mesh: equilateral triangles of nearly the largest allowed area.
 *
 * A bad triangle gets the lattice point closest to its circumcentre, unless a vertex or a subsegment is too close to
 * that point. A circumdisk wider than the lattice's own circumdisks contains a lattice point but no vertex. So away
 * from features every lattice point is eventually inserted, in any order, and the Delaunay triangulation of these
 * points is the lattice (docs/theory.md, the lattice). Large areas of lattice triangles are made at once
 * (lattice_fill.c).
 *
 * Row j lies at height j * rise. Its points lie at i * edge for even j, and at (i + 1/2) * edge for odd j. The
 * lattice starts at the origin, so all regions with the same bound, all threads and all ranks use the same lattice. */
#ifndef TRIANGLE_REFINE_LATTICE_H
#define TRIANGLE_REFINE_LATTICE_H

#include <math.h>

#include "triangle/geometry/shape.h"
#include "triangle/mesh/cavity.h"

struct tri_lattice {
    double edge;    /* edge length, in the mesh's units */
    double rise;    /* distance between rows, in the mesh's units */
    double feature; /* upper bound on the feature size at its points (triangle/size/feature_size.h) */
};

/* Return the lattice with this edge length, or the one for a bound on areas. edge, area2: edge length, twice the
 * area bound, in the mesh's units. */
struct tri_lattice tri_lattice_of(double edge);
struct tri_lattice tri_lattice_for(double area2);

/* Returns the shift of a row, in edge lengths: 0 or 1/2. */
static inline double tri_lattice_shift(double row) { return 0.5 * (row - 2 * floor(0.5 * row)); }

/* Returns the lattice point in a row and column, both whole numbers. */
static inline struct tri_point tri_lattice_at(const struct tri_lattice *lattice, double row, double column)
{
    struct tri_point p = {tri_round_coordinate((column + tri_lattice_shift(row)) * lattice->edge),
                          tri_round_coordinate(row * lattice->rise)};
    return p;
}

/* Finds the lattice point closest to p in the row closest to p. Its distance from p is at most sqrt(7) / 4 edges. */
static inline void tri_lattice_near(const struct tri_lattice *lattice, struct tri_point p, double *row, double *column)
{
    *row = floor(p.y / lattice->rise + 0.5);
    *column = floor(p.x / lattice->edge - tri_lattice_shift(*row) + 0.5);
}

/* Sets *p to the lattice point for a bad triangle with corners v. Returns false if there is none: a corner is too
 * close to it, the triangle is so flat that the point would be far away, or coordinates are too coarse. */
bool tri_lattice_point(const struct tri_lattice *lattice, const struct tri_point *xy, const tri_vertex_id v[3],
                       const struct tri_shape *shape, struct tri_point *p);

/* Is the lattice point, whose cavity has been searched, far enough from all vertices and subsegments around it? */
bool tri_lattice_is_clear(const struct tri_cavity *cavity, const struct tri_lattice *lattice);

#endif
