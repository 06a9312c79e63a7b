/* A mesh from its triangles, as -r and the library's `r` give them. */
#ifndef TRIANGLE_CDT_RECONSTRUCT_H
#define TRIANGLE_CDT_RECONSTRUCT_H

#include "triangle/mesh/mesh.h"

struct tri_reconstruct_options {
    bool use_segments; /* the segments of the PSLG that are edges of the mesh become subsegments (-p) */
    bool refine;       /* the mesh is going to be refined: it is made constrained Delaunay first */
    const struct tri_stop *stop; /* as in struct tri_options */
    const struct tri_executor *executor; /* as in struct tri_options */
    int32_t base;      /* of the numbers in errors: of the first triangle and the first vertex */
    bool *is_edge;     /* [n_segments] receives whether the segment is an edge of the mesh, or nothing that
                          could be one; NULL: not asked for */
    int32_t *loose;    /* receives how many are not, with use_segments; NULL: not asked for */
};

/* Makes *mesh of the points of the PSLG and these triangles.
 *
 * Every vertex is one of the input, every edge of one triangle is a subsegment. So is, with use_segments, every edge
 * that is a segment: these come first, in the order of the segments, each with a parent of its own (with `refine`
 * straight chains of them share one, see tri_unite_chains); where several segments are one edge, the first of them with
 * a marker gives it. A segment that is no edge is left out; Triangle passes it on to its output. Holes and regions of
 * the PSLG are not looked at.
 *
 * Without `refine` the triangles are those given, in their order, with their first corners first; clockwise ones are
 * turned round. With it edges are flipped (tri_flip_to_delaunay).
 *
 * A vertex without marker takes that of a segment at it, else 1 on the boundary; a boundary edge without one has 1.
 * Attributes and area bounds: triangles with the same ones share a region (mesh->regions, mesh->columns), in the order
 * in which they come; region 0 has none. What flips and refinement make takes the region of the triangle in which its
 * centroid lies, for flips of the triangle given: values are copied, never averaged, and cross no subsegment; where
 * none parts them their border frays, and ground too narrow for any centroid gives its values up.
 *
 * Two triangles share an edge if they name its ends by the same indices: vertices at the same place are different
 * ones. Triangles that overlap without sharing an edge are not noticed; the result is then as good as they are.
 *
 * TRI_BAD_INPUT, which names the triangle: a corner that is no point, two equal corners, no area (exactly), an edge
 * that two triangles have on the same side, or three triangles at all; or see tri_pslg_check. On failure *mesh is
 * empty. O(points + triangles + segments), and the flips; about 30 bytes a triangle while it runs, beside the mesh. */
enum tri_status tri_reconstruct(struct tri_mesh *mesh, const struct tri_pslg *pslg, const struct tri_elements *elements,
                                const struct tri_reconstruct_options *options, struct tri_error *error);

/* Subsegments that continue each other on one straight line, as far as rounding tells, get one parent; the vertices
 * between them lie on it (mesh->on). Each subsegment has a parent of its own before. Subsegments keep their order; some
 * turn round. O(vertices + subsegments), n log n for n in a row that run round a bend. TRI_NO_MEMORY: nothing has
 * changed. */
enum tri_status tri_unite_chains(struct tri_mesh *mesh, struct tri_error *error);

#endif
