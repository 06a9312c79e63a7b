/* Regions given by polygons that may overlap, instead of region points.
 *
 * METHOD. All segments and rings are triangulated at once. They divide the plane into faces, and each face belongs to
 * the last feature that contains the centroid of its largest triangle. Faces thinner than rounding join a neighbour.
 * Pieces of rings become segments if the features on their sides differ. The centroid of each face, which lies far from
 * all segments, becomes a region point. So the result is an ordinary PSLG, and meshing needs no polygons.
 * DOMAIN. A PSLG with segments keeps its domain: pieces outside it are left out. Otherwise the domain is the union of
 * the polygons, and each face outside gets a hole point. */
#ifndef TRIANGLE_API_REGION_POLYGONS_H
#define TRIANGLE_API_REGION_POLYGONS_H

#include "triangle/api/generate.h"

/* Polygons with the same attribute and area bound. */
struct tri_feature {
    double attribute; /* attribute of its triangles */
    double max_area;  /* <= 0: none */
};

/* A closed ring: points first .. end - 1. */
struct tri_ring {
    int32_t first, end; /* first < end */
    int32_t polygon; /* number of its polygon; the rings of a polygon follow each other */
    int32_t feature; /* number of its feature */
};

/* Polygons. A place is inside if an odd number of the polygon's rings enclose it. */
struct tri_polygons {
    int32_t n_points, n_rings, n_features;
    int32_t point_capacity, ring_capacity, feature_capacity; /* allocated items */
    double *points;               /* [n_points][2]: x, y; finite */
    struct tri_ring *rings;       /* [n_rings] */
    struct tri_feature *features; /* [n_features] later ones cover earlier ones */
};

/* Frees the arrays (malloc'ed) and zeroes the struct. */
void tri_polygons_free(struct tri_polygons *polygons);

/* Divides the PSLG by the polygons. Its points keep their numbers; new points follow, with marker 0. Its segments, now
 * in pieces, keep their markers; pieces of rings have marker 0. New region points follow its own, which stay in force
 * outside the polygons. how: its keep_hull, ignore_holes, even_odd, executor and stop, as for the mesh. TRI_BAD_INPUT:
 * the points have attributes, or as for tri_generate; TRI_TOO_LARGE, TRI_NO_MEMORY, TRI_STOPPED. After an error the
 * PSLG can only be freed. Takes the time of a triangulation, plus O(log n) for each of the rings' segments, with n
 * faces, plus O(1) for each pair of a face and a segment of a ring at the height of its centroid. */
enum tri_status tri_divide_by_polygons(struct tri_pslg *pslg, const struct tri_polygons *polygons,
                                       const struct tri_options *how, struct tri_error *error);

#endif
