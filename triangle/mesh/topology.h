/* What a mesh means to its users beside corners: edges, neighbours, Voronoi diagram, midpoints, vertices in use;
 * and what is printed about it, its counts and the shapes of its triangles.
 *
 * All of it is worked out from struct tri_mesh item by item, so that nobody needs a copy of the whole: arrays are
 * made only where an order has to be counted out. No number is free in the mesh.
 *
 * ORDER OF EDGES: triangles in their order; in each the edges from its first to its second, second to third, third
 * to first corner; each edge where it is met first. So an edge is known by the code (4 * triangle + opposite corner)
 * of its first triangle, which lies on its left, and edge i of the list is dual to edge i of the Voronoi diagram. */
#ifndef TRIANGLE_MESH_TOPOLOGY_H
#define TRIANGLE_MESH_TOPOLOGY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Triangles opposite the corners of t; TRI_NONE: none. */
void tri_neighbors(const struct tri_mesh *mesh, tri_triangle_id t, tri_triangle_id neighbors[3]);

/* From and to of the edge, its triangle on the left. */
static inline void tri_edge_ends(const struct tri_mesh *mesh, tri_halfedge code, tri_vertex_id ends[2])
{
    const tri_vertex_id *v = mesh->tri[tri_of(code)].v;
    ends[0] = v[tri_next[tri_edge(code)]];
    ends[1] = v[tri_prev[tri_edge(code)]];
}

/* Marker of the subsegment that the edge is, else 0. (tri_generate gives boundary edges the marker 1 where they have
 * none.) */
static inline int32_t tri_edge_marker(const struct tri_mesh *mesh, tri_halfedge code)
{
    tri_link link = *tri_link_at(mesh, code);
    return link < 0 ? mesh->sub[~link].marker : 0;
}

struct tri_edge_list {
    int32_t n;
    tri_halfedge *codes; /* [n] */
    int32_t *number;     /* [n_triangles][3] number of the edge opposite each corner; NULL: not asked for */
    const struct tri_mesh *mesh; /* whose extras these are; NULL: there are none */
};

/* Bytes of a list for a triangle: two triangles have three edges. */
enum { TRI_EDGE_LIST_BYTES = 6, TRI_EDGE_NUMBERS_BYTES = 12 };

/* Lists the edges. O(triangles). The list lies where the mesh does, and lives no longer. TRI_NO_MEMORY. */
enum tri_status tri_edge_list_make(struct tri_edge_list *list, const struct tri_mesh *mesh, bool with_numbers,
                                   struct tri_error *error);
void tri_edge_list_free(struct tri_edge_list *list);

/* A place, and how attributes are interpolated there: that of corner 0, plus weight[k - 1] times the way to that of
 * corner k. The weights may lie outside 0 .. 1: extrapolation. */
struct tri_blend {
    double at[2]; /* the caller's coordinates */
    tri_vertex_id v[3];
    double weight[2];
};

double tri_blend_attribute(const struct tri_mesh *mesh, const struct tri_blend *blend, int32_t attribute);

/* The middle of an edge. */
struct tri_blend tri_edge_middle(const struct tri_mesh *mesh, tri_halfedge code);

/* Voronoi vertex t: the circumcentre of triangle t. */
struct tri_blend tri_voronoi_vertex(const struct tri_mesh *mesh, tri_triangle_id t);

/* The Voronoi edge dual to an edge: ends[0] is the triangle on its left, ends[1] that on its right or, for a ray,
 * TRI_NONE. The direction of a ray is that of the edge turned right, as long as the edge; 0, 0 for an edge with two
 * ends. */
void tri_voronoi_edge(const struct tri_mesh *mesh, tri_halfedge code, tri_triangle_id ends[2], double direction[2]);

/* Vertices that are corners of triangles. */
struct tri_used {
    int32_t n;
    tri_vertex_id *vertex; /* [n] ascending */
    int32_t *number;       /* [n_vertices] place in `vertex`, or TRI_NONE */
    const struct tri_mesh *mesh; /* whose extras these are; NULL: there are none */
};

enum { TRI_USED_BYTES = 8 }; /* for a vertex */

/* O(vertices + triangles). The lists lie where the mesh does, and live no longer. TRI_NO_MEMORY. */
enum tri_status tri_used_make(struct tri_used *used, const struct tri_mesh *mesh, struct tri_error *error);
void tri_used_free(struct tri_used *used);

/* The vertices that Triangle writes: with jettison (-j) those that are corners; of a mesh made from elements with more
 * than three nodes all but the nodes behind the third (midpoints of edges, -o2) that are no corners; else all, and
 * kept->number is NULL. To be freed by tri_used_free. O(vertices + triangles). TRI_NO_MEMORY. */
enum tri_status tri_kept_make(struct tri_used *kept, const struct tri_mesh *mesh, const struct tri_elements *elements,
                              bool jettison, struct tri_error *error);

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
