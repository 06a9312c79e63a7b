/* Reconstruction of a mesh from its triangles, for -r and the library's `r`. */
#ifndef TRIANGLE_CDT_RECONSTRUCT_H
#define TRIANGLE_CDT_RECONSTRUCT_H

#include "triangle/mesh/mesh.h"

struct tri_reconstruct_options {
    bool use_segments; /* segments of the PSLG that are edges of the mesh become subsegments (-p) */
    bool refine;       /* the mesh will be refined, so it is made constrained Delaunay first */
    const struct tri_stop *stop; /* as in struct tri_options */
    const struct tri_executor *executor; /* as in struct tri_options */
    int32_t base;      /* number of the first triangle and the first vertex in error messages */
    bool *is_edge;     /* [n_segments] receives false for valid segments that are not edges of the mesh; NULL: not
                          requested */
    int32_t *loose;    /* with use_segments, receives the number of these segments; NULL: not requested */
};

/* Makes *mesh from the points of the PSLG and the given triangles.
 *
 * All vertices are input vertices, and every edge with one triangle is a subsegment. With use_segments, so is every
 * edge that is a segment. These come first, in the order of the segments, each with its own parent (with `refine`,
 * straight chains share a parent, see tri_unite_chains). If several segments are one edge, the first marker that is not
 * 0 is used. Segments that are not edges are left out; Triangle copies them to its output. Holes and regions of the
 * PSLG are ignored.
 *
 * Without `refine` the triangles are the given ones, in their order, each with its first corner first; clockwise ones
 * are reversed. With `refine`, edges are flipped (tri_flip_to_delaunay).
 *
 * A vertex without a marker gets that of a segment at it, otherwise 1 if it is on the boundary. Unmarked boundary edges
 * get 1. Triangles with the same attributes and area bound share a region (mesh->regions, mesh->columns); regions are
 * in order of first use, and region 0 has none. A triangle made by a flip gets the region of the given triangle in
 * which its centroid lies. Refinement assigns regions by centroids as well. So values are copied, never averaged, and
 * never cross a subsegment. Borders without subsegments become slightly uneven, and regions too narrow to hold a
 * centroid disappear.
 *
 * Two triangles share an edge if they name its ends by the same indices; vertices at the same place are different
 * vertices. Overlapping triangles that share no edge are not detected; the result then overlaps as well.
 *
 * TRI_BAD_INPUT, which names the triangle: a corner that is not a point, two equal corners, area exactly 0, an edge
 * with two triangles on the same side, or with three triangles; see also tri_pslg_check. On failure *mesh is empty.
 * O(points + triangles + segments), plus the flips. Uses about 30 bytes per triangle temporarily, beside the mesh. */
enum tri_status tri_reconstruct(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_elements *elements,
                                const struct tri_reconstruct_options *options, struct tri_error *error);

/* Gives subsegments that form one straight line, up to rounding, a common parent; the vertices between them lie on it
 * (mesh->on). Before, each subsegment has its own parent. Subsegments keep their order, but some are reversed.
 * O(vertices + subsegments); O(n log n) for a curved chain of n subsegments. TRI_NO_MEMORY: nothing has changed. */
enum tri_status tri_unite_chains(struct tri_mesh *mesh, struct tri_error *error);

#endif
