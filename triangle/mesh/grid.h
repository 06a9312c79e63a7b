/* A read-only view of a mesh for output to files or to a caller's arrays: the number of items of each kind, and each
 * item by its number, counted from 0.
 *
 * Points are the vertices that are output, in their order, and then, for second-order triangles, the midpoints of the
 * edges. Nothing is copied: each item is computed when it is requested, by any thread, in any order. Meshes in other
 * forms can provide a grid as well. */
#ifndef TRIANGLE_MESH_GRID_H
#define TRIANGLE_MESH_GRID_H

#include "triangle/mesh/mesh.h"

struct tri_grid_point {
    double at[2]; /* the caller's coordinates */
    int32_t marker;
};

struct tri_grid_edge {
    int64_t ends[2];     /* point numbers; ends[1] == -1: a ray */
    int32_t marker;
    double direction[2]; /* direction of a ray; otherwise 0, 0 */
};

struct tri_grid {
    const void *user;     /* passed to the callbacks */
    int32_t base;         /* 0 or 1: the first number in files */
    bool has_markers;     /* output markers of points and segments */
    int64_t n_points, n_triangles, n_segments, n_edges;
    int32_t n_attributes; /* attributes of each point */
    int32_t n_columns;    /* attributes of each triangle */
    int n_nodes;          /* nodes of each triangle: 3, or 6: the corners, then the midpoints of the opposite edges */
    const struct tri_pslg *figure; /* holes and regions of the input; NULL: none */
    const struct tri_storage *storage; /* allocates work arrays that grow with the mesh; NULL: malloc */
    void (*point)(const void *user, int64_t i, struct tri_grid_point *point); /* stores point i */
    double (*attribute)(const void *user, int64_t i, int32_t k);              /* returns attribute k of point i */
    void (*triangle)(const void *user, int64_t i, int64_t nodes[6]);          /* stores the nodes of triangle i */
    double (*column)(const void *user, int64_t i, int32_t k);                 /* returns attribute k of triangle i */
    void (*neighbors)(const void *user, int64_t i, int64_t neighbors[3]); /* triangles opposite the corners; -1: none */
    void (*segment)(const void *user, int64_t i, struct tri_grid_edge *segment); /* stores segment i */
    void (*edge)(const void *user, int64_t i, struct tri_grid_edge *edge);       /* stores edge i */
};

enum { TRI_GRID_PERIOD = 1 << 15 };

/* Allows the storage to evict pages of the mesh and of work arrays from memory. Loops that do not read the grid in
 * order call it every TRI_GRID_PERIOD items. tri_grid_evict_periodically does this in round i of such a loop. */
static inline void tri_grid_evict_pages(const struct tri_grid *grid)
{
    if (grid->storage && grid->storage->evict_pages)
        grid->storage->evict_pages(grid->storage->user);
}

static inline void tri_grid_evict_periodically(const struct tri_grid *grid, int64_t i)
{
    if (i % TRI_GRID_PERIOD == 0)
        tri_grid_evict_pages(grid);
}

/* What a grid of a mesh contains. All pointers are borrowed and must stay valid as long as the grid.
 *
 * The coordinates of input points are read from the PSLG, so that they are output exactly as given: in the mesh,
 * coordinates below 2^-216 units have been rounded (tri_mesh_take_points). All other points come from the mesh. The
 * public arrays (triangle/api/arrays.c) have no input and read all points from the mesh, so the two can differ in such
 * tiny coordinates only. */
struct tri_grid_options {
    const struct tri_mesh *mesh;         /* has no free numbers */
    const struct tri_pslg *pslg;         /* the input, for the coordinates of its points */
    const struct tri_elements *elements; /* the triangles from which the mesh was reconstructed; NULL: none */
    const bool *is_edge; /* [pslg->n_segments] segments with false are appended to the mesh's; NULL: append none */
    int32_t base;
    bool markers;        /* output markers */
    bool regions;        /* without elements: output the attribute of each triangle's region as a column */
    bool jettison;       /* leave out vertices that are not corners (see tri_kept_make) */
    bool second_order;   /* output the midpoints of edges as nodes */
    bool edges;          /* edges will be requested; their number is known in any case */
};

/* Makes a grid. TRI_NO_MEMORY. O(vertices + triangles); uses the memory of tri_kept_make and tri_edge_list_make if
 * their results are needed. */
enum tri_status tri_grid_make(struct tri_grid *grid, const struct tri_grid_options *options, struct tri_error *error);
void tri_grid_free(struct tri_grid *grid);

/* The Voronoi diagram as a grid of points and edges, including rays, without markers: point t is the circumcentre of
 * triangle t, edge i is dual to edge i of the mesh. Valid as long as `grid`, which must have been made with edges. Do
 * not free it. */
struct tri_grid tri_grid_voronoi(const struct tri_grid *grid);

#endif
