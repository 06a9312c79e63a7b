/* The best point for a triangle with a bad angle: the locally optimal Steiner point.
 *
 * Let ab be the shortest edge of a bad triangle. Its petal is the part, on the triangle's side of ab, of the disk
 * from whose points ab is seen under at least the angle bound. So any point in the petal makes a good angle opposite
 * ab. No vertex in the petal of a bad triangle sees ab. The best point of the petal is the one farthest from all
 * vertices. It is a vertex of the Voronoi diagram, or the point where an edge of the diagram leaves the petal (Erten
 * & Üngör, Quality triangulations with locally optimal Steiner points, SIAM J. Sci. Comput. 31, 2009).
 * docs/theory.md has the proofs.
 *
 * THEOREM. The point found is at least as far from all vertices that it sees as the triangle's circumcentre is from
 * the corners. So refinement terminates for the same bounds as with circumcentres. */
#ifndef TRIANGLE_REFINE_PETAL_H
#define TRIANGLE_REFINE_PETAL_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"

enum tri_petal {
    TRI_PETAL_USUAL,  /* use the standard point (tri_place): it is the best one, or no better point was found */
    TRI_PETAL_BETTER, /* *p is a better point */
    TRI_PETAL_BEYOND  /* the answer depends on triangles across the edge `beyond`, which are not in this part
                         (TRI_BEYOND) */
};

/* Finds the best point in the petal. height: of the petal over the shortest edge, in units of that edge; more than
 * 1/2. The search crosses no segments and uses only triangles inside the fence (NULL: all). It changes nothing.
 * Expected time O(1). */
enum tri_petal tri_petal_point(const struct tri_mesh *mesh, const struct tri_fence *fence, tri_triangle_id triangle,
                               const struct tri_shape *shape, double height, struct tri_point *p,
                               tri_vertex_id beyond[2]);

#endif
