/* What is printed about a mesh: its counts, and the shapes of its triangles. */
#ifndef TRIANGLE_REFINE_STATS_H
#define TRIANGLE_REFINE_STATS_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

struct tri_counts {
    int64_t vertices; /* that are corners of triangles */
    int64_t triangles, edges;
    int64_t exterior; /* edges of one triangle, those of holes included */
    int64_t interior; /* subsegments between two triangles */
    int64_t subsegments;
};

/* O(triangles); one byte a vertex while it runs. No number is free in the mesh. TRI_NO_MEMORY. */
enum tri_status tri_count_mesh(struct tri_counts *counts, const struct tri_mesh *mesh,
                               const struct tri_executor *executor, struct tri_error *error);

/* The same where refinement has made the mesh of one in which so many vertices were outside, or duplicates: it takes no
 * vertex from all its triangles, and each that it makes has some. O(subsegments). */
void tri_count_refined(struct tri_counts *counts, const struct tri_mesh *mesh, int64_t unused);

enum { TRI_ASPECT_BINS = 16, TRI_ANGLE_BINS = 18 };

/* Limits of the bins of aspect ratios: bin k holds what is above tri_aspect_limits[k], up to and including [k + 1]; the
 * first and the last are open. */
extern const double tri_aspect_limits[TRI_ASPECT_BINS];

/* Lengths and areas in the caller's coordinates, angles in degrees. All 0 without triangles. */
struct tri_shapes {
    double smallest_area, largest_area, total_area;
    double shortest_edge, longest_edge;
    double shortest_altitude;
    double largest_aspect; /* longest edge over shortest altitude; infinite where an area is lost to rounding */
    double smallest_angle, largest_angle;
    int64_t aspects[TRI_ASPECT_BINS]; /* triangles by aspect ratio */
    int64_t angles[TRI_ANGLE_BINS];   /* angles by tens of degrees, three a triangle */
};

/* O(triangles). No number is free in the mesh. */
void tri_measure_shapes(struct tri_shapes *shapes, const struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
