/* The best place for the point of a triangle with a bad angle: the locally optimal Steiner point.
 *
 * Of a bad triangle with shortest edge ab, the petal is the part, on the triangle's side of ab, of the disk through a
 * and b that sees ab under the angle bound or more: any point there makes a good angle opposite ab. The petal of a bad
 * triangle holds no vertex that sees ab. Its best point is the one farthest from all vertices, which lies at a vertex
 * of the Voronoi diagram, or where an edge of the diagram leaves the petal (Erten & Üngör, Quality triangulations with
 * locally optimal Steiner points, SIAM J. Sci. Comput. 31, 2009). docs/theory.md has the proofs.
 *
 * THEOREM. Whatever is found is at least as far from all vertices that it sees as the triangle's circumcentre is from
 * its corners; so refinement ends for the same bounds as with circumcentres. */
#ifndef TRIANGLE_REFINE_PETAL_H
#define TRIANGLE_REFINE_PETAL_H

#include "triangle/geometry/shape.h"
#include "triangle/mesh/fence.h"
#include "triangle/mesh/mesh.h"

enum tri_petal {
    TRI_PETAL_USUAL,  /* the usual point (tri_place) is the best, or nothing better is known */
    TRI_PETAL_BETTER, /* *p is */
    TRI_PETAL_BEYOND  /* what lies behind the edge `beyond` decides, and is not here (TRI_BEYOND) */
};

/* height: of the petal over the shortest edge, in units of that edge; more than 1/2. The search stays on this side of
 * segments, and in triangles that the fence holds (NULL: all). Reads the mesh only. O(1) expected. */
enum tri_petal tri_petal_point(const struct tri_mesh *mesh, const struct tri_fence *fence, tri_triangle_id triangle,
                               const struct tri_shape *shape, double height, struct tri_point *p,
                               tri_vertex_id beyond[2]);

#endif
