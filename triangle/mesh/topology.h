/* Derived data of a mesh: edges, neighbours, Voronoi diagram, midpoints, vertices in use, counts, and shapes of
 * triangles.
 *
 * Everything is computed from struct tri_mesh item by item, so no copy of the whole mesh is needed. Arrays are made
 * only if items must be numbered. The mesh must have no free numbers.
 *
 * ORDER OF EDGES: by first triangle, and within a triangle the edges from first to second, second to third, and third
 * to first corner; each edge is listed at its first triangle only. An edge is identified by the code (4 * triangle +
 * opposite corner) of its first triangle, which lies on its left. Edge i of the list is dual to edge i of the Voronoi
 * diagram. */
#ifndef TRIANGLE_MESH_TOPOLOGY_H
#define TRIANGLE_MESH_TOPOLOGY_H

#include "triangle/base/executor.h"
#include "triangle/mesh/mesh.h"

/* Stores the triangles opposite the corners of t; TRI_NONE: none. */
void tri_neighbors(const struct tri_mesh *mesh, tri_triangle_id t, tri_triangle_id neighbors[3]);

/* Stores the start and the end of the edge; its triangle is on the left. */
static inline void tri_edge_ends(const struct tri_mesh *mesh, tri_halfedge code, tri_vertex_id ends[2])
{
    const tri_vertex_id *v = mesh->tri[tri_of(code)].v;
    ends[0] = v[tri_next[tri_edge(code)]];
    ends[1] = v[tri_prev[tri_edge(code)]];
}

/* Returns the marker of the edge if it is a subsegment, otherwise 0. (tri_generate has set the marker of unmarked
 * boundary edges to 1.) */
static inline int32_t tri_edge_marker(const struct tri_mesh *mesh, tri_halfedge code)
{
    tri_link link = *tri_link_at(mesh, code);
    return link < 0 ? mesh->sub[~link].marker : 0;
}

struct tri_edge_list {
    int32_t n;
    tri_halfedge *codes; /* [n] */
    int32_t *number;     /* [n_triangles][3] number of the edge opposite each corner; NULL: not requested */
    const struct tri_mesh *mesh; /* the mesh in whose storage the arrays are; NULL: no arrays */
};

/* Bytes per triangle of these arrays: two triangles have three edges. */
enum { TRI_EDGE_LIST_BYTES = 6, TRI_EDGE_NUMBERS_BYTES = 12 };

/* Lists the edges. O(triangles). The arrays are allocated in the mesh's storage and must not outlive it.
 * TRI_NO_MEMORY. */
enum tri_status tri_edge_list_make(struct tri_edge_list *list, const struct tri_mesh *mesh, bool with_numbers,
                                   struct tri_error *error);
void tri_edge_list_free(struct tri_edge_list *list);

/* A point and the weights to interpolate attributes there: the value at corner 0, plus weight[k - 1] times the
 * difference between corner k and corner 0. Weights outside 0 .. 1 extrapolate. */
struct tri_blend {
    double at[2]; /* in the caller's coordinates */
    tri_vertex_id v[3]; /* corners 0, 1 and 2 */
    double weight[2];   /* weights of corners 1 and 2 */
};

double tri_blend_attribute(const struct tri_mesh *mesh, const struct tri_blend *blend, int32_t attribute);

/* The midpoint of an edge. */
struct tri_blend tri_edge_middle(const struct tri_mesh *mesh, tri_halfedge code);

/* Voronoi vertex t: the circumcentre of triangle t. */
struct tri_blend tri_voronoi_vertex(const struct tri_mesh *mesh, tri_triangle_id t);

/* The Voronoi edge dual to an edge: ends[0] is the triangle on its left, ends[1] the triangle on its right, or TRI_NONE
 * for a ray. The direction of a ray is that of the edge turned right, with the length of the edge; 0, 0 for an edge
 * with two ends. */
void tri_voronoi_edge(const struct tri_mesh *mesh, tri_halfedge code, tri_triangle_id ends[2], double direction[2]);

/* Vertices that are corners of triangles. */
struct tri_used {
    int32_t n;
    tri_vertex_id *vertex; /* [n] ascending */
    int32_t *number;       /* [n_vertices] index in `vertex`, or TRI_NONE */
    const struct tri_mesh *mesh; /* the mesh in whose storage the arrays are; NULL: no arrays */
};

enum { TRI_USED_BYTES = 8 }; /* per vertex */

/* Lists the vertices that are corners. O(vertices + triangles). The arrays are allocated in the mesh's storage and must
 * not outlive it. TRI_NO_MEMORY. */
enum tri_status tri_used_make(struct tri_used *used, const struct tri_mesh *mesh, struct tri_error *error);
void tri_used_free(struct tri_used *used);

/* The vertices that Triangle writes. With jettison (-j): those that are corners. For a mesh made from elements with
 * more than three nodes: all except the nodes after the third (midpoints of edges, -o2) that are not corners.
 * Otherwise: all, and kept->number is NULL. Free with tri_used_free. O(vertices + triangles). TRI_NO_MEMORY. */
enum tri_status tri_kept_make(struct tri_used *kept, const struct tri_mesh *mesh, const struct tri_elements *elements,
                              bool jettison, struct tri_error *error);

struct tri_counts {
    int64_t vertices; /* vertices that are corners of triangles */
    int64_t triangles, edges;
    int64_t exterior; /* edges with one triangle, including those of holes */
    int64_t interior; /* subsegments between two triangles */
    int64_t subsegments; /* number of subsegments */
};

/* Counts the items of a mesh without free numbers. O(triangles); uses one byte per vertex temporarily.
 * TRI_NO_MEMORY. */
enum tri_status tri_count_mesh(struct tri_counts *counts, const struct tri_mesh *mesh,
                               const struct tri_executor *executor, struct tri_error *error);

/* The same for a refined mesh that had `unused` vertices outside or duplicate before refinement: refinement never
 * removes a vertex from all its triangles, and each new vertex has triangles. O(subsegments). */
void tri_count_refined(struct tri_counts *counts, const struct tri_mesh *mesh, int64_t unused);

enum { TRI_ASPECT_BINS = 16, TRI_ANGLE_BINS = 18 };

/* Limits of the aspect ratio bins: bin k holds ratios above tri_aspect_limits[k], up to and including
 * tri_aspect_limits[k + 1]. The first and the last bin are open. */
extern const double tri_aspect_limits[TRI_ASPECT_BINS];

/* Lengths and areas in the caller's coordinates, angles in degrees. All 0 without triangles. */
struct tri_shapes {
    double smallest_area, largest_area, total_area;
    double shortest_edge, longest_edge;
    double shortest_altitude;
    double largest_aspect; /* longest edge over shortest altitude; infinite if an area is lost to rounding */
    double smallest_angle, largest_angle;
    int64_t aspects[TRI_ASPECT_BINS]; /* number of triangles by aspect ratio */
    int64_t angles[TRI_ANGLE_BINS];   /* number of angles by tens of degrees, three per triangle */
};

/* Measures the triangles of a mesh without free numbers. O(triangles). */
void tri_measure_shapes(struct tri_shapes *shapes, const struct tri_mesh *mesh, const struct tri_executor *executor);

#endif
